// divide_mark.comp - which surfels are divided, and how far.
// One invocation per visible surfel. Reads: the list, surfels, thickness, the host's picture. Writes: divisions.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "surfels.glsl"
#include "splats.glsl"
#include "divide.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 4
#define COMPACT_LIST_BINDING 5
#include "gpu/compact_buffers.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= list.count)
        return;
    const Surfel s = surfel_at(listed[index]);
    const float pixel_m = look.pixel_angle * project(to_mat(view.clip_from_rel), s.position).w;
    const uint nodes = look.divisions == 0u ? 0u : nodes_to(look.divisions - 1u);
    uint divided = 0u;
    for (uint node = 0u; node < nodes; node++) {
        if (node != 0u && (divided >> ((node - 1u) >> 2) & 1u) == 0u)
            continue;
        // Parts of what is no larger than a splat at least would be drawn as large as it.
        if (look.surfel_scale * s.radius * node_disc(node).z <= MIN_PX * pixel_m)
            continue;
        float difference;
        color_of(s, node, difference);
        if (difference > look.difference)
            divided |= 1u << node;
    }
    divisions[index] = uvec2(divided, 3u * bitCount(divided));
}
