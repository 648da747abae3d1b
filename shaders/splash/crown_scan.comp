// crown_scan.comp - gives the sheets that a view sees their places, and writes the arguments of their draw.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#include "look.glsl"
#include "compact_crowns.glsl"
#include "gpu/compact_scan.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;
layout(scalar, set = 0, binding = 15) buffer Prepared { virga_splash_prepared_gpu prepared; };

void main()
{
    scan_picks(state.splash_groups[0], look.max_crowns);
    if (gl_LocalInvocationIndex != 0u)
        return;
    const uint count = list.count;
    if (is_film()) // an instance each, of the mesh that lies behind sprites and pyramids
        prepared.crowns = virga_splash_draw_gpu(VIRGA_CROWN_INDICES, count, 18u * look.max_sprites, 0, 0u);
    else
        prepared.crowns = virga_splash_draw_gpu(12u * VIRGA_CROWN_PYRAMIDS * count, 1u, 6u * look.max_sprites, 0, 0u);
}
