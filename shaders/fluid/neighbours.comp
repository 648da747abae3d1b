// neighbours.comp - lists the neighbours of each particle, and sums up over them, see neighbours.glsl.
// One invocation per sorted particle. Reads: sorted, cell_starts, particles, and what neighbours.glsl reads. Writes:
// lists, and what neighbours.glsl writes.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "neighbours.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

// Which of up to 32 sorted particles from `first` on are neighbours, as bits.
uint near_bits(uint i, vec3 here, uint first, uint end)
{
    uint bits = 0u;
    const uint count = min(end - first, 32u);
    for (uint k = 0u; k < count; k++) {
        const vec3 apart = here - place_at(first + k).xyz;
        bits |= dot(apart, apart) < REACH2 ? 1u << k : 0u;
    }
    const uint own = i - first;
    return own < 32u ? bits & ~(1u << own) : bits;
}

// Lists the neighbours of a particle, four in a texel; the last texel is filled up with the particle itself. Returns
// their number. Seven of eight particles in the cells around are too far away. So these are first only marked: lanes of
// a group would wait for each other wherever one of them does more, and they store where any of them has a neighbour.
uint list_neighbours(uint i, vec3 here)
{
    const uvec3 dims = grid_dims();
    const uint cell = cell_at(to_vec(particles[sorted_indices[i]].position)), stride = frame.stride;
    uvec4 four = uvec4(i);
    uint count = 0u;
    for (uint row = 0u; row < 9u; row++) {
        const uvec2 run = neighbour_row(cell, row, dims);
        for (uint first = run.x; first < run.y; first += 32u) {
            uint bits = near_bits(i, here, first, run.y);
            for (; bits != 0u && count < MAX_NEIGHBOURS; bits &= bits - 1u) {
                four = uvec4(four.yzw, first + uint(findLSB(bits)));
                count++;
                if ((count & 3u) != 0u)
                    continue;
                lists[(count / 4u - 1u) * stride + i] = four;
                four = uvec4(i);
            }
        }
    }
    if ((count & 3u) != 0u)
        lists[count / 4u * stride + i] = four;
    return count;
}

uvec4 listed(uint i, uint t) { return lists[t * frame.stride + i]; }

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    dt = state.dt_s; // read before the branch, see push.comp
    if (i >= grid.sorted)
        return;
    place = place_at(i);
    sum_up(i, list_neighbours(i, place.xyz));
}
