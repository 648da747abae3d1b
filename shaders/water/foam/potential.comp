// potential.comp - how much foam each particle of water makes (section 3.1 of Ihmsen et al. 2012).
//
//     n = I_k (k_ta I_ta + k_wc I_wc) dt       (equation 5)
//
// I_k, I_ta and I_wc go from 0 to 1 (equation 1): by the kinetic energy, here of a kilogram, so that it does not depend
// on how large particles are; by the trapped air (normal.comp); and by the crest of a wave. At a crest the surface is
// convex and moves along its normal. Convex it is by the sum over the neighbours that are below the tangential plane of
// (1 - n_i . n_j) W (equation 4), divided as trapped air is; along the normal it moves if v_i . n_i is at least 0.6,
// with unit vectors. Particles of foam are whole: n is rounded by a random number.
//
// One invocation per sorted particle. Reads: sorted, sorted_velocities, normals. Writes: emissions, selection.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define STATE_ACCESS readonly
#include "foam.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 7
#define COMPACT_LIST_BINDING 13
#include "gpu/compact_mark.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

vec3 here, normal;
float inv_h2, crest;

void visit(uint i, vec4 particle);
#include "gather.glsl"
TEXELS(velocity_texel, 16, 14)
TEXELS(normal_texel, 17, 11)

void visit(uint i, vec4 particle)
{
    const vec3 apart = particle.xyz - here;
    const float q2 = dot(apart, apart) * inv_h2;
    if (q2 < 1.0 && dot(apart, normal) < 0.0) {
        const vec3 other = uintBitsToFloat(normal_texel(i)).xyz;
        if (dot(other, other) > 0.0) // inside the water there is no normal
            crest += particle.w * (1.0 - dot(normal, other)) * (1.0 - sqrt(q2));
    }
}

float crest_potential(uint own, vec3 velocity)
{
    normal = uintBitsToFloat(normal_texel(own)).xyz;
    if (dot(velocity, normal) < 0.6 * length(velocity) || dot(normal, normal) == 0.0)
        return 0.0;
    inv_h2 = frame.inv_h2;
    crest = 0.0;
    gather(cell_at(here));
    return clamped(crest * frame.foam_inv_weights, frame.foam_crest[0], frame.foam_crest[1]);
}

// x: number of particles, y: bits of the potential.
uvec2 emission_of(uint own, float gap_s)
{
    const vec4 particle = uintBitsToFloat(sorted_texel(own));
    const vec4 moving = uintBitsToFloat(velocity_texel(own)); // w: see surface/cover.comp
    const vec3 velocity = moving.xyz;
    const float energy = clamped(0.5 * dot(velocity, velocity), frame.foam_energy[0], frame.foam_energy[1]);
    if (energy <= 0.0 || gap_s <= 0.0)
        return uvec2(0u);
    here = particle.xyz;
    const float air = clamped(uintBitsToFloat(normal_texel(own)).w, frame.foam_air[0], frame.foam_air[1]);
    const float waves = crest_potential(own, velocity);
    const float made =
        particle.w * moving.w * energy * (frame.foam_rates[0] * air + frame.foam_rates[1] * waves) * gap_s;
    const uint id = particles[sorted_indices[own]].id;
    const float rounded = floor(made + virga_unit(virga_hash3(id, frame.foam_now_us, 0xf0a3u)));
    return uvec2(uint(min(rounded, float(VIRGA_WATER_FOAM_EACH))), floatBitsToUint(energy * max(air, waves)));
}

void main()
{
    const uint own = gl_GlobalInvocationID.x;
    uvec2 emission = uvec2(0u);
    if (own < grid.sorted) {
        emission = emission_of(own, foam_gap_s());
        emissions[own] = uvec4(emission, 0u, 0u);
    }
    mark_selected(emission.x > 0u ? FIRST_KIND : NOT_SELECTED);
}
