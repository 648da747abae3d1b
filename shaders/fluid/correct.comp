// correct.comp - one iteration of the solver, see correct.glsl.
// One invocation per sorted particle. Reads and writes: see correct.glsl.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "correct.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

void add_error(uint error) { atomicAdd(group_error, error); }

void main() { iterate(); }
