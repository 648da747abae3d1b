// blocks.glsl - reads blocks of texels, and covers texels by their discs, see levels.glsl. The includer has lens.glsl.
#include "aperture.glsl"
#include "levels.glsl"

layout(set = 0, binding = 30) uniform usampler2DArray blocks;

// A level seen from a texel.
struct seen_level {
    ivec2 origin, last; // in the image; the last block of the ring
    vec2 from;          // the texel's centre
    float side;         // of a block
    float reach;        // of discs; below 0: none
};

struct block {
    vec4 light;        // and its weight
    vec2 apart;        // of the light, from the texel
    vec2 weight_apart; // of the weight
    float radius;      // signed
    vec2 softs;        // width of the edges of the light's disc and of the weight's
};

seen_level see_level(uint level, ivec2 texel, float reach)
{
    return seen_level(level_origin(level) + 1, level_blocks(level), vec2(texel) + 0.5, float(1 << level), reach);
}

// How far beyond a block its disc can reach, in sides of blocks. Light whose centroid is t sides inside the block's
// edge has a variance of t (1 - t) sides^2 at most, so half of its edge, which is sqrt(12) * 1.43 deviations wide, ends
// at 2.48 sqrt(t (1 - t)) - t beyond it at most.
const float BEYOND = 0.84;

// The rows of blocks that a disc around the texel meets.
ivec2 rows_of(seen_level at)
{
    const float far = at.reach + BEYOND * at.side;
    return at.reach < 0.0 ? ivec2(0, -1) : ivec2(floor((at.from.y + vec2(-far, far)) / at.side));
}

ivec2 columns_of(seen_level at, int row)
{
    const float far = at.reach + BEYOND * at.side;
    const float down = max(abs((float(row) + 0.5) * at.side - at.from.y) - 0.5 * at.side, 0.0);
    const float right = sqrt(max(far * far - down * down, 0.0));
    return ivec2(floor((at.from.x + vec2(-right, right)) / at.side));
}

uvec4 block_words(seen_level at, ivec2 index, uint kind, uint part)
{
    return texelFetch(blocks, ivec3(at.origin + clamp(index, ivec2(-1), at.last), kind * PARTS + part), 0);
}

block block_at(seen_level at, ivec2 index, uint kind)
{
    const uvec4 words = block_words(at, index, kind, VIRGA_LENS_BLOCK_LIGHT);
    const vec2 middle = (vec2(index) + 0.5) * at.side - at.from;
    const vec4 places = 0.5 * at.side * unpackSnorm4x8(words.w);
    return block(vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y)), middle + places.xy, middle + places.zw,
                 radius_of(words.z), softs_of(words.z, at.side));
}

// The layer on the scene in a block.
vec4 block_on_scene(seen_level at, ivec2 index, uint kind)
{
    const uvec4 words = block_words(at, index, kind, VIRGA_LENS_BLOCK_ON_SCENE);
    return vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y));
}

// An edge as soft as a block of even light is wide, s. The discs of blocks lie s apart, so their sum has ripples of
// the frequencies of that grid: 1 / s, and sqrt(2) / s across. The derivative of this edge is a parabola of width w,
// whose Fourier transform 3 (sin x - x cos x) / x^3, x = pi w f, is 0 at 1 / s and 0.07 at sqrt(2) / s, if w = 1.43 s.
// Its variance is w^2 / 20 = VIRGA_LENS_EDGE_VARIANCE s^2.
float soft_edge(float inside_by, float soft)
{
    const float part = clamp(inside_by / (1.43 * soft) + 0.5, 0.0, 1.0);
    return part * part * (3.0 - 2.0 * part);
}

// The aperture's reach grows along a ray as the distance does, and along a straight blade it is linear. Its image is
// finest at the rim.
float reach_per_distance(vec2 apart, float distance)
{
    const vec2 at_rim = apart * (float(VIRGA_LENS_MAX_RADIUS - 2) / max(distance, 1e-3));
    const ivec2 low = ivec2(floor(at_rim));
    const ivec2 first = low + VIRGA_LENS_MAX_RADIUS;
    const float here = texelFetch(aperture_image, first, 0).r;
    const vec2 beside = vec2(texelFetch(aperture_image, first + ivec2(1, 0), 0).r,
                             texelFetch(aperture_image, first + ivec2(0, 1), 0).r);
    return (here + dot(beside - here, at_rim - vec2(low))) / float(VIRGA_LENS_MAX_RADIUS - 2);
}

// As `covers` in aperture.glsl, for wide discs at any place and with a soft edge.
float soft_covers(vec2 apart, float radius, float soft, barrel cut)
{
    const float distance = length(apart);
    if (!SHAPED)
        return soft_edge(radius - distance, soft);
    const float first = soft_edge(radius / reach_per_distance(apart, distance) - distance, soft);
    if (view.cats_eye <= 0.0)
        return first;
    // Two soft edges whose normals have an angle to each other: as of two normal distributions with its cosine as their
    // correlation. Where the edges are along each other that is the smaller coverage, and the product where they cross.
    const vec2 from_second = apart - cut.shift * radius;
    const float second_distance = length(from_second);
    const float second = soft_edge(radius - second_distance, soft);
    const float correlation = clamp(dot(apart, from_second) / max(distance * second_distance, 1e-3), 0.0, 1.0);
    return mix(first * second, min(first, second), 2.0 / 3.14159265 * asin(correlation)) * cut.per_share;
}

// How much of the texel the discs of a block's light and of its weight cover, for a radius of a sign.
vec2 block_covers(block source, float radius, barrel cut)
{
    const float side = radius < 0.0 ? 1.0 : -1.0; // the image of what is in front of the focus is upside down
    return vec2(soft_covers(side * source.apart, abs(radius), source.softs.x, cut),
                soft_covers(side * source.weight_apart, abs(radius), source.softs.y, cut));
}
