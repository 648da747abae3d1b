// push_particles.comp - one round of pushing. Overlapping particles move apart by half of their overlap each, and a
// little more (the penalty); then blades push the particles that they touch. All move at once, from one array of
// positions into the other.
//
// In a crowd, those that the rounds could not part merge: the water before a blade is one body, and hundreds of
// particles in one place are only more work, by the square of their number. See crowd_of in engine/glass/glass_step.c.
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

#define SPREADS_S 0.05 // the time in which the particles of one drop move apart

layout(push_constant) uniform Round { uint round_number; };

// Two particles at the same position move apart in a direction that both compute from their numbers. Without an angle:
// software Vulkan computes it for every pair.
vec2 chance_direction(uint particle, uint other)
{
    const uint hash = virga_hash1(min(particle, other) * 0x9e3779b1u + max(particle, other));
    const float t = 2.0 * virga_unit(hash) - 1.0;
    const bool turned = ((hash & 1u) != 0u) != (particle < other);
    return vec2(1.0 - t * t, 2.0 * t) * ((turned ? 1.0 : -1.0) / (1.0 + t * t));
}

// Returns the displacement in UNIT_M, and in z the number of overlapping neighbours. `own`: as in `moved`. `first_near`
// becomes the lowest number of those that are closer than a radius, if that is lower than its own.
ivec3 push_apart(uint place, uvec3 own, uint head, out uint first_near)
{
    ivec3 sum = ivec3(0);
    first_near = own.z;
    const vec2 at = uintBitsToFloat(own.xy);
    const ivec2 cell = ivec2(head % tick.grid_columns, head / tick.grid_columns);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            const ivec2 near = cell + ivec2(x, y);
            if (any(lessThan(near, ivec2(0))) || near.x >= int(tick.grid_columns) || near.y >= int(tick.grid_rows))
                continue;
            const uint near_head = grid_head(near), first = places[place_of_cell(near_head)];
            const uint end = first + grid[near_head]; // the place of an empty cell is one of an earlier tick
            for (uint i = first; i < end; i++) {
                const uvec3 other = moved[moved_at(i, round_number)];
                const vec2 offset = at - uintBitsToFloat(other.xy);
                const float distance = length(offset), overlap = 2.0 * tick.particle_m - distance;
                if (overlap <= 0.0 || i == place)
                    continue;
                if (distance < tick.particle_m)
                    first_near = min(first_near, other.z);
                const vec2 direction = distance > 1e-7 ? offset / distance : chance_direction(own.z, other.z);
                sum += ivec3(ivec2(round(direction * (0.5 * (1.0 + tick.penalty) * overlap / UNIT_M))), 1);
            }
        }
    return sum;
}

void main()
{
    const uint place = gl_GlobalInvocationID.x;
    if (place >= state.active_particles)
        return;
    const uvec3 own = moved[moved_at(place, round_number)];
    const uint slot = slot_of_active(own.z);
    uint first_near;
    const ivec3 push = push_apart(place, own, drops[slot].cell, first_near);
    // In a crowd every particle is pushed from many sides: it moves by the mean push, or rounds would overshoot.
    vec2 to = uintBitsToFloat(own.xy) + vec2(push.xy) * (UNIT_M * (push.z > 2 ? 2.0 / float(push.z) : 1.0));
    bool pushed = false;
    to = push_by_blades(to, to_vec2(drops[slot].previous_position), pushed);
    if (pushed)
        drops[slot].kind |= VIRGA_GLASS_PUSHED;
    if (round_number + 1u < VIRGA_GLASS_RELAX_ROUNDS) {
        moved[moved_at(place, round_number + 1u)] = uvec3(floatBitsToUint(to), own.z);
        return;
    }
    drops[slot].position = to_array(to);
    if (first_near != own.z && push.z >= int(tick.crowd) && drops[slot].age_s > SPREADS_S)
        drops[slot].absorbed_by = slot_of_active(first_near);
}
