// droplet_mark.comp - marks the droplets and piles that a view may see, where droplets are many.
// One invocation per droplet. Reads: droplets. Writes: selection.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#define COMPACT_SETS 3
#include "sprite_mark.glsl"

void main()
{
    const uint groups = state.view_groups[0];
    mark_selected_sets(droplet_kinds(gl_GlobalInvocationID.x), droplet_sets(), uint[3](groups, groups, groups));
}
