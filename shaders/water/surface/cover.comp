// cover.comp - how much of the water around a particle is there, of particles that appear or vanish.
//
// A particle counts with a share of its volume. Where one vanishes among others, the surface sinks by degrees. Where
// all of a body of water vanishes, the density falls in all of it, and the surface, which is where the density has a
// fixed value, would stay in its place and then be gone all at once. So the shares are taken apart: that of the water
// around a particle, its cover, is how much of the surface is seen (draw/splat_sum.frag), and the share over the cover
// is what counts for the density (relative.comp).
//
// The cover is the largest share of all neighbours, each with a factor that falls to 0 with the distance, so that it
// changes by degrees as they move. Among whole particles it is 1.
//
// One invocation per sorted particle; no workgroups where all particles are whole. Reads: sorted, cell_starts. Writes:
// the fourth component of sorted_velocities.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "water/grid.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(std430, set = 0, binding = 15) buffer SortedVelocities { vec4 sorted_velocities[]; };

vec3 here;
float cover, inv_h2;

void visit(vec4 particle)
{
    const vec3 apart = particle.xyz - here;
    const float q = sqrt(dot(apart, apart) * inv_h2);
    cover = max(cover, particle.w * clamp((1.0 - q) / (1.0 - VIRGA_WATER_COVER_NEAR), 0.0, 1.0));
}
#include "water/gather.glsl"

void main()
{
    const uint own = gl_GlobalInvocationID.x;
    if (own >= grid.sorted)
        return;
    const vec4 particle = uintBitsToFloat(sorted_texel(own));
    here = particle.xyz;
    cover = particle.w;
    inv_h2 = frame.inv_h2;
    gather(cell_at(here));
    sorted_velocities[own].w = min(cover, 1.0);
}
