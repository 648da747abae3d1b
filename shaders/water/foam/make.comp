// make.comp - new particles of foam (section 3.1 of Ihmsen et al. 2012): in a cylinder around the particle of water,
// along its velocity, as long as it moves in a step. Steps are long here, so it is two spacings long at most, and half
// of it lies on the way that the particle has come. What is farther from the axis flies apart as fast as the water
// there met.
//
// A particle lives longer the higher the potential is that it came from.
// One invocation per particle that makes foam. Reads: the lists, emissions, particles, densities, normals. Writes:
// foam.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define STATE_ACCESS readonly
#include "foam.glsl"
#include "sources.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(scalar, set = 0, binding = 9) readonly buffer SlotList
{
    virga_list_gpu slot_list;
    uint slots[];
};

float random(uint id, uint use) { return virga_unit(virga_hash2(id, use)); }

virga_foam_gpu made(vec4 particle, vec3 velocity, float met, float potential, uint id)
{
    const vec3 axis = dot(velocity, velocity) > 0.0 ? normalize(velocity) : vec3(0.0, 1.0, 0.0);
    const vec3 first = normalize(cross(axis, abs(axis.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
    const vec3 second = cross(axis, first);
    const float angle = 6.28318531 * random(id, 1u), from_axis = sqrt(random(id, 2u));
    const vec3 aside = from_axis * (cos(angle) * first + sin(angle) * second);
    const float wide = min(length(velocity) * state.foam_gap_s, 2.0 * frame.spacing);
    const vec3 p = particle.xyz + 0.5 * frame.spacing * aside + wide * (random(id, 3u) - 0.5) * axis;
    const vec3 v = velocity + 0.5 * met * aside;
    virga_foam_gpu own;
    own.position = float[3](p.x, p.y, p.z);
    own.velocity = float[3](v.x, v.y, v.z);
    own.radius = frame.foam_radius * (0.5 + random(id, 4u) * random(id, 5u));
    own.life_s = mix(frame.foam_life_s[0], frame.foam_life_s[1], potential) * (0.75 + 0.5 * random(id, 6u));
    own.moved = own.velocity;
    own.pad = 0.0;
    own.age_s = 0.0;
    own.id = id;
    return own;
}

void main()
{
    const uint source = gl_GlobalInvocationID.x;
    if (source >= source_list.count)
        return;
    const uint own = sources[source], particle = sorted_indices[own];
    const uvec4 emission = emissions[own];
    const vec4 normal = normals[own], at = sorted[own];
    const vec3 given = to_vec(particles[particle].velocity);
    const float density = densities[particle];
    for (uint i = 0u; i < emission.x; i++) {
        const uint entry = state.foam_first + emission.z + i;
        if (entry >= state.foam)
            return;
        const uint id = virga_hash3(particles[particle].id, frame.foam_now_us, i);
        virga_foam_gpu foam_particle = made(at, given, normal.w, uintBitsToFloat(emission.y), id);
        // What it is until the next step.
        foam_particle.kind = density < 0.5 * frame.level ? VIRGA_FOAM_SPRAY
                             : dot(normal.xyz, normal.xyz) > 0.0 ? VIRGA_FOAM_SURFACE : VIRGA_FOAM_BUBBLE;
        foam_particle.around = 0.0;
        foam[slots[entry]] = foam_particle;
    }
}
