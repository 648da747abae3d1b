// divided.comp - four quotients, as the test of their cost wants them: over BY.
#version 460

layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) buffer Data { uvec4 data[]; };

void main()
{
    const uint at = gl_LocalInvocationIndex;
    data[at] = data[at] / (BY);
}
