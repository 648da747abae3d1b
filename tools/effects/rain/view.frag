// view.frag - occlusion maps of the rain, flat.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "view_gpu.h"
#define VIEW_OWN rain_view_gpu
#include "../views/view_common.glsl"

layout(set = 0, binding = VIEW_AT_ARRAY) uniform sampler2DArray occlusion_map;
layout(location = 0) out vec4 out_color;

vec3 occlusion_color(vec2 pixel)
{
    const vec4 flat_map = flat_area(1.0);
    const vec2 at = (pixel - flat_map.xy) / flat_map.zw;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0))) || own.heights.w == 0.0)
        return OUTSIDE;
    const float depth = textureLod(occlusion_map, vec3(at, float(view.mode.y)), 0.0).r;
    const float height = own.heights.x - depth * own.heights.y; // in the world
    return depth >= 1.0 ? vec3(0.03, 0.03, 0.08) : heat(0.08 + (height - own.heights.z) / 16.0) * 0.9;
}

void main()
{
    vec2 at;
    ivec2 texel;
    out_color = vec4(in_picture(gl_FragCoord.xy, at, texel) ? occlusion_color(gl_FragCoord.xy) : OUTSIDE, 1.0);
}
