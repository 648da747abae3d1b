// splat_write.comp - visible surfels become splats, see splats.glsl.
// One invocation per visible surfel. Reads: the list, surfels. Writes: splats.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "surfels.glsl"
#include "splats.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 4
#define COMPACT_LIST_BINDING 5
#include "gpu/compact_buffers.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(std430, set = 0, binding = 6) writeonly buffer Splats { uvec4 splats[]; };

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= list.count)
        return;
    const Splat splat = splat_of(surfel_at(listed[index]));
    splats[3u * index] = splat.one;
    splats[3u * index + 1u] = splat.two;
    splats[3u * index + 2u] = splat.three;
}
