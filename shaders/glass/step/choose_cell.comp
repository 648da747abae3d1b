// choose_cell.comp - round of movement, first half: each drop that still has to move chooses its next cell. See
// rounds.glsl.
// One invocation per active slot. Reads: drops, cells, claims of the round before. Writes: drops, claims, occupants,
// film, seeds (tails).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#define FEW
#include "live.glsl"
#include "rounds.glsl"
#include "choose_cell.glsl"

void main()
{
    if (gl_GlobalInvocationID.x < state.active_count)
        choose_cell(gl_GlobalInvocationID.x);
}
