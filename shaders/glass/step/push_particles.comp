// push_particles.comp - one round of pushing: overlapping particles part by half of their overlap each, and a bit
// more by the
// penalty (section 4.2); then blades push what they touch. All move at once, from one array of positions into the
// other.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#define FEW
#include "live.glsl"
#include "particles.glsl"
#include "blades.glsl"

layout(push_constant) uniform Turn { uint turn; };

// In units; how many overlapped in .z.
ivec3 push_apart(uint own, uint head, vec2 at)
{
    ivec3 sum = ivec3(0);
    const ivec2 cell = ivec2(head % tick.grid_columns, head / tick.grid_columns);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            const ivec2 near = cell + ivec2(x, y);
            if (any(lessThan(near, ivec2(0))) || near.x >= int(tick.grid_columns) || near.y >= int(tick.grid_rows))
                continue;
            for (uint other = grid[grid_head(near)]; other != 0u; other = grid[grid_next(other - 1u)]) {
                if (other == own + 1u)
                    continue;
                const vec2 off = at - moved[moved_at(other - 1u, turn)];
                const float apart = length(off), overlap = 2.0 * tick.particle_m - apart;
                if (overlap <= 0.0)
                    continue;
                // Two in one place part in a direction that both find by their numbers.
                const float turn_by = 6.2831853 * virga_unit(virga_hash2(min(own, other - 1u), max(own, other - 1u)));
                const vec2 way =
                    apart > 1e-7 ? off / apart : vec2(cos(turn_by), sin(turn_by)) * (own < other - 1u ? 1.0 : -1.0);
                sum += ivec3(ivec2(round(way * (0.5 * (1.0 + tick.penalty) * overlap / UNIT_M))), 1);
            }
        }
    return sum;
}

void main()
{
    const uint own = gl_GlobalInvocationID.x;
    if (own >= state.awake_particles)
        return;
    const uint place = place_of_awake(own);
    const vec2 at = moved[moved_at(own, turn)];
    const ivec3 push = push_apart(own, drops[place].cell, at);
    // In a crowd every one is pushed from many sides: the mean of the pushes, or rounds would overshoot.
    vec2 to = at + vec2(push.xy) * (UNIT_M * (push.z > 2 ? 2.0 / float(push.z) : 1.0));
    bool pushed = false;
    to = push_by_blades(to, to_vec2(drops[place].before), pushed);
    if (pushed)
        drops[place].kind |= VIRGA_GLASS_PUSHED;
    moved[moved_at(own, turn + 1u)] = to;
}
