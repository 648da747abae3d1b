// counted.comp - for test_counting.c: a loop, a branch and an early end, each run by a known number of lanes.
#version 460
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x, sum = 0u;
    if (i >= 1000u)
        return;
    for (uint k = 0u; k < i % 7u; k++)
        sum += data[(i + k) & 1023u];
    if ((i & 1u) != 0u)
        sum = sum * 3u + 1u;
    data[1024u + i] = sum;
}
