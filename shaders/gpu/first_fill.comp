// first_fill.comp - the first contents of a buffer: one value in every word, except for one word.
// One invocation per some words. Reads: whether an earlier frame has filled the buffer; then it does nothing.
#version 460

layout(local_size_x = 256) in;
layout(std430, set = 0, binding = 0) writeonly buffer Filled { uint words[]; };
layout(std430, set = 0, binding = 1) readonly buffer Marks { uint done; };
layout(push_constant) uniform Push { uint count, fill, word, word_value; };

void main()
{
    if (done != 0)
        return;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x)
        words[i] = i == word && word != 0 ? word_value : fill;
}
