// list.comp - writes the picked slots into the list, each at its place.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/rain_gpu.h"
#include "scan_buffers.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

void main()
{
    const uint slot_index = gl_GlobalInvocationID.x;
    const uvec4 word = picks[slot_index >> 5];
    const uint bit = 1u << (slot_index & 31u);
    const bool second = (word.y & bit) != 0u;
    const uint bits = second ? word.y : word.x;
    const uint place = (second ? word.w : word.z) + bitCount(bits & (bit - 1u));
    if ((bits & bit) != 0u && place < (second ? list.second_kind : list.count))
        listed[place] = slot_index;
}
