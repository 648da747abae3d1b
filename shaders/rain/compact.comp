// compact.comp - ordered compaction, third pass: writes the list of selected slots. Used by all lists of rain.
// One invocation per word of 32 slots. Reads: selection. Writes: the list; on GPUs its head too.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/rain_limits.h"
#include "compact.glsl"
#include "gpu/compact_summed.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

void main()
{
    if (FOR_GPU)
        write_summed();
    else
        write_own_word();
}
