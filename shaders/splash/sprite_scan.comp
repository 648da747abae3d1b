// sprite_scan.comp - gives what a view sees its places, and writes the arguments of their draws.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#include "look.glsl"
#include "compact.glsl"
#include "gpu/compact_scan.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;
layout(scalar, set = 0, binding = 15) buffer Prepared { virga_splash_prepared_gpu prepared; };

void main()
{
    scan_picks(state.sprite_groups[0], look.max_sprites);
    if (gl_LocalInvocationIndex != 0u)
        return;
    // Six indices a sprite, or twelve a pyramid; those of the second kind come first in the list.
    const uint each = is_film() ? 6u : 12u, second = list.second_kind, first = list.count - second;
    prepared.wide = virga_splash_draw_gpu(each * second, 1u, is_film() ? 0u : 6u * look.max_sprites, 0, 0u);
    prepared.thin = virga_splash_draw_gpu(6u * first, 1u, 6u * second, 0, 0u);
    prepared.sprites = list.count;
}
