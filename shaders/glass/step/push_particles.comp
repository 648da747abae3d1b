// push_particles.comp - one round of pushing. Overlapping particles move apart by half of their overlap each, and a
// little more (the penalty); then blades push the particles that they touch. All move at once, from one array of
// positions into the other.
// One invocation per particle. Reads: positions, the grid, blades. Writes: positions, drops that were pushed.
// Paper: Goto et al. 2009, section 4.2.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#define FEW
#include "live.glsl"
#include "particles.glsl"
#include "blades.glsl"

layout(push_constant) uniform Round { uint round_number; };

// Returns the displacement in UNIT_M, and in z the number of overlapping neighbours.
ivec3 push_apart(uint particle, uint head, vec2 at)
{
    ivec3 sum = ivec3(0);
    const ivec2 cell = ivec2(head % tick.grid_columns, head / tick.grid_columns);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            const ivec2 near = cell + ivec2(x, y);
            if (any(lessThan(near, ivec2(0))) || near.x >= int(tick.grid_columns) || near.y >= int(tick.grid_rows))
                continue;
            for (uint other = grid[grid_head(near)]; other != 0u; other = grid[grid_next(other - 1u)]) {
                if (other == particle + 1u)
                    continue;
                const vec2 offset = at - moved[moved_at(other - 1u, round_number)];
                const float distance = length(offset), overlap = 2.0 * tick.particle_m - distance;
                if (overlap <= 0.0)
                    continue;
                // Two particles at the same position move apart in a direction that both compute from their numbers.
                const float angle =
                    6.2831853 * virga_unit(virga_hash2(min(particle, other - 1u), max(particle, other - 1u)));
                const vec2 direction = distance > 1e-7
                                           ? offset / distance
                                           : vec2(cos(angle), sin(angle)) * (particle < other - 1u ? 1.0 : -1.0);
                sum += ivec3(ivec2(round(direction * (0.5 * (1.0 + tick.penalty) * overlap / UNIT_M))), 1);
            }
        }
    return sum;
}

void main()
{
    const uint particle = gl_GlobalInvocationID.x;
    if (particle >= state.active_particles)
        return;
    const uint slot = slot_of_active(particle);
    const vec2 at = moved[moved_at(particle, round_number)];
    const ivec3 push = push_apart(particle, drops[slot].cell, at);
    // In a crowd every particle is pushed from many sides: it moves by the mean push, or rounds would overshoot.
    vec2 to = at + vec2(push.xy) * (UNIT_M * (push.z > 2 ? 2.0 / float(push.z) : 1.0));
    bool pushed = false;
    to = push_by_blades(to, to_vec2(drops[slot].previous_position), pushed);
    if (pushed)
        drops[slot].kind |= VIRGA_GLASS_PUSHED;
    moved[moved_at(particle, round_number + 1u)] = to;
}
