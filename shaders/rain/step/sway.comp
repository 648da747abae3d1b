// sway.comp - integrates what a host's 3D wind does to each drop in addition to the uniform wind.
// One invocation per slot. Reads: drops, the wind texture. Writes: sways.
//
// A drop's motion is dv/dt = -g - (g / vt^2) |v - w| (v - w), with w the wind at the drop. The class already has the
// part of the uniform wind; here the difference is kept. It is implicit in the drag, so that small drops (relaxation
// time 0.07 s) are stable with any tick.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define SWAYS_ACCESS // written here
#include "rain/field.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
layout(set = 0, binding = 11) uniform sampler3D wind;

void main()
{
    const uint slot_index = gl_GlobalInvocationID.x;
    const uint level = slot_level(slot_index);
    const uint size_class = slot_of(slot_index).class_rank & 0xffffu;
    const vec3 p = to_vec(drop_of(slot_index).position); // at the end of the previous tick
    const vec3 class_velocity = to_vec(classes[size_class].velocity);
    virga_sway_gpu sway = sways[slot_index];

    vec3 air = to_vec(tick.wind_mean);
    if (tick.wind_given != 0u)
        air += textureLod(wind, (p - to_vec(tick.wind_min)) * to_vec(tick.wind_scale), 0.0).xyz;
    // The class has made this tick's step already: this is its velocity before it. Otherwise the uniform wind would
    // count twice.
    const float class_drag = classes[size_class].drag;
    const vec3 class_before = class_velocity * (1.0 + class_drag) - class_drag * to_vec(tick.wind_mean) +
                              vec3(0.0, tick.gravity * tick.tick_s, 0.0);
    const vec3 velocity = class_before + to_vec(sway.velocity);
    const float terminal = classes[size_class].terminal_m_s;
    const float drag = tick.gravity / (terminal * terminal) * length(velocity - air) * tick.tick_s;
    const vec3 after = (velocity + drag * air - vec3(0.0, tick.gravity * tick.tick_s, 0.0)) / (1.0 + drag);
    const vec3 extra_velocity = after - class_velocity;

    const float side = tick.side_m * exp2(float(level + 1u) - float(tick.levels));
    const ivec3 displacement =
        ivec3(clamp(extra_velocity * tick.tick_s / side, vec3(-0.49), vec3(0.49)) * 4294967296.0);
    for (int axis = 0; axis < 3; axis++) {
        uint carry;
        sway.offset_low[axis] = uaddCarry(sway.offset_low[axis], uint(displacement[axis]), carry);
        sway.offset_high[axis] += carry + uint(displacement[axis] >> 31);
        sway.velocity[axis] = extra_velocity[axis];
    }
    sways[slot_index] = sway;
}
