// splat_gaps.comp - how much of each pixel the nearest water leaves open, first pass: what its own sum of weights says.
// The depth pass hides what is behind a splat over the whole of it, but at a border of the surface, as at a crest, its
// weights fall to 0 within the splat. Blocks with pixels that are neither whole nor empty are listed for
// splat_close.comp. Their order does not matter, as each pixel is written from the sums alone.
// One invocation per pixel of the effect's images. Reads: sums. Writes: gaps, open blocks, the list of blocks.
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
    const float weight = texelFetch(sums_image, here, 0).w;
    write_gap(here, weight > LEAST ? 0.0 : FILL, weight);
    if (weight >= ENOUGH || weight <= 0.0) // no water in front, so there is none behind it
        return;
    if (weight <= LEAST)
        mark_block(first_open_texel(), here);
    else if (!mark_block(0u, here))
        open_words[listed_word(atomicAdd(prepared.block_groups[0], 1u))] = gl_WorkGroupID.y << 16 | gl_WorkGroupID.x;
}
