// neighbours_shuffle.comp - lists the neighbours of each particle, and sums up over them, see neighbours.glsl: for
// software Vulkan with subgroups of eight lanes, or a multiple. The same bits as neighbours.comp.
//
// The eight particles of a unit lie side by side, in one or two cells, and have nearly the same candidates. Each lane
// reads one of eight candidates, and all lanes compare all eight, which they get by shuffles: one gather in place of
// eight. Neighbours are noted in an array of the invocation, which costs an eighth of storing them in a buffer, lane by
// lane. All lanes of a unit take the same turns in all loops, so that shuffles find each of them active.
//
// One invocation per sorted particle. Reads: sorted, cell_starts, particles, and what neighbours.glsl reads. Writes:
// what neighbours.glsl writes.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "neighbours.glsl"
#include "unit.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

#define NONE 0xffffffffu

// The neighbours, and room for what is too much.
uint found[MAX_NEIGHBOURS + 1u], found_count;

// Which of up to 32 sorted particles, from `first` on and before `end`, are near, as bits. Both are the same in a unit.
uint near_bits(vec3 here, uint first, uint end)
{
    const uint last = grid.sorted - 1u;
    uint bits = 0u;
    for (uint from = 0u; from < 32u && first + from < end; from += UNIT) {
        const vec3 other = place_at(min(first + from + unit_lane(), last)).xyz;
        uint eight = 0u;
        for (uint k = 0u; k < UNIT; k++) {
            const vec3 apart = here - unit_read(other, k);
            eight |= dot(apart, apart) < REACH2 ? 1u << k : 0u;
        }
        bits |= eight << from;
    }
    return bits;
}

// Bits from `bit` on.
uint bits_from(uint bit) { return bit < 32u ? NONE << bit : 0u; }

// Of the bits of near_bits, those of the particle's own candidates, without itself.
uint own_bits(uint bits, uint i, uint first, uvec2 run)
{
    const uint own = i - first; // large if it is before `first`
    bits &= own < 32u ? ~(1u << own) : NONE;
    return run.x < run.y ? bits & bits_from(run.x - first) & ~bits_from(run.y - first) : 0u;
}

void note(uint bits, uint first)
{
    const uint most = unit_max(uint(bitCount(bits)));
    for (uint k = 0u; k < most; k++) {
        found[min(found_count, MAX_NEIGHBOURS)] = first + uint(findLSB(bits));
        found_count += bits != 0u ? 1u : 0u;
        bits &= bits - 1u;
    }
}

// Lanes behind the last particle, whose cell is that of the last one, have no candidates.
void list_neighbours(uint i, uint cell, vec3 here)
{
    const uvec3 dims = grid_dims();
    found_count = 0u;
    for (uint row = 0u; row < 9u; row++) {
        uvec2 run = neighbour_row(cell, row, dims);
        run.y = i < grid.sorted ? run.y : run.x;
        const uint end = unit_max(run.y);
        // The first candidate that any lane has left. Runs of cells that no lane looks at are left out.
        uint first = unit_min(run.x < run.y ? run.x : NONE);
        for (; first != NONE; first = unit_min(run.x < run.y ? run.x : NONE)) {
            note(own_bits(near_bits(here, first, end), i, first, run), first);
            run.x = max(run.x, first + 32u);
        }
    }
    found_count = min(found_count, MAX_NEIGHBOURS);
}

uvec4 listed(uint i, uint t)
{
    const uint k = 4u * t;
    return uvec4(found[k], k + 1u < found_count ? found[k + 1u] : i, k + 2u < found_count ? found[k + 2u] : i,
                 k + 3u < found_count ? found[k + 3u] : i);
}

void main()
{
    const uint i = gl_GlobalInvocationID.x, own = min(i, grid.sorted - 1u);
    dt = state.dt_s;
    place = place_at(own);
    list_neighbours(i, cell_at(to_vec(particles[sorted_indices[own]].position)), place.xyz);
    if (i < grid.sorted)
        sum_up(i, found_count);
}
