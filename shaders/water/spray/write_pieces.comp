// write_pieces.comp - the droplets of each splash particle, from its pieces: the physical style. Their volumes add up
// to that part of the particle that left the surface.
// One invocation per splash particle. Reads: the list, splashes, pieces, particles, densities, droplet_starts. Writes:
// droplets.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"
#include "list.glsl"
#include "pieces.glsl"
#include "water/spray_part.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(scalar, set = 0, binding = 14) writeonly buffer Droplets { virga_spray_gpu droplets[]; };

void main()
{
    const uint splash = gl_GlobalInvocationID.x;
    if (splash >= splash_list.count)
        return;
    const uint sorted_index = splash_sorted[splash], particle = sorted_indices[sorted_index];
    const virga_water_splash_gpu own = splashes[splash_now(splash)];
    const vec4 sorted_particle = sorted[sorted_index];
    const float volume = frame.volume * sorted_particle.w * spray_part(densities[particle]);
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
