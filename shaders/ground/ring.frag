// ring.frag - the slope of a ring's waves at a place, added to that of the others.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared/ground_limits.h"

layout(set = 0, binding = 16) uniform sampler2DArray waves;
layout(location = 0) noperspective in vec2 offset_m;
layout(location = 1) flat in vec3 moment;
layout(location = 0) out vec2 slope;

void main()
{
    const float r = length(offset_m);
    const float reach = r / (VIRGA_RING_START_M + VIRGA_RING_FRONT_M_S * moment.x); // 1: the wave's front
    const vec2 at = vec2(reach * float(VIRGA_RING_RADII - 1),
                         moment.x / VIRGA_RING_TIME_S * float(VIRGA_RING_TIMES - 1));
    const vec2 size = vec2(VIRGA_RING_RADII, VIRGA_RING_TIMES);
    const float wave = texture(waves, vec3((at + 0.5) / size, moment.y)).r;
    // Waves end softly where the table does.
    const float ends = (1.0 - smoothstep(0.9, 1.0, reach)) * (1.0 - smoothstep(0.7, 1.0, moment.x / VIRGA_RING_TIME_S));
    slope = r > 1e-5 ? offset_m / r * (wave * moment.z * ends) : vec2(0.0);
}
