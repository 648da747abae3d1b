// enter_cell.comp - round of movement, second half: resolves the claims. One drop enters a cell, the others merge. See
// rounds.glsl.
// One invocation per active slot. Reads: claims, occupants. Writes: drops, claims of the round before (cleared),
// passed.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#define FEW
#include "live.glsl"
#include "rounds.glsl"
#include "enter_cell.glsl"

void main()
{
    if (gl_GlobalInvocationID.x < state.active_count)
        enter_cell(gl_GlobalInvocationID.x);
}
