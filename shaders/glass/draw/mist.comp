// mist.comp - the mist map: the part of each cell that is covered by beads of film too small for a shape. A texel
// covers several cells where cells are smaller than pixels. Blocks with mist get a quad to draw. Tiles with film that
// has a shape are marked on a GPU. Software Vulkan, which would run those loops for every cell, lists the blocks with
// such film for film_tiles.comp.
// One workgroup per block that may have film. Reads: film. Writes: the mist map, index buffer, work lists, flags.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "tiles.glsl"
#include "beads.glsl"
#include "gpu/variants.glsl"

#define PACKED 4u // texels of one invocation, in one word

layout(constant_id = 0) const uint MODE = 0u;
#define SEVERAL ((MODE & 1u) != 0u) // several cells per texel; even a loop that runs once has a cost
#define MASKED ((MODE & 2u) != 0u)  // there may be cells without glass
// In a row: of a workgroup that is four wide software Vulkan runs four lanes at a time, and not eight.
#define COLUMNS (uint(VIRGA_GLASS_MIST_BLOCK) / PACKED)
#define CELLS (uint(VIRGA_GLASS_MIST_BLOCK) * uint(VIRGA_GLASS_MIST_BLOCK)) // of a block of one cell per texel
#define LANES (CELLS / PACKED)
layout(local_size_x = VIRGA_GLASS_MIST_BLOCK * VIRGA_GLASS_MIST_BLOCK / PACKED) in;
layout(scalar, set = 0, binding = 4) readonly buffer Surface { uint surface[]; };
layout(scalar, set = 0, binding = 9) writeonly buffer Mist { uint mist[]; }; // four texels in a word
layout(scalar, set = 0, binding = 19) writeonly buffer Corners { uint corners[]; };

shared uint any_mist, any_shape;
shared uint wet_count, wet_cells[CELLS], words[LANES]; // on a GPU

bool has_water(uvec2 cell)
{
    const bool inside = cell.x < look.pane.columns && cell.y < look.pane.rows;
    const uint number = inside ? cell.x + cell.y * look.pane.columns : 0u;
    return inside && film[number] != 0u && (!MASKED || (surface[number] & 0x1000000u) != 0u);
}

// Mist of a cell, and whether it has film with a shape. Software Vulkan has no branches here: inside one it reads lane
// by lane.
float cell_mist(uvec2 cell, out bool has_shape)
{
    const bool inside = cell.x < look.pane.columns && cell.y < look.pane.rows;
    const uint number = inside ? cell.x + cell.y * look.pane.columns : 0u;
    const uint water = film[number], wetted_tick = passed[number];
    bool wet = inside && water != 0u;
    if (MASKED)
        wet = wet && (surface[number] & 0x1000000u) != 0u;
    if (FOR_GPU && !wet) {
        has_shape = false;
        return 0.0;
    }
    const float nl = float(water), fresh = film_fresh(water, wetted_tick);
    const vec2 radii = bead_radii(number, nl, film_link(wetted_tick), nl * (1.0 - fresh)), shapes = bead_shapes(radii);
    const float covered = dot(radii * radii, 1.0 - shapes) * 3.14159265 / (look.pane.cell_m * look.pane.cell_m);
    has_shape = wet && ((look.sheets != 0u && fresh > 0.0) || shapes.x + shapes.y > 0.0);
    return wet ? min(covered, 1.0) : 0.0;
}

