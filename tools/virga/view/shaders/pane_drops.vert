// pane_drops.vert - a square for each place on the flat map of a pane.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "view_common.glsl"

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
                    ? ((drop.kind & VIRGA_GLASS_HELD) != 0u ? vec3(1.0, 0.85, 0.2) : vec3(1.0, 0.5, 0.1))
                : (drop.kind & VIRGA_GLASS_RUNNING) != 0u ? vec3(0.35, 1.0, 0.55)
                                                          : vec3(0.3, 0.6, 1.0);
    const float radius = kind == VIRGA_GLASS_PARTICLE ? view.pane_drop.y
                                                      : pow(float(drop.water_nl) / view.pane_drop.x, 1.0 / 3.0);
    const vec4 flat_map = flat_area(view.pane.x / view.pane.y);
    const vec2 place = vec2(drop.position[0], drop.position[1]) / view.pane.xy;
    const float px = max(radius / view.pane.x * flat_map.z, 1.0);
    const vec2 pixel = flat_map.xy + vec2(place.x, 1.0 - place.y) * flat_map.zw + out_at * px;
    gl_Position = kind == VIRGA_GLASS_FREE ? vec4(2.0, 2.0, 0.0, 1.0) : vec4(pixel / window * 2.0 - 1.0, 0.0, 1.0);
}
