// mist.comp - the mist's map: the share of each cell that beads of film cover which are too small for a shape.
// Where a cell is smaller than a pixel, of several cells together. A workgroup for each block that may have film. Finds
// those that there is any in, and those with film that has a shape.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "beads.glsl"

#define PACKED 4u // texels of a lane, in one word

layout(constant_id = 0) const uint MODE = 0u;
#define SEVERAL ((MODE & 1u) != 0u) // cells to a texel; a loop costs where it turns once, too
#define MASKED ((MODE & 2u) != 0u)  // there may be cells without glass
layout(local_size_x = VIRGA_GLASS_MIST_BLOCK / PACKED, local_size_y = VIRGA_GLASS_MIST_BLOCK) in;
layout(scalar, set = 0, binding = 4) readonly buffer Surface { uint surface[]; };
layout(scalar, set = 0, binding = 9) writeonly buffer Mist { uint mist[]; }; // four texels to a word
layout(scalar, set = 0, binding = 18) buffer Work { virga_glass_work_gpu work; uint wet[]; };
layout(scalar, set = 0, binding = 19) writeonly buffer Corners { uint corners[]; };

shared uint misty, shaped;

// Without branches: in one, software Vulkan reads lane by lane. Share of the cell; and whether film there has a shape.
float cell_mist(uvec2 cell, inout bool has_shape)
{
    const bool inside = cell.x < look.pane.columns && cell.y < look.pane.rows;
    const uint number = inside ? cell.x + cell.y * look.pane.columns : 0u;
    const uint water = film[number], wetted = passed[number];
    bool wet_glass = inside && water != 0u;
    if (MASKED)
        wet_glass = wet_glass && (surface[number] & 0x1000000u) != 0u;
    const float fresh = film_fresh(wetted);
    const vec2 radii = bead_radii(number, float(water) * (1.0 - fresh)), shapes = bead_shapes(radii);
    const float covered = dot(radii * radii, 1.0 - shapes) * 3.14159265 / (look.pane.cell_m * look.pane.cell_m);
    has_shape = has_shape || (wet_glass && ((look.sheets != 0u && fresh > 0.0) || shapes.x + shapes.y > 0.0));
    return wet_glass ? min(covered, 1.0) : 0.0;
}

float texel_mist(uvec2 texel, inout bool has_shape)
{
    if (!SEVERAL)
        return cell_mist(texel, has_shape);
    float sum = 0.0;
    for (uint i = 0u; i < look.mist_cells * look.mist_cells; i++)
        sum += cell_mist(texel * look.mist_cells + uvec2(i % look.mist_cells, i / look.mist_cells), has_shape);
    return sum / float(look.mist_cells * look.mist_cells);
}

// The block as two triangles; corners are numbered along rows of the grid of all blocks.
void draw_block(uvec2 block)
{
    const uint columns = look.mist_pitch / VIRGA_GLASS_MIST_BLOCK + 1u, first = block.x + block.y * columns;
    const uint six[6] = uint[6](first, first + 1u, first + columns, first + columns, first + 1u, first + columns + 1u);
    const uint at = 6u * look.max_tiles + atomicAdd(work.mist.index_count, 6u);
    for (uint i = 0u; i < 6u; i++)
        corners[at + i] = six[i];
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        misty = shaped = 0u;
    barrier();
    const uint number = wet[3u * look.max_tiles + look.max_blocks + gl_WorkGroupID.x];
    const uvec2 block = uvec2(number & 0xffffu, number >> 16);
    const uvec2 first = block * VIRGA_GLASS_MIST_BLOCK + gl_LocalInvocationID.xy * uvec2(PACKED, 1u);
    bool has_shape = false;
    const float share0 = texel_mist(first, has_shape), share1 = texel_mist(first + uvec2(1u, 0u), has_shape);
    const float share2 = texel_mist(first + uvec2(2u, 0u), has_shape);
    const float share3 = texel_mist(first + uvec2(3u, 0u), has_shape);
    const uint word = packUnorm4x8(vec4(share0, share1, share2, share3));
    mist[(first.x + first.y * look.mist_pitch) / PACKED] = word;
    if (word != 0u)
        atomicOr(misty, 1u);
    if (has_shape)
        atomicOr(shaped, 1u);
    barrier();
    if (gl_LocalInvocationIndex != 0u)
        return;
    if (misty != 0u)
        draw_block(block);
    if (shaped != 0u)
        wet[2u * look.max_tiles + atomicAdd(work.block_groups[0], 1u)] = number;
}