// One cell per texel, on a GPU. Few cells have water: these are listed first, and all lanes share them.
uint mist_of_wet_cells(uvec2 block, uint lane)
{
    const uvec2 first = block * VIRGA_GLASS_MIST_BLOCK;
    for (uint cell = lane; cell < CELLS; cell += LANES)
        if (has_water(first + uvec2(cell % VIRGA_GLASS_MIST_BLOCK, cell / VIRGA_GLASS_MIST_BLOCK)))
            wet_cells[atomicAdd(wet_count, 1u)] = cell;
    barrier();
    for (uint i = lane; i < wet_count; i += LANES) {
        const uint cell = wet_cells[i];
        const uvec2 at = first + uvec2(cell % VIRGA_GLASS_MIST_BLOCK, cell / VIRGA_GLASS_MIST_BLOCK);
        bool shaped;
        const uint own = packUnorm4x8(vec4(cell_mist(at, shaped), 0.0, 0.0, 0.0));
        atomicOr(words[cell / PACKED], own << 8u * (cell % PACKED));
        if (shaped)
            mark_film_tiles(at);
    }
    barrier();
    return words[lane];
}

// One cell per texel, on software Vulkan.
uint mist_of_cells(uvec2 first, out bool has_shape)
{
    bvec4 shaped;
    const float mist0 = cell_mist(first, shaped.x), mist1 = cell_mist(first + uvec2(1u, 0u), shaped.y);
    const float mist2 = cell_mist(first + uvec2(2u, 0u), shaped.z), mist3 = cell_mist(first + uvec2(3u, 0u), shaped.w);
    has_shape = any(shaped);
    return packUnorm4x8(vec4(mist0, mist1, mist2, mist3));
}

uint mist_of_texels(uvec2 first, out bool has_shape)
{
    const uint side = look.mist_cells;
    vec4 mist = vec4(0.0);
    has_shape = false;
    for (uint i = 0u; i < PACKED * side * side; i++) {
        const uint texel = i / (side * side), rest = i % (side * side);
        const uvec2 cell = (first + uvec2(texel, 0u)) * side + uvec2(rest % side, rest / side);
        bool shaped;
        mist[texel] += cell_mist(cell, shaped);
        if (FOR_GPU && shaped)
            mark_film_tiles(cell);
        has_shape = has_shape || shaped;
    }
    return packUnorm4x8(mist / float(side * side));
}

// Draws the block as two triangles; vertices are numbered along the rows of the grid of all blocks.
void draw_block(uvec2 block)
{
    const uint columns = look.mist_pitch / VIRGA_GLASS_MIST_BLOCK + 1u, first = block.x + block.y * columns;
    const uint indices[6] =
        uint[6](first, first + 1u, first + columns, first + columns, first + 1u, first + columns + 1u);
    const uint at = 6u * look.max_tiles + atomicAdd(work.mist.index_count, 6u);
    for (uint i = 0u; i < 6u; i++)
        corners[at + i] = indices[i];
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        any_mist = any_shape = wet_count = 0u;
    if (FOR_GPU)
        words[gl_LocalInvocationIndex] = 0u;
    barrier();
    const uint number = work_list[3u * look.max_tiles + look.max_blocks + gl_WorkGroupID.x];
    const uvec2 block = uvec2(number & 0xffffu, number >> 16);
    const uvec2 own = uvec2(gl_LocalInvocationIndex % COLUMNS, gl_LocalInvocationIndex / COLUMNS);
    const uvec2 first = block * VIRGA_GLASS_MIST_BLOCK + own * uvec2(PACKED, 1u);
    bool has_shape = false;
    const uint word = SEVERAL   ? mist_of_texels(first, has_shape)
                      : FOR_GPU ? mist_of_wet_cells(block, gl_LocalInvocationIndex)
                                : mist_of_cells(first, has_shape);
    mist[(first.x + first.y * look.mist_pitch) / PACKED] = word;
    if (word != 0u)
        atomicOr(any_mist, 1u);
    if (!FOR_GPU && has_shape)
        atomicOr(any_shape, 1u);
    barrier();
    if (gl_LocalInvocationIndex != 0u)
        return;
    if (any_mist != 0u)
        draw_block(block);
    if (!FOR_GPU && any_shape != 0u)
        work_list[2u * look.max_tiles + atomicAdd(work.block_groups[0], 1u)] = number;
}
