// foam.frag - a particle of foam.
// One invocation per pixel of its disc, or of the streak that it leaves while the shutter is open. Writes: radiance,
// premultiplied, and for temporal anti-aliasing motion and reactivity.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
layout(constant_id = 0) const uint LOOK = 0u; // VIRGA_WATER_LOOK_DEPTH or 0
#define SCENE_DEPTH_BINDING 17
#include "gpu/scene_depth.glsl"
#include "gpu/temporal.glsl"
#include "gpu/encode.glsl"

layout(location = 0) in vec2 position;
layout(location = 1) flat in vec4 color_coverage;
layout(location = 2) flat in vec3 motion_distance;
layout(location = 3) flat in vec4 depth_terms;
layout(location = 4) flat in float half_streak;

layout(location = 0) out vec4 radiance;

void main()
{
    const vec2 apart = vec2(max(abs(position.x) - half_streak, 0.0), position.y);
    const float inside = 1.0 - dot(apart, apart);
    if (inside <= 0.0)
        discard;
    float covered = color_coverage.w * inside * (2.0 - inside);
    if (LOOK != 0u)
        covered *= soft_edge(motion_distance.z, depth_terms);
    radiance = for_target(vec4(color_coverage.rgb * covered, covered));
    WRITE_REACTIVE(covered, view.reactive_gain);
    WRITE_MOTION(motion_distance.xy, covered);
}
