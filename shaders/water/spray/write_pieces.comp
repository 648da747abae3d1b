// write_pieces.comp - the droplets of each splash particle, from its pieces: the physical style. Their volumes add up
// to that part of the particle that left the surface.
// One invocation per splash particle. Reads: the list, splashes, pieces, particles, densities, droplet_starts. Writes:
// droplets, those that are handed over, splashes, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"
#include "water/packed_share.glsl"
#include "list.glsl"
#include "pieces.glsl"
#include "table.glsl"
#include "leaver.glsl"
#include "hand_over.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(scalar, set = 0, binding = 14) writeonly buffer Droplets { virga_spray_gpu droplets[]; };

void hand_over_pieces(virga_leaver_gpu own, uint splash, vec3 position)
{
    const uint nl = own_nl(own.particle, own.given_nl);
    begin_hand_over(nl, own.pieces);
    for (uint i = 0u; i < own.pieces; i++) {
        const virga_water_piece_gpu piece = pieces[piece_now(splash, i)];
        hand_over(own, i, position + to_vec(piece.offset), to_vec(own.velocity) + to_vec(piece.drift),
                  uint(piece.part * float(nl)));
    }
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
    if ((own.flags & VIRGA_LEAVER_LEAVING) != 0u) {
        hand_over_pieces(own, splash, sorted_particle.xyz);
        return;
    }
    const float volume = frame.volume * counted_share(sorted_particle.w) * spray_part(densities[particle]);
    for (uint i = 0u; i < own.pieces; i++) {
        const uint at = droplet_starts[splash] + i;
        if (at >= frame.max_droplets)
            return;
        const virga_water_piece_gpu piece = pieces[piece_now(splash, i)];
        const vec3 p = sorted_particle.xyz + to_vec(piece.offset), v = to_vec(own.velocity) + to_vec(piece.drift);
        const float radius = pow(0.2387324146 * volume * piece.part, 1.0 / 3.0); // 3 / (4 pi)
        droplets[at] = virga_spray_gpu(float[3](p.x, p.y, p.z), radius, float[3](v.x, v.y, v.z),
                                       virga_hash2(own.id, i));
    }
}
