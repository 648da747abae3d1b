// splat_gaps.comp - how much of each pixel the nearest water leaves open, first pass: what its own sum of weights says.
// The depth pass hides what is behind a splat over the whole of it, but at a border of the surface, as at a crest, its
// weights fall to 0 within the splat. Blocks with pixels that are neither whole nor empty are listed for
// splat_close.comp. Their order does not matter, as each pixel is written from the sums alone.
// One invocation per pixel of the effect's images. Reads: sums, the grid's state. Writes: gaps, open blocks, the list
// of blocks.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#define SCALED false
#include "surface.glsl"
#include "prepared.glsl"
#include "gap_blocks.glsl"
#include "mark_block.glsl"
#include "gap_image.glsl"
#include "shared/particle_grid.h"
layout(scalar, set = 0, binding = 9) readonly buffer Grid { virga_particle_grid_gpu grid; };

layout(local_size_x = VIRGA_WATER_BLOCK_PX, local_size_y = VIRGA_WATER_BLOCK_PX) in;

void main()
{
    const ivec2 here = ivec2(gl_GlobalInvocationID.xy);
    if (here == ivec2(0)) {
        prepared.block_groups[1] = 1u;
        prepared.block_groups[2] = 1u;
    }
    if (here.x >= int(look.width) || here.y >= int(look.height))
        return;
    const vec4 sums = texelFetch(sums_image, here, 0);
    const float missing = grid.fading_groups[0] > 0u ? missing_of(sums, texelFetch(motion_image, here, 0)) : 0.0;
    const float weight = sums.w + missing, there = weight > 0.0 ? sums.w / weight : 1.0;
    const bool is_whole = there >= WHOLE;
    write_gap(here, weight > LEAST ? (is_whole ? 0.0 : 1.0 - there) : FILL, weight, weight, there);
    if (weight <= 0.0 || (is_whole && weight >= ENOUGH)) // no water in front, so there is none behind it
        return;
    if (weight <= LEAST || !is_whole)
        mark_block(first_open_texel(), here);
    if (weight <= LEAST || weight >= ENOUGH)
        return;
    if (!mark_block(0u, here))
        open_words[listed_word(atomicAdd(prepared.block_groups[0], 1u))] = gl_WorkGroupID.y << 16 | gl_WorkGroupID.x;
}
