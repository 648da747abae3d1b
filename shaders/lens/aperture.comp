// aperture.comp - the aperture as an image: for each offset in pixels, the radius of the aperture's image whose edge
// goes through that offset.
//
// A regular polygon of N straight blades, whose corners are at radius 1, has its edge at cos(pi/N) / cos(phi) in the
// direction that is phi away from the middle of a blade. Rounded blades are between that and the circle.
// Below it stand the areas of the image by its radius, for spread.glsl: texels are cheaper than words of a block.
// Wide discs read it at its rim, whatever their radius, see blocks.glsl.
// One invocation per offset up to the largest radius of the view, and per area. Writes: aperture.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 3, r32f) uniform writeonly image2D aperture;

#define PI 3.14159265

void main()
{
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= VIRGA_LENS_APERTURE)
        return;
    if (at.y < VIRGA_LENS_AREA_ROWS) {
        const int entry = min(at.y * VIRGA_LENS_APERTURE + at.x, VIRGA_LENS_SPREADS - 1);
        imageStore(aperture, ivec2(at.x, VIRGA_LENS_APERTURE + at.y), vec4(view.areas[entry]));
        return;
    }
    const int most = view.levels > 0u ? VIRGA_LENS_MAX_RADIUS : int(ceil(view.max_radius)) + 1;
    const ivec2 offset = ivec2(at.x - VIRGA_LENS_MAX_RADIUS, at.y - VIRGA_LENS_AREA_ROWS - most);
    if (offset.y > most)
        return;
    const vec2 apart = vec2(offset);
    float edge = 1.0;
    if (view.blades > 0.0) {
        const float blade = 2.0 * PI / view.blades;
        const float angle = atan(apart.y, apart.x + (apart == vec2(0.0) ? 1.0 : 0.0)) - view.rotation;
        const float phi = angle - blade * floor(angle / blade + 0.5);
        edge = mix(cos(0.5 * blade) / cos(phi), 1.0, view.roundness);
    }
    imageStore(aperture, offset + VIRGA_LENS_MAX_RADIUS, vec4(length(apart) / edge));
}
