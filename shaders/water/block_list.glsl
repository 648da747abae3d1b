// block_list.glsl - the list of blocks, and dispatches over it with a workgroup for each block.
#include "shared/compact.h"
#include "water/list_groups.glsl"

layout(scalar, set = 0, binding = 10) readonly buffer BlockList
{
    virga_list_gpu block_list;
    uint blocks[]; // cells
};
