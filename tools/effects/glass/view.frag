// view.frag - a pane, flat: its affinity or the height of water on it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "view_gpu.h"
#define VIEW_OWN glass_view_gpu
#include "../views/view_common.glsl"

layout(set = 0, binding = VIEW_AT_IMAGE) uniform sampler2D height_map;
layout(scalar, set = 0, binding = VIEW_AT_BUFFERS) readonly buffer Surface { uint surface[]; };
layout(location = 0) out vec4 out_color;

// The pane as seen from outside: u to the right, v up.
bool on_pane(vec2 pixel, out vec2 uv)
{
    const vec4 flat_map = flat_area(own.pane.x / own.pane.y);
    const vec2 at = (pixel - flat_map.xy) / flat_map.zw;
    uv = vec2(at.x, 1.0 - at.y) * own.pane.xy;
    return all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)));
}

float distance_to_blade(vec2 uv, vec4 blade)
{
    const vec2 way = blade.zw - blade.xy, from = uv - blade.xy;
    return length(from - way * clamp(dot(from, way) / max(dot(way, way), 1e-9), 0.0, 1.0));
}

// Affinity, with the particles' regions beside the blades; the drops are drawn over it.
vec3 affinity_color(vec2 uv)
{
    const uvec2 cell = min(uvec2(uv / own.pane.z), own.cells.xy - 1u);
    const uint word = surface[cell.x + cell.y * own.cells.x];
    if ((word & 0x1000000u) == 0u)
        return OUTSIDE;
    const float affinity = (float(word & 0xffu) - 128.0) / 32.0;
    vec3 color = vec3(0.25 + 0.09 * affinity);
    for (uint i = 0u; i < own.cells.z; i++) {
        const float way = distance_to_blade(uv, own.blades[i]);
        color = way < own.pane.w ? mix(color, vec3(0.55, 0.32, 0.1), 0.6) : color;
        color = way < 0.004 ? vec3(0.02) : color;
    }
    return color;
}

vec3 height_color(vec2 uv)
{
    if (own.cells.w == 0u)
        return OUTSIDE;
    const vec4 texel = texelFetch(height_map, ivec2(uv / own.pane.xy * own.height_map.xy), 0);
    const float water = texel.r >= own.height_map.z ? texel.g : 0.0;
    return water > 0.0 ? heat(0.15 + 0.85 * water / 0.0015) : vec3(0.05, 0.06, 0.09) + 0.5 * vec3(texel.b);
}

void main()
{
    vec2 at, uv;
    ivec2 texel;
    vec3 color = OUTSIDE;
    if (in_picture(gl_FragCoord.xy, at, texel) && on_pane(gl_FragCoord.xy, uv))
        color = view.mode.x == GLASS_VIEW_HEIGHT ? height_color(uv) : affinity_color(uv);
    out_color = vec4(color, 1.0);
}
