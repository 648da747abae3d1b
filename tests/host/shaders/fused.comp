// fused.comp - a sum of four components, as the test of its cost wants it: SUM 0: of a product; 1: of a product that
// may not be fused; 2: of what is no product.
#version 460

layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) buffer Data { vec4 data[]; };

void main()
{
    const uint at = gl_LocalInvocationIndex;
#if SUM == 1
    precise vec4 sum;
#else
    vec4 sum;
#endif
#if SUM == 2
    sum = (data[at] + data[at + 8u]) + data[at + 16u];
#else
    sum = data[at] * data[at + 8u] + data[at + 16u];
#endif
    data[at] = sum;
}
