// sprite_pixel.glsl - how much of a pixel a sprite covers.
#include "gpu/streak_profile.glsl"
#include "gpu/variants.glsl"
#include "shared/random.h"
#include "sprite_form.glsl"
#define SCENE_DEPTH_BINDING 16
#include "gpu/scene_depth.glsl"
#include "gpu/temporal.glsl"
#ifdef MOTION
layout(location = 5) noperspective in vec2 motion;
#endif

layout(location = 0) noperspective in vec4 sprite_position;
layout(location = 1) flat in vec4 center_alpha;
layout(location = 2) flat in vec4 rim_kind;
layout(location = 3) flat in vec4 shape;
layout(location = 4) flat in vec4 axis_chance;
layout(location = 0) out vec4 radiance;

// px from the center line; the ends of a line do not know it.
float from_middle()
{
    return LINES ? dot(axis_chance.xyz, vec3(gl_FragCoord.xy, 1.0)) : sprite_position.x;
}

// The fraction of the time for which a moving disc covers the pixel: the part of its chord there that is on the path,
// over the path. One that hardly moves has a path of a pixel, which gives soft ends.
float droplet_cover()
{
    const float half_width = shape.x, path = max(shape.z, 1.0), y = sprite_position.y + 0.5 * (path - shape.z);
    const float across = streak_profile(abs(from_middle()), half_width);
    const float chord = max(shape.w, 0.0) * across;
    const float passed = clamp(min(y + 0.5 * chord, path) - max(y - 0.5 * chord, 0.0), 0.0, path) / path;
    return min(passed, 1.0);
}

// A cloud that moves covers the area of one at rest: pi / 3 R^2 and, of its path, 16 / 15 R.
float cloud_cover()
{
    const float r = max(shape.x, 0.5), path = max(shape.z, 0.0);
    const float beyond = max(max(-sprite_position.y, sprite_position.y - path), 0.0);
    const vec2 at = vec2(sprite_position.x, beyond) / r;
    const float inside = max(1.0 - dot(at, at), 0.0);
    return inside * inside * 1.0471976 * r / (1.0471976 * r + 1.0666667 * path);
}

// A pile narrows from its foot like a flame, a cone on a wide foot like a hyperbola: it rises from the water level.
bool is_cone()
{
    return shape.y > 4.0 * shape.x;
}

#define CONE_FOOT 0.12 // of its height

float pile_half_width()
{
    const float up = clamp(sprite_position.y / max(shape.z, 1e-3), 0.0, 1.0), v = 1.0 - up;
    const float cone = CONE_FOOT / (1.0 + CONE_FOOT), level = CONE_FOOT / (up + CONE_FOOT);
    return mix(shape.x, shape.y, is_cone() ? (level - cone) / (1.0 - cone) : v * v);
}

// Its tip is there for a part of the time. The nearly flat part of a cone's foot looks like the water beside it.
float pile_cover()
{
    const float v = clamp(sprite_position.y / max(shape.z, 1e-3), 0.0, 1.0), solid = axis_chance.z;
    const float tip = solid < 1.0 ? clamp((1.0 - v) / (1.0 - solid), 0.0, 1.0) : 1.0;
    // Its foot merges with the water that it stands on.
    const float foot = max(0.8 * shape.y, 1.0);
    const float ends =
        smoothstep(0.0, 1.0, (sprite_position.y + 0.5) / foot) * clamp(shape.z + 0.5 - sprite_position.y, 0.0, 1.0);
    const float half_width = pile_half_width(), level = half_width / max(shape.x, 1e-3);
    const float flat_foot = is_cone() ? 1.0 - smoothstep(3.0, 10.0, level) : 1.0;
    return clamp(half_width + 0.5 - abs(sprite_position.x), 0.0, 1.0) * tip * ends * flat_foot;
}

#include "puff_spot.glsl"
#include "puff_ring.glsl"

// As a spot, or by its ring and droplets where they are large enough to be seen.
float crown_cover(vec2 at, float half_wide, float high, vec4 chance)
{
    const float spot = one_crown_cover(at, half_wide, high, axis_chance.y, chance);
    const float seen = shape.y > 0.0 ? smoothstep(look.parts_px, 1.5 * look.parts_px, half_wide) : 0.0;
    const float parts =
        seen > 0.0 ? ring_cover(at, half_wide, high, axis_chance.y, shape.y, fract(axis_chance.x), chance) : 0.0;
    return mix(spot, parts, seen);
}

#define MAX_OPACITY 0.6 // max opacity of a splash, whose wall is thin

