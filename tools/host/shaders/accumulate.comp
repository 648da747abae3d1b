#version 460
// accumulate.comp - adds an output of a sub-frame to the frame's sum. With PAIR it has two channels instead of four.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef PAIR
#define VALUE vec2
#define PARTS xy
#else
#define VALUE vec4
#define PARTS xyzw
#endif

layout(set = 0, binding = 0) uniform sampler2D drawn;
layout(set = 0, binding = 1, std430) buffer Sum { VALUE sum[]; };
layout(set = 0, binding = 2, std430) readonly buffer Weights { float weights[]; };
layout(push_constant) uniform Add { host_accumulate_gpu add; };

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= add.width || pixel.y >= add.height)
        return;
    const uint at = pixel.y * add.width + pixel.x;
    // The same bits on every device and as a CPU would add them: nothing is contracted or left out.
    precise VALUE value = texelFetch(drawn, ivec2(pixel), 0).PARTS;
    if (add.is_weighed != 0u)
        value *= weights[at];
    precise VALUE before = VALUE(0.0);
    if (add.is_first == 0u)
        before = sum[at];
    precise VALUE after = before + value;
    sum[at] = after;
}
