// splash_mark.comp - marks the splashes that a view may see, where they are many.
// One invocation per splash. Reads: splashes. Writes: selection.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#define COMPACT_SETS 2
#include "sprite_mark.glsl"

void main()
{
    const uint groups = state.splash_groups[0];
    mark_selected_sets(splash_kinds(gl_GlobalInvocationID.x), splash_sets(), uint[2](groups, groups));
}
