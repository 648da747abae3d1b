// divide_write.comp - surfels and their parts become splats with a color. Texels of a part: the three of a splat, see
// splats.glsl, and red, green, blue, 0.
// One invocation per visible surfel. Reads: the list, surfels, divisions, prepared, thickness, the host's picture.
// Writes: parts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "surfels.glsl"
#include "splats.glsl"
#include "divide.glsl"
#include "prepared.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 4
#define COMPACT_LIST_BINDING 5
#include "gpu/compact_buffers.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;
layout(std430, set = 0, binding = 25) writeonly buffer Parts { uvec4 parts[]; };

void write_part(Surfel s, uint node, uint part)
{
    const vec3 disc = node_disc(node);
    float difference;
    const vec3 color = color_of(s, node, difference);
    Surfel own = s;
    own.position = disc_point(s, disc.xy);
    own.radius *= disc.z;
    own.area *= disc.z * disc.z;
    const Splat splat = splat_of(own);
    parts[4u * part] = splat.one;
    parts[4u * part + 1u] = splat.two;
    parts[4u * part + 2u] = splat.three;
    parts[4u * part + 3u] = uvec4(floatBitsToUint(color), 0u);
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= list.count)
        return;
    const Surfel s = surfel_at(listed[index]);
    const uvec2 own = divisions[index];
    const bool fits = own.y + 3u * bitCount(own.x) <= look.max_parts;
    const uint divided = fits ? own.x : 0u, nodes = divided == 0u ? 1u : nodes_to(look.divisions);
    uint part = index + min(own.y, prepared.parts_added);
    for (uint node = 0u; node < nodes; node++) {
        const bool there = node == 0u || (divided >> ((node - 1u) >> 2) & 1u) != 0u;
        const bool is_divided = node < 32u && (divided >> (node & 31u) & 1u) != 0u;
        if (there && !is_divided)
            write_part(s, node, part++);
    }
}
