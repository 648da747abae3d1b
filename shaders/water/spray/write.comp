// write.comp - the droplets of each splash particle: V spheres with a V-th of its volume each (equation 3 of Iwasaki et
// al. 2006: R_s = (3 v / (4 pi V))^(1/3)), in a pattern around it that moves with it. The pattern is a ball of points,
// turned at random; with one droplet it is the center. One invocation per splash particle. Reads: the list, splashes,
// particles, densities, droplet_starts. Writes:
// droplets, those that are handed over, splashes, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"
#include "water/packed_share.glsl"
#include "list.glsl"
#include "pattern.glsl"
#include "table.glsl"
#include "leaver.glsl"
#include "hand_over.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(scalar, set = 0, binding = 14) writeonly buffer Droplets { virga_spray_gpu droplets[]; };

vec3 position_of(virga_leaver_gpu own, uint i, vec3 center)
{
    return own.pieces > 1u ? center + frame.spray_pattern * pattern_point(own.id, i, own.pieces) : center;
}

void hand_over_all(virga_leaver_gpu own, uint splash, vec3 center, vec3 velocity)
{
    const uint nl = own_nl(own.particle, own.given_nl);
    begin_hand_over(nl, own.pieces);
    for (uint i = 0u; i < own.pieces; i++)
        hand_over(own, i, position_of(own, i, center), velocity, nl / own.pieces);
    end_hand_over(splash, nl);
}

void main()
{
    const uint splash = gl_GlobalInvocationID.x;
    if (splash >= splash_list.count)
        return;
    const uint sorted_index = splash_sorted[splash], particle = sorted_indices[sorted_index];
    const virga_leaver_gpu own = splashes[splash_now(splash)];
    const vec4 sorted_particle = sorted[sorted_index];
    const vec3 velocity = particle_velocity(particle);
    if ((own.flags & VIRGA_LEAVER_LEAVING) != 0u) {
        hand_over_all(own, splash, sorted_particle.xyz, velocity);
        return;
    }
    const float volume = frame.volume * counted_share(sorted_particle.w) * spray_part(densities[particle]);
    const float radius = pow(0.2387324146 * volume / float(own.pieces), 1.0 / 3.0); // 3 / (4 pi)
    for (uint i = 0u; i < own.pieces; i++) {
        const uint at = droplet_starts[splash] + i;
        if (at >= frame.max_droplets)
            return;
        const vec3 p = position_of(own, i, sorted_particle.xyz);
        droplets[at] = virga_spray_gpu(float[3](p.x, p.y, p.z), radius, float[3](velocity.x, velocity.y, velocity.z),
                                       virga_hash2(own.id, i));
    }
}
