// branched.comp - one branch, as the test of its cost wants it: by what is known when the pipeline is created, or not.
#version 460

layout(local_size_x = 8) in;
layout(constant_id = 0) const uint FORM = 3u;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };

void main()
{
    const uint at = gl_LocalInvocationIndex;
    if (BY)
        data[at] = 1u;
}
