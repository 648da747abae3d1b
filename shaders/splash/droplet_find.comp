// droplet_find.comp - marks the droplets and the piles that a view may see.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#include "sprite_find.glsl"

void main()
{
    const uint place = gl_GlobalInvocationID.x;
    uint kinds[2] = uint[2](NOT_PICKED, NOT_PICKED);
    if (place < state.staying) {
        const virga_droplet_gpu droplet = droplets[place];
        kinds = uint[2](kind_of(droplet_sprite(droplet)), kind_of(pile_sprite(droplet)));
    }
    mark_picks(kinds, uint[2](0u, state.view_groups[0]));
}
