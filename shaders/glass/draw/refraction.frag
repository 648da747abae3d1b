// refraction.frag - where drops look up the plate, for a host's compositor: the offset in pixels (to the right and
// down) and coverage.
// One invocation per pixel of a tile with water. Reads: the relief map or densities. Writes: offsets and coverage.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "sky.glsl"
#include "gpu/light.glsl"
#include "surface.glsl"
#include "paper_slopes.glsl"
#include "plate.glsl"
#include "path.glsl"
#include "paper.glsl"

layout(location = 0) out vec4 offset_cover;

void main()
{
    Water water;
    if (IN_PAPER) // constant of the pipeline
        water = water_by_density();
    else
        water = water_here();
    const float pixel_m = max(length(dFdx(pane_position)), length(dFdy(pane_position)));
    if (water.cover <= 0.0 || is_behind_scene())
        discard;
    const vec3 d = normalize(position);
    vec2 pixel = gl_FragCoord.xy;
    if (IN_PAPER)
        pixel = paper_pixel(pixel, water.slope, directions_on_picture(along_u, along_v));
    else if (look.opaque == 0u || dot(d, cross(along_u, along_v)) < 0.0) {
        const Path path = path_through(d, water, pixel_m, look.opaque != 0u);
        pixel = path.ahead && !path.total ? path.pixel : pixel;
    } else
        discard;
    offset_cover = vec4(pixel - gl_FragCoord.xy, water.cover, water.cover);
}
