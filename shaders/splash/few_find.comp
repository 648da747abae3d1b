// few_find.comp - marks what a view may see of droplets and of splashes, where both are few: an invocation looks at one
// of each, and a dispatch is spared.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#define COMPACT_SETS 4
#include "sprite_find.glsl"

void main()
{
    const uint place = gl_GlobalInvocationID.x, groups = state.view_groups[0], splash_groups = state.splash_groups[0];
    const uint[2] droplet = droplet_kinds(place), splash = splash_kinds(place);
    const uint[2] from = droplet_sets(), behind = splash_sets();
    mark_picks(uint[4](droplet[0], droplet[1], splash[0], splash[1]), uint[4](from[0], from[1], behind[0], behind[1]),
               uint[4](groups, groups, splash_groups, splash_groups));
}
