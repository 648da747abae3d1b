// drop_refraction.frag - where drops that are drawn as textures look up the plate, as refraction.frag has it for
// others.
// One invocation per pixel of a drop's quad. Reads: quads, the scene's depth. Writes: offsets and coverage.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/light.glsl"
#include "drop_inputs.glsl"
#include "plate.glsl"
#include "path.glsl"
#include "drop_path.glsl"
#include "drop_quad.glsl"
#include "drop_cover.glsl"

layout(location = 0) out vec4 offset_cover;

void main()
{
    const float cover = drop_cover();
    if (cover <= 0.0 || is_behind_scene())
        discard;
    const vec2 in_drop = is_point() ? vec2(0.0) : local * min(1.0, 1.0 / max(length(local), 1e-6));
    stand_on(vec2(quad_float(quad, 12u), quad_float(quad, 13u)) + in_drop * quad_float(quad, 14u));
    const Path path = path_through_drop(in_drop, normalize(position), 0.0);
    const vec2 pixel = path.ahead && !path.total ? path.pixel : gl_FragCoord.xy;
    offset_cover = vec4(pixel - gl_FragCoord.xy, cover, cover);
}
