// body_sums.glsl - sums over the contacts of a body, by one workgroup, in an order that is always the same.
layout(local_size_x = VIRGA_FLUID_LANES) in;

shared vec3 lane_force[VIRGA_FLUID_LANES], lane_torque[VIRGA_FLUID_LANES];

struct Push {
    vec3 force, torque;
};

// Adds up the lanes' sums, by halves.
Push sum_of_lanes(Push own)
{
    const uint lane = gl_LocalInvocationIndex;
    lane_force[lane] = own.force;
    lane_torque[lane] = own.torque;
    for (uint half_count = VIRGA_FLUID_LANES / 2u; half_count > 0u; half_count /= 2u) {
        barrier();
        if (lane < half_count) {
            lane_force[lane] += lane_force[lane + half_count];
            lane_torque[lane] += lane_torque[lane + half_count];
        }
    }
    return Push(lane_force[0], lane_torque[0]);
}

uint contact_count(uint body) { return min(bodies[body].contacts, frame.max_contacts); }
uint contact_of(uint body, uint index) { return contacts[body * frame.max_contacts + index]; }
