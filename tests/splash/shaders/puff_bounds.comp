// puff_bounds.comp - whether small crowns cover points that crown_may_cover leaves out.
// One invocation per crown, of random size. Writes: of POINTS points around each how many it covers, how many it may
// cover, and how many it covers that are left out.
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

#define POINTS 256

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) writeonly buffer Found { uvec4 found[]; };

uint drawn = 0u;

float chance() { return float(virga_hash1(gl_GlobalInvocationID.x * 4096u + drawn++) >> 8) / 16777216.0; }

void main()
{
    const float half_wide = 0.25 * exp(4.5 * chance()), high = 0.1 * exp(6.0 * chance());
    const float sine = mix(0.02, 1.0, chance()), share = mix(0.01, 1.0, chance()), life = 1023.0 / 1024.0 * chance();
    const vec4 form = vec4(chance(), chance(), chance(), chance());
    view = Times(-0.02 * chance(), 0.0);
    const vec2 reach = 1.5 * vec2(half_wide + 3.0, half_wide + high + 3.0);
    uvec3 count = uvec3(0u);
    for (int i = 0; i < POINTS; i++) {
        const vec2 at = reach * (2.0 * vec2(chance(), chance()) - 1.0);
        const bool covers = ring_cover(at, half_wide, high, sine, share, life, form) > 0.0 ||
                            one_crown_cover(at, half_wide, high, sine, form) > 0.0;
        const bool may = crown_may_cover(at, half_wide, high, sine, share);
        count += uvec3(covers, may, covers && !may);
    }
    found[gl_GlobalInvocationID.x] = uvec4(count, 0u);
}