// Several crowns on an ellipse, each at its own position. They differ in size and age; the one at the opposite position
// covers less by what one covers more than the mean. Together they cover half of their rectangle. Small ones close
// together are not told apart by the eye: half of their coverage is drawn as a uniform veil.
float puff_cover()
{
    const float columns = floor(axis_chance.w), column_px = 2.0 * shape.x / columns, rows = floor(axis_chance.x);
    const float column = clamp(floor((sprite_position.x + shape.x) / column_px), 0.0, columns - 1.0);
    const float from_middle = (column + 0.5) * 2.0 / columns - 1.0, aside = from_middle * from_middle;
    // Each column has its own offset, or they would form rows.
    const float room = rows > 1.5 ? 0.85 - 0.3 * aside : 1.0, row_px = shape.z * room / rows;
    const float lowest = shape.z * (1.0 - room) * fract(0.618 * column + axis_chance.w);
    const float row = clamp(floor((sprite_position.y - lowest) / row_px), 0.0, rows - 1.0);

    const float number = row * columns + column, opposite = columns * rows - 1.0 - number;
    // From integers, so that all variants of the shader get the same: the sine of a large angle depends on how
    // operations are fused.
    const uint pair = virga_hash1(uint(1024.0 * fract(axis_chance.w)) << 6 | uint(min(number, opposite)));
    const float more = sign(opposite - number), several = columns > 1.5 ? 1.0 : 0.0;
    const float covers = 1.0 + 0.9 * more * unpackUnorm4x8(pair).x, size = 0.35 + 0.65 * covers;
    const float close = clamp(1.6 - 0.1 * column_px * row_px, 0.0, 1.0) * several;
    const float veil = close * clamp(1.25 - 0.5 * shape.w, 0.0, 0.5);
    const vec4 chance = unpackUnorm4x8(more < 0.0 ? pair * 0x9e3779b1u : pair);
    const float ahead = several * (2.0 * chance.y - 1.0), late = 2.0 * fract(axis_chance.x) - 1.0;
    const float one_px = 0.5 * min(shape.w, 2.0 * shape.x) + 0.25, one_high = axis_chance.z * shape.z;
    const float half_wide = min(one_px * (1.0 + veil) * size * (1.0 - 0.25 * ahead), 0.5 * column_px + 0.25);
    const float depth = axis_chance.y * half_wide, tall = min(size * (1.0 + 0.55 * ahead * late), 2.0) * one_high;
    const float high = columns > 1.5 ? min(tall, max(row_px - 2.0 * depth - 1.5, 0.3 * row_px)) : one_high;
    const float up = max(row_px - high - 2.0 * depth, 0.0);
    const float foot = up * (0.5 + (chance.z - 0.5) * (rows > 1.5 ? 1.0 : 1.0 - aside)) + depth;
    const float beside = several * max(0.5 * column_px - half_wide, 0.0) * (2.0 * chance.w - 1.0);
    const vec2 at = vec2(sprite_position.x + shape.x - (column + 0.5) * column_px - beside,
                         sprite_position.y - lowest - row * row_px - foot);
    // A loop, not a branch: software Vulkan skips a loop where no lane takes it.
    float one = 0.0;
    bool may_cover = crown_may_cover(at, half_wide, high, axis_chance.y, shape.y);
    if (FOR_GPU && may_cover)
        one = crown_cover(at, half_wide, high, chance);
    [[dont_unroll]] for (; !FOR_GPU && may_cover; may_cover = false)
        one = crown_cover(at, half_wide, high, chance);
    const float deep = max(shape.z, 0.1), each = 1.0 / (shape.x * deep);
    const vec2 on_ellipse = vec2(sprite_position.x * deep, 2.0 * sprite_position.y * shape.x) * each - vec2(0.0, 1.0);
    const float uniform_cover = max(1.0 - dot(on_ellipse, on_ellipse), 0.0) * 1.27 * columns * rows * each;
    return one_px * (one_high + 1.0) * mix(covers * one, uniform_cover, veil);
}

float sprite_cover()
{
    const bool cloud = !LINES && rim_kind.w > 2.5, droplet = LINES || rim_kind.w < 0.5;
    const float cover = PUFFS ? puff_cover() : droplet ? droplet_cover() : cloud ? cloud_cover() : pile_cover();
    const float soft = HAS_DEPTH ? soft_edge(1.0 / sprite_position.z) : 1.0;
    return min(center_alpha.a * cover, PUFFS ? MAX_OPACITY : 1.0) * soft;
}
