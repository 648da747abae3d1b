// puff_rects.comp - whether crowns of a puff that are drawn one by one cover points outside of their rectangles.
// One invocation per puff, of random form. Writes: of POINTS points of each how many are covered, how many are in a
// rectangle, how many are covered and in none, and how many are in two.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/random.h"

struct Times {
    float time_open_s, time_close_s;
};
Times view; // as puff_ring.glsl reads it

#include "splash/draw/puff_ring.glsl"
#include "splash/draw/puff_spot.glsl"
#include "splash/draw/puff_crowns.glsl"

#define POINTS 64

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) writeonly buffer Found { uvec4 found[]; };

uint drawn = 0u;

float chance() { return float(virga_hash1(gl_GlobalInvocationID.x * 4096u + drawn++) >> 8) / 16777216.0; }

void main()
{
    const float columns = floor(1.0 + 15.99 * chance()), rows = floor(1.0 + 3.99 * chance());
    const float body_px = 0.5 * exp(4.0 * chance()), wide_px = body_px * (1.0 + 1.5 * columns * chance());
    const float path_px = 4.0 * exp(4.0 * chance()), sine = mix(0.02, 1.0, chance());
    const float life = 1023.0 / 1024.0 * chance();
    const vec4 shape = vec4(0.5 * wide_px, mix(0.01, 1.0, chance()), path_px, body_px);
    const vec4 axis_chance = vec4(rows + life, sine, mix(0.05, 1.0, chance()), columns + 1023.0 / 1024.0 * chance());
    const vec2 low = vec2(-shape.x - 0.5, -0.5), high = vec2(shape.x + 0.5, path_px + 0.5);
    view = Times(-0.02 * chance(), 0.0);
    uvec4 count = uvec4(0u);
    for (int i = 0; i < POINTS; i++) {
        const vec2 position = mix(low, high, vec2(chance(), chance()));
        const PuffCrown crown = crown_of_pixel(shape, axis_chance, position);
        const vec2 at = position - crown.middle;
        const bool covers =
            crown.veil > 0.0 || ring_cover(at, crown.half_wide, crown.high, sine, shape.y, life, crown.chance) > 0.0 ||
            one_crown_cover(at, crown.half_wide, crown.high, sine, crown.chance) > 0.0;
        uint rects = 0u;
        for (uint number = 0u; number < 64u; number++) {
            const vec4 rect = crown_rect(shape, axis_chance, number, low, high);
            rects += all(greaterThan(position, rect.xy)) && all(lessThan(position, rect.zw)) ? 1u : 0u;
        }
        count += uvec4(covers, rects > 0u, covers && rects == 0u, rects > 1u);
    }
    found[gl_GlobalInvocationID.x] = count;
}
