// sprite_pixel.glsl - how much of a pixel a sprite covers.
#include "gpu/streak_profile.glsl"
#include "shared/random.h"
#define SCENE_DEPTH_BINDING 16
#include "gpu/scene_depth.glsl"
#include "gpu/temporal.glsl"
#ifdef MOTION
layout(location = 5) noperspective in vec2 motion;
#endif

layout(constant_id = 0) const bool HAS_DEPTH = true;

layout(location = 0) noperspective in vec4 place;
layout(location = 1) flat in vec4 centre_alpha;
layout(location = 2) flat in vec4 rim_kind;
layout(location = 3) flat in vec4 shape;
layout(location = 4) flat in vec4 turn;
layout(location = 0) out vec4 radiance;

// The share of the time for which a disc covers a place while it goes its way: of the chord through it there, what lies
// on the way, over the way. One that hardly moves goes a pixel, and so has soft ends.
float droplet_cover()
{
    const float half_width = shape.x, way = max(shape.z, 1.0), y = place.y + 0.5 * (way - shape.z);
    const float across = streak_profile(abs(place.x), half_width);
    const float chord = max(shape.w, 0.0) * across;
    const float passed = clamp(min(y + 0.5 * chord, way) - max(y - 0.5 * chord, 0.0), 0.0, way) / way;
    return min(passed, 1.0);
}

// It narrows from its foot like a flame, the more so the wider its foot, and its tip is there for a part of the time.
float pile_half_width()
{
    const float v = 1.0 - clamp(place.y / max(shape.z, 1e-3), 0.0, 1.0);
    return mix(shape.x, shape.y, v * v * (shape.y > 4.0 * shape.x ? v * v : 1.0));
}

float pile_cover()
{
    const float v = clamp(place.y / max(shape.z, 1e-3), 0.0, 1.0), solid = turn.z;
    const float tip = solid < 1.0 ? clamp((1.0 - v) / (1.0 - solid), 0.0, 1.0) : 1.0;
    // Its foot flows out into the water that it stands on.
    const float foot = max(0.8 * shape.y, 1.0);
    const float ends = smoothstep(0.0, 1.0, (place.y + 0.5) / foot) * clamp(shape.z + 0.5 - place.y, 0.0, 1.0);
    return clamp(pile_half_width() + 0.5 - abs(place.x), 0.0, 1.0) * tip * ends;
}

// A crown from afar: it flares, its sides are looked along and so are thicker, its rim is torn. It covers half of its
// rectangle.
float crown_cover(vec2 at, float half_wide, float high, float chance)
{
    const float v = clamp((at.y + 0.5) / (high + 1.0), 0.0, 1.0);
    const float flare = mix(0.3, 0.45, clamp(half_wide - 0.5, 0.0, 1.0)); // a thin one is to miss no pixel
    const float half_width = (half_wide + 0.25) * (1.0 - flare + flare * v), x = min(abs(at.x) / half_width, 1.0);
    const float torn = half_wide > 1.5 ? 0.3 * sin(7.0 * at.x / half_width + 40.0 * chance) : 0.0;
    const float across = (1.0 - smoothstep(0.6, 1.0, x)) * (0.4 + x * x);
    const float up = smoothstep(0.0, 0.2, v) * (1.0 - smoothstep(0.45 + torn, 1.0, v));
    return 1.7 / (1.0 - 0.5 * flare) * across * up;
}

// Several stand on an ellipse, each in a column of its own and as far up as chance has it.
float puff_cover()
{
    const float columns = floor(turn.w), column_px = 2.0 * shape.x / columns;
    const float column = clamp(floor((place.x + shape.x) / column_px), 0.0, columns - 1.0);
    // Of whole numbers, so that all forms of the shader have the same: a large angle's sine depends on what is fused.
    const float chance = virga_unit(virga_hash1(uint(fract(turn.w) * 1024.0) << 4 | uint(column)));
    const float half_wide = min(0.5 * shape.w, shape.x), high = turn.z * shape.z;
    const float from_middle = (column + 0.5) * 2.0 / columns - 1.0, room = shape.z - high;
    const float foot = room * (0.5 + (chance - 0.5) * sqrt(1.0 - from_middle * from_middle));
    const float beside = max(0.5 * column_px - half_wide - 0.25, 0.0) * (2.0 * fract(chance * 64.0) - 1.0);
    const float x = place.x + shape.x - (column + 0.5) * column_px - (columns > 1.5 ? beside : 0.0);
    return crown_cover(vec2(x, place.y - foot), half_wide, high, chance);
}

float sprite_cover()
{
    const float kind = rim_kind.w;
    const float cover = kind < 0.5 ? droplet_cover() : kind < 1.5 ? pile_cover() : puff_cover();
    return min(centre_alpha.a * cover, 1.0) * (HAS_DEPTH ? soft_edge(place.z) : 1.0);
}
