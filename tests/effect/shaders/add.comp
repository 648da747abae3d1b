#version 460
#extension GL_EXT_scalar_block_layout : require
// add.comp - adds the weight of a tick to the sum. One invocation.
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, scalar) buffer Sum
{
    uint sum;
};
layout(push_constant) uniform Push
{
    uint weight;
};

void main()
{
    sum += weight;
}
