#version 450
// street.frag - light from above, a soft pattern, and Virga's ground: wet is darker, and water mirrors a grey sky.
#extension GL_GOOGLE_include_directive : require
#include "street_block.glsl"
#include "shared/ground_map.glsl"

layout(set = 0, binding = 1) uniform sampler2D wet_map;
layout(set = 0, binding = 2) uniform usampler2D spot_map;
layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec3 in_color;
layout(location = 3) in vec4 in_before;
layout(location = 4) in vec4 in_now;
layout(location = 0) out vec4 out_color;
#ifdef MOTION
layout(location = 1) out vec2 out_motion; // to where it was, in pixels
#endif

void main()
{
    const vec3 wave = sin(in_position * 2.5);
    const float light = 0.45 + 0.35 * in_normal.y + 0.15 * in_normal.z + 0.1 * in_normal.x;
    vec3 color = in_color * light * (1.0 + 0.25 * wave.x * wave.z + 0.15 * wave.y);
    if (street.wetted > 0.0 && in_normal.y > 0.5) {
        const vec2 at = (in_position.xz - street.low_m) / street.cell_m;
        const virga_ground_wetness ground = virga_ground_at(wet_map, spot_map, street.low_cell, street.cells, at,
                                                            in_position.y - street.base_m, 1.0,
                                                            street.cell_m);
        const float wet = max(ground.wet, ground.spot);
        color *= mix(1.0, 0.5, wet);
        color = mix(color, vec3(0.3, 0.32, 0.35), 0.3 * smoothstep(0.05, 1.5, ground.depth_mm));
    }
    out_color = vec4(color, 1.0);
#ifdef MOTION
    out_motion = (in_before.xy / in_before.w - in_now.xy / in_now.w) * 0.5 * street.size_px;
#endif
}
