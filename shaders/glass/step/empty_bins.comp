// empty_bins.comp - bins along the blades that hold enough water for particles release them ahead of the blade, as
// seeds. First what they have given to the film behind the blade leaves them.
// One invocation per bin. Reads: blades. Writes: bins, seeds.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "blades.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

uint seed_of(uint entry) { return landing_count() + entry; }

void empty_bin(uint bin)
{
    const uint seed = seed_of(state.active_count) + bin, i = bin / VIRGA_GLASS_BINS;
    const uint held = state.bins_nl[bin] - state.given_nl[bin];
    state.bins_nl[bin] = held;
    state.given_nl[bin] = state.asked_nl[bin] = 0u;
    const uint particles = min(held / max(tick.particle_nl, 1u), uint(VIRGA_GLASS_MAX_PARTS));
    seeds[seed].water_nl = 0u;
    if (particles == 0u)
        return;
    const uint hash = virga_hash3(tick.blades[i].random, bin, tick.tick);
    const float share = (float(bin % VIRGA_GLASS_BINS) + virga_unit(hash)) / float(VIRGA_GLASS_BINS) - 0.5;
    const float side = tick.blades[i].side == 0.0 ? 1.0 : tick.blades[i].side;
    const vec2 at = from_blade(i, vec2(side * (tick.blades[i].half_width_m + 1.5 * tick.particle_m),
                                       2.0 * share * tick.blades[i].half_length_m));
    state.bins_nl[bin] = held - particles * tick.particle_nl;
    seeds[seed] = virga_glass_seed_gpu(to_array(at), float[2](0.0, 0.0), tick.particle_nl, particles, 0u, NONE, hash,
                                       VIRGA_GLASS_PARTICLE);
}

void main()
{
    if (gl_GlobalInvocationID.x < tick.blade_count * VIRGA_GLASS_BINS)
        empty_bin(gl_GlobalInvocationID.x);
}
