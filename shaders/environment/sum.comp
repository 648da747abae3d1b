// sum.comp - the harmonics from the sums of all parts. The texels of a whole sphere are scaled to its 4 pi.
// One workgroup. Reads: sums. Writes: the harmonics.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/environment_gpu.h"

layout(local_size_x = 32) in;
layout(scalar, set = 0, binding = 0) uniform Info { virga_environment_gpu info; };
layout(scalar, set = 0, binding = 1) readonly buffer Sums { virga_environment_sum_gpu sums[]; };
layout(scalar, set = 0, binding = 2) writeonly buffer Result { float result[27]; };

void main()
{
    const uint k = gl_LocalInvocationIndex;
    if (k >= 27u)
        return;
    float sum = 0.0, weight = 0.0;
    for (uint group = 0u; group < info.groups; group++) {
        sum += sums[group].sh[k];
        weight += sums[group].weight;
    }
    result[k] = info.kind == 2u ? info.rest_sh[k] + sum : sum * (12.5663706143592 / weight);
}
