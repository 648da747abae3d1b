// few_find.comp - marks what a view may see of droplets and of splashes, where both are few: an invocation looks at one of each,
// and a dispatch is spared.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#define COMPACT_SETS 4
#include "sprite_find.glsl"

void main()
{
    const uint[2] droplet = droplet_kinds(gl_GlobalInvocationID.x), splash = splash_kinds(gl_GlobalInvocationID.x);
    const uint[2] droplets_from = droplet_sets(), splashes_from = splash_sets();
    mark_picks(uint[4](droplet[0], droplet[1], splash[0], splash[1]),
               uint[4](droplets_from[0], droplets_from[1], splashes_from[0], splashes_from[1]),
               uint[4](state.view_groups[0], state.view_groups[0], state.splash_groups[0], state.splash_groups[0]));
}
