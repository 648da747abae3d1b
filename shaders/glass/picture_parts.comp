// picture_parts.comp - quarters of tiles that have something to show, tile by tile, as the corners of two triangles
// each.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "gpu/group_scan.glsl"

layout(local_size_x = SCAN_LANES) in;
layout(scalar, set = 0, binding = 17) readonly buffer Written { uint written[]; };
layout(scalar, set = 0, binding = 18) buffer Work { virga_glass_work_gpu work; uint wet[]; };
layout(scalar, set = 0, binding = 19) writeonly buffer Corners { uint corners[]; };

uint quarters_of(uint tile)
{
    const uint held = written[tile % look.tile_columns + tile / look.tile_columns * look.written_columns];
    return held / VIRGA_GLASS_QUARTER & 15u;
}

// Corners are numbered along rows of the grid of all quarters.
void put(uint number, uint tile, uint quarter)
{
    const uint columns = 2u * look.tile_columns + 1u;
    const uvec2 at = 2u * uvec2(tile % look.tile_columns, tile / look.tile_columns) + uvec2(quarter & 1u,
        quarter >> 1u);
    const uint first = at.x + at.y * columns;
    const uint six[6] = uint[6](first, first + 1u, first + columns, first + columns, first + 1u, first + columns + 1u);
    for (uint i = 0u; i < 6u; i++)
        corners[6u * number + i] = six[i];
}

void main()
{
    const uint count = look.tile_columns * look.tile_rows, run = (count + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(gl_LocalInvocationIndex * run, count), end = min(begin + run, count);
    uint sum = 0u;
    for (uint i = begin; i < end; i++)
        sum += bitCount(quarters_of(i));
    uvec2 all;
    uint number = scan_group(uvec2(sum, 0u), all).x;
    for (uint i = begin; i < end; i++) {
        const uint quarters = quarters_of(i);
        for (uint quarter = 0u; quarter < 4u; quarter++)
            if ((quarters >> quarter & 1u) != 0u)
                put(number++, i, quarter);
    }
    if (gl_LocalInvocationIndex == 0u) {
        work.index_count = 6u * all.x;
        work.instance_count = 1u;
        work.first_index = work.first_instance = 0u;
        work.vertex_offset = 0;
    }
}
