// streak.glsl - the vertices of a streak: its record unpacked, and the four corners of a quad around its path on the
// picture, half a pixel wider than it is drawn, or the two ends of a line of that width.
//
// Software Vulkan sets up one primitive for a line. It shades each block of pixels once, while the two triangles of a
// quad both touch nearly all blocks of a thin streak. Lines take two thirds to three quarters of the time.
//
// Vertices are read from the streak buffer by an ordinary index buffer (0 1 2 2 1 3 and so on): instances of four
// vertices cost software Vulkan half as much again.
#include "shared/rain_limits.h"
#include "streak_form.glsl"
#include "gpu/line.glsl"
#include "gpu/texels.glsl"

TEXELS(streak_texel, 17, 7) // four texels per virga_streak_gpu; behind all of them a texel per motion
#ifdef MOTION
layout(location = 4) noperspective out vec2 motion; // px, see streak_write.comp
#endif

struct Streak {
    vec3 center, rim; // radiance
    float alpha, half_width, body_px, way_px;
    float focus; // [0; 1] 0: the lens blurs it by more than its width, so the inside of the drop does not show
    float wave_turns, wave_turns_at_tail, wave_size;
    vec3 middle_line; // see line_equation
    vec3 middle_ray;  // from the camera to the middle of the path, with a view depth of 1 m
    // of this vertex
    vec4 position;
    float across, along; // px from the center line; px from the tail
    float distance;      // view depth (m)
};

Streak streak_corner(uint vertex)
{
    const uint texel = vertex & ~3u; // four corners and four texels per streak
    const uvec4 ends = streak_texel(texel), depths = streak_texel(texel + 1u), shape = streak_texel(texel + 2u),
                lit = streak_texel(texel + 3u);
    const vec2 head = uintBitsToFloat(ends.xy), tail = uintBitsToFloat(ends.zw);
    const vec2 width_alpha = unpackHalf2x16(shape.x), body_wave = unpackHalf2x16(shape.y);
    const vec2 wave_turns = unpackHalf2x16(shape.z);
    const vec2 light[3] = vec2[3](unpackHalf2x16(lit.x), unpackHalf2x16(lit.y), unpackHalf2x16(lit.z));
    const vec2 half_viewport = 0.5 * vec2(view.viewport[2], view.viewport[3]);
    const vec2 path = (head - tail) * half_viewport;
    const bool at_head = (vertex & 2u) != 0u;
    const vec2 distances = uintBitsToFloat(depths.zw);
    // The middle in space, on the picture: perspective moves it towards the end that is farther away.
    const vec2 middle = (head * distances.x + tail * distances.y) / (distances.x + distances.y);

    Streak streak;
    streak.center = vec3(light[0], light[1].x);
    streak.rim = vec3(light[1].y, light[2]);
    streak.alpha = width_alpha.y;
    streak.half_width = 0.5 * width_alpha.x;
    streak.body_px = body_wave.x;
    const float blur = blur_px(0.5 * (distances.x + distances.y));
    streak.focus = clamp(4.0 * (width_alpha.x / max(blur, 1e-3) - 1.05), 0.0, 1.0);
    streak.way_px = length(path);
    streak.wave_turns = wave_turns.x;
    streak.wave_turns_at_tail = wave_turns.y;
    // Waves are at least 4 px long.
    streak.wave_size = body_wave.y * clamp(streak.way_px / max(4.0 * wave_turns.x, 1e-3) - 0.5, 0.0, 1.0);

    const vec2 along = streak.way_px > 1e-3 ? path / streak.way_px : vec2(0.0, 1.0);
    const float margin = 0.5 * streak.body_px + 0.5;
    const float side_sign = LINES ? 0.0 : (vertex & 1u) == 0u ? -1.0 : 1.0;
    streak.across = side_sign * (streak.half_width + 0.5);
    streak.along = at_head ? streak.way_px + margin : -margin;
    streak.distance = at_head ? distances.x : distances.y;
    const vec2 side = vec2(-along.y, along.x);
    streak.middle_line = line_equation(tail, side);
    streak.middle_ray = to_vec(view.right) * middle.x + to_vec(view.up) * middle.y + to_vec(view.ahead);
    const vec2 corner =
        (at_head ? head : tail) + (side * streak.across + along * (at_head ? margin : -margin)) / half_viewport;
    // w is 1 at all corners, so that everything is interpolated without perspective.
    const float depth = uintBitsToFloat(at_head ? depths.x : depths.y);
#ifdef MOTION
    const vec4 motions = uintBitsToFloat(streak_texel(4u * look.max_streaks + (vertex >> 2)));
    motion = at_head ? motions.xy : motions.zw;
#endif
    streak.position = streak.alpha > 0.0 ? vec4(corner, depth, 1.0) : DRAWN_NOWHERE;
    return streak;
}

float streak_phase(Streak streak)
{
    return streak.wave_turns_at_tail + streak.wave_turns * streak.along / max(streak.way_px, 1.0);
}
