// droplet_find.comp - marks the droplets that a view may see.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#include "sprite_find.glsl"

void main()
{
    const uint place = gl_GlobalInvocationID.x;
    mark_pick(place < state.staying ? kind_of(droplet_sprite(droplets[place])) : NOT_PICKED);
}
