// view_drops.vert - a quad for each slot of a drop, on the flat map of a pane.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "view_gpu.h"
#define VIEW_OWN glass_view_gpu
#include "../views/view_common.glsl"
#include "shared/glass_drop.h"

layout(scalar, set = 0, binding = VIEW_AT_BUFFERS + 1) readonly buffer Drops { virga_glass_drop_gpu drops[]; };
layout(location = 0) out vec2 out_at;
layout(location = 1) flat out vec3 out_color;
layout(push_constant) uniform Window { vec2 window; };

void main()
{
    const virga_glass_drop_gpu drop = drops[gl_VertexIndex / 6];
    const uint kind = drop.kind & VIRGA_GLASS_KIND;
    const uint corner = uint[](0u, 1u, 2u, 2u, 1u, 3u)[gl_VertexIndex % 6];
    out_at = vec2(corner & 1u, corner >> 1) * 2.0 - 1.0;
    out_color = kind == VIRGA_GLASS_PARTICLE
                    ? ((drop.kind & VIRGA_GLASS_WAITING) != 0u ? vec3(1.0, 0.85, 0.2) : vec3(1.0, 0.5, 0.1))
                : (drop.kind & VIRGA_GLASS_RUNNING) != 0u ? vec3(0.35, 1.0, 0.55)
                                                          : vec3(0.3, 0.6, 1.0);
    const float radius =
        kind == VIRGA_GLASS_PARTICLE ? own.drop.y : pow(float(drop.water_nl) / own.drop.x, 1.0 / 3.0);
    const vec4 flat_map = flat_area(own.pane.x / own.pane.y);
    const vec2 uv = vec2(drop.position[0], drop.position[1]) / own.pane.xy;
    const float px = max(radius / own.pane.x * flat_map.z, 1.0);
    const vec2 pixel = flat_map.xy + vec2(uv.x, 1.0 - uv.y) * flat_map.zw + out_at * px;
    gl_Position = kind == VIRGA_GLASS_FREE ? vec4(2.0, 2.0, 0.0, 1.0) : vec4(pixel / window * 2.0 - 1.0, 0.0, 1.0);
}
