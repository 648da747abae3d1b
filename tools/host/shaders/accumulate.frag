#version 460
// accumulate.frag - adds an output of a sub-frame to the frame's sum. With PAIR it has two channels instead of four.
// A draw and not a compute pass: software Vulkan reads and writes buffers lane by lane. It is blended: that is the same
// sum of floats and takes less time there than to read the attachment.
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

#ifdef PAIR
#define VALUE vec2
#define PARTS xy
#else
#define VALUE vec4
#define PARTS xyzw
#endif

layout(set = 0, binding = 0) uniform sampler2D drawn;
layout(set = 0, binding = 1, std430) readonly buffer Weights { float weights[]; };
layout(push_constant) uniform Add { host_accumulate_gpu add; };

layout(location = 0) out VALUE out_sum;

void main()
{
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    // The same bits on every device that blends floats of 32 bits as a CPU adds them.
    precise VALUE value = texelFetch(drawn, pixel, 0).PARTS;
    [[dont_unroll]] for (uint i = 0u; i < add.is_weighed; i++)
        value *= weights[uint(pixel.y) * add.width + uint(pixel.x)];
    out_sum = value;
}
