// few_mark.comp - marks the droplets and splashes that a view may see, where both are few. This saves a dispatch.
// One invocation per droplet and splash. Reads: droplets, splashes. Writes: selection.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#define COMPACT_SETS 5
#include "sprite_mark.glsl"

void main()
{
    const uint slot = gl_GlobalInvocationID.x, groups = state.view_groups[0], splash_groups = state.splash_groups[0];
    const uint[3] droplet = droplet_kinds(slot), from = droplet_sets();
    const uint[2] splash = splash_kinds(slot), behind = splash_sets();
    mark_selected_sets(uint[5](droplet[0], droplet[1], droplet[2], splash[0], splash[1]),
               uint[5](from[0], from[1], from[2], behind[0], behind[1]),
               uint[5](groups, groups, groups, splash_groups, splash_groups));
}
