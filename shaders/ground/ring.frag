// ring.frag - the slope of a ring's waves, added to that of other rings.
// One invocation per texel of the ripple map around a ring. Reads: the ring table. Writes: slope (additive).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared/ground_limits.h"

// Slope over radius (cm). A texel holds this radius and the next, then both at the next time. Filtering instead was a
// third slower on software Vulkan.
layout(set = 0, binding = 16) uniform sampler2DArray waves;
layout(location = 0) noperspective in vec2 offset_m;
layout(location = 1) flat in vec3 moment; // see ring.vert
layout(location = 2) flat in vec2 row;
layout(location = 0) out vec2 slope;

void main()
{
    const float radius = min(length(offset_m) * moment.x, float(VIRGA_RING_RADII) - 1.0);
    const vec4 around = texture(waves, vec3((floor(radius) + 0.5) / float(VIRGA_RING_RADII), row));
    const vec2 by_time = mix(around.xz, around.yw, fract(radius));
    slope = offset_m * (moment.z * mix(by_time.x, by_time.y, moment.y));
}
