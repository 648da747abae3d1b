// pile_find.comp - marks the piles that a view may see.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#define COMPACT_FIRST_GROUP state.view_groups[0] // behind the droplets
#include "sprite_find.glsl"

void main()
{
    const uint place = gl_GlobalInvocationID.x;
    mark_pick(place < state.staying ? kind_of(pile_sprite(droplets[place])) : NOT_PICKED);
}
