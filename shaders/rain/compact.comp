// compact.comp - ordered compaction, third pass: writes the list of selected slots. Used by all lists of rain.
// One invocation per word of 32 slots. Reads: selection. Writes: the list.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/rain_limits.h"
#include "compact.glsl"
#include "gpu/compact_write.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

void main()
{
    const uint word = gl_GlobalInvocationID.x;
    if (word < list.word_count)
        write_word(word, 32u * word, 0u, virga_list_gpu(list.group_count, list.count, list.second_kind, 0u, 0u, 0u));
}
