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
#include "puff_crowns.glsl"

// As a spot, or by its ring and droplets where they are large enough to be seen.
float crown_cover(vec2 at, float half_wide, float high, vec4 chance)
{
    const float seen = shape.y > 0.0 ? smoothstep(look.parts_px, 1.5 * look.parts_px, half_wide) : 0.0;
    float spot = 0.0;
    if (!FOR_GPU || seen < 1.0) // software Vulkan runs it for all
        spot = one_crown_cover(at, half_wide, high, axis_chance.y, chance);
    const float parts =
        seen > 0.0 ? ring_cover(at, half_wide, high, axis_chance.y, shape.y, fract(axis_chance.x), chance) : 0.0;
    return mix(spot, parts, seen);
}

#define MAX_OPACITY 0.6 // max opacity of a splash, whose wall is thin

// Of the crown in whose cell the pixel is, and of the veil, see puff_crowns.glsl.
float puff_cover()
{
    const PuffCrown crown = crown_of_pixel(shape, axis_chance, sprite_position.xy);
    const vec2 at = sprite_position.xy - crown.middle;
    // A loop, not a branch: software Vulkan skips a loop where no lane takes it.
    float one = 0.0;
    bool may_cover = crown_may_cover(at, crown.half_wide, crown.high, axis_chance.y, shape.y);
    if (FOR_GPU && may_cover)
        one = crown_cover(at, crown.half_wide, crown.high, crown.chance);
    [[dont_unroll]] for (; !FOR_GPU && may_cover; may_cover = false)
        one = crown_cover(at, crown.half_wide, crown.high, crown.chance);
    const float deep = max(shape.z, 0.1), each = 1.0 / (shape.x * deep);
    const vec2 on_ellipse = vec2(sprite_position.x * deep, 2.0 * sprite_position.y * shape.x) * each - vec2(0.0, 1.0);
    const float uniform_cover = max(1.0 - dot(on_ellipse, on_ellipse), 0.0) * 1.27 *
                                puff_columns(axis_chance) * puff_rows(axis_chance) * each;
    return puff_one_px(shape) * (axis_chance.z * shape.z + 1.0) * mix(crown.covers * one, uniform_cover, crown.veil);
}

float sprite_cover()
{
    const bool cloud = !LINES && rim_kind.w > 2.5, droplet = LINES || rim_kind.w < 0.5;
    const float cover = PUFFS ? puff_cover() : droplet ? droplet_cover() : cloud ? cloud_cover() : pile_cover();
    const float soft = HAS_DEPTH ? soft_edge(1.0 / sprite_position.z) : 1.0;
    return min(center_alpha.a * cover, PUFFS ? MAX_OPACITY : 1.0) * soft;
}
