// list.glsl - the list of splash particles: indices of sorted particles.
#include "shared/compact.h"
layout(scalar, set = 0, binding = 9) readonly buffer SplashList
{
    virga_list_gpu splash_list;
    uint splash_sorted[];
};

uint splash_particle(uint splash) { return sorted_indices[splash_sorted[splash]]; }

vec3 particle_velocity(uint particle)
{
    const vec3 velocity = to_vec(particles[particle].velocity);
    return all(lessThan(abs(velocity), vec3(1e4))) ? velocity : vec3(0.0);
}
