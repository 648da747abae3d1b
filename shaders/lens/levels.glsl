// levels.glsl - levels of blocks of texels, for wide discs.
//
// A disc of radius r reaches pi r^2 texels, so reading all of them is dear for wide ones. Light that spreads over a
// wide disc is summed over blocks of 2, 4 or 8 texels along a side first (blocks.comp). A level has the light of the
// radii between 4 and 8 of its blocks, so no disc needs more than 250 blocks, however wide it is.
//
// A block keeps where its light is and how wide it is spread there: its centroid, and its variance. So the disc of a
// lamp has its place and its sharp edge as if there were no blocks, and a lamp that moves from one block to the next
// does not jump. What light is divided by (its weight, or a layer's coverage) has a centroid of its own: the lamp is
// not divided by more than what is around it.
//
// A block is four words: light and weight as half floats; the radius as a half float and the widths of both discs'
// edges in 8 bits; both centroids in 8 bits.
//
// The blocks of all levels lie in one image. Around each level is a ring of blocks outside of the picture, whose texels
// are those of the picture's edge. The includer has lens.glsl.
#ifndef LEVELS_GLSL
#define LEVELS_GLSL
const uint PARTS = VIRGA_LENS_BLOCK_PARTS;

// Which level has light that spreads so wide.
uint level_of(float radius)
{
    if (view.levels == 0u || abs(radius) <= VIRGA_LENS_FINE)
        return 0u;
    return abs(radius) <= 2.0 * VIRGA_LENS_FINE ? 1u : abs(radius) <= 4.0 * VIRGA_LENS_FINE ? 2u : 3u;
}

// The largest radius of a level.
float level_radius(uint level) { return level < view.levels ? float(VIRGA_LENS_FINE << level) : view.max_radius; }

// Blocks keep means of light. Where the area of its disc is divided out, they keep sums times this instead: a level's
// smallest disc has about so many times the area of a block. So both fit half floats.
const float BLOCKS_PER_DISC = 0.25 * float(VIRGA_LENS_FINE * VIRGA_LENS_FINE);

// The third word. A width is at most sqrt(3) sides, where all light is in two corners.
uint size_word(float radius, vec2 softs, uint level)
{
    return packHalf2x16(vec2(radius, 0.0)) | packUnorm4x8(vec4(0.0, 0.0, softs / float(2 << level)));
}

float radius_of(uint word) { return unpackHalf2x16(word).x; }
vec2 softs_of(uint word, float side) { return 2.0 * side * unpackUnorm4x8(word).zw; }

// The area of the image of a block's light, over pi, and as for discs whatever the aperture is: weights are divided by
// their sum. An edge whose derivative has variance V adds pi V to the area.
float soft_area(float radius, float soft) { return radius * radius + view.edge_area * soft * soft; }

// The bits of the levels: behind the focus, in front of it, and of layers with depths.
uint level_bit(uint group, uint level) { return 1u << (4u * group + level); }

// The highest of a group's levels, for its bits. A loop up to it costs less than one over all: software Vulkan executes
// the body of a loop once at least.
int top_level(uint levels) { return max(findMSB(levels & 15u), 0); }

// Blocks along the picture, and of them in the image with the ring and up to whole workgroups.
ivec2 level_blocks(uint level) { return (ivec2(view.columns, view.rows) + (1 << level) - 1) >> int(level); }
ivec2 level_size(uint level) { return (level_blocks(level) + 2 + 7) & ~7; }

// Rows of the image of blocks that are used.
int blocks_rows() { return level_size(1u).y + level_size(2u).y; }

// Level 2 is below level 1, and level 3 is to the right of level 2.
ivec2 level_origin(uint level)
{
    if (level == 1u)
        return ivec2(0);
    return ivec2(level == 3u ? level_size(2u).x : 0, level_size(1u).y);
}
#endif
