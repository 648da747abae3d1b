// view_points.vert - a quad for each particle or surfel of water, as the camera sees it.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "view_gpu.h"
#define VIEW_OWN water_view_gpu
#include "../views/view_common.glsl"
#include "shared/particle.h"
#include "shared/surfel.h"

layout(scalar, set = 0, binding = VIEW_AT_BUFFERS) readonly buffer Particles { virga_particle_gpu particles[]; };
layout(scalar, set = 0, binding = VIEW_AT_BUFFERS) readonly buffer Surfels { virga_surfel_gpu surfels[]; };
layout(scalar, set = 0, binding = VIEW_AT_BUFFERS + 1) readonly buffer Densities { float densities[]; };
layout(location = 0) out vec2 out_at;
layout(location = 1) flat out vec3 out_color;
layout(push_constant) uniform Window { vec2 window; };

#define NOWHERE vec4(2.0, 2.0, 0.0, 1.0)

// Of two signed 16-bit integers, see virga_surfel_gpu.
vec3 unpack_octahedron(uint packed)
{
    const vec2 e = unpackSnorm2x16(packed);
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    if (n.z < 0.0)
        n.xy = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return normalize(n);
}

struct Point {
    vec3 position;
    float radius; // m; 0: not shown
    vec3 color;
};

// In the order of the classes of water: see shaders/water/spray_part.glsl.
Point particle_point(uint index)
{
    const virga_particle_gpu particle = particles[own.first.x + index];
    const float density = densities[index];
    Point point = Point(vec3(particle.position[0], particle.position[1], particle.position[2]), 0.35 * own.origin.w,
                        heat(density / 1.2).bgr);
    if (view.mode.x == WATER_VIEW_DENSITY)
        return point;
    const bool is_spray = density < own.spray.x, is_partly = density < own.spray.y;
    point.color = is_spray ? vec3(1.0, 0.45, 0.1) : is_partly ? vec3(1.0, 0.9, 0.3) : vec3(0.2, 0.4, 0.75);
    point.radius = (is_spray ? 0.5 : is_partly ? 0.4 : 0.15) * own.origin.w;
    return point;
}

// Those that face the camera, in the color of their normal.
Point surfel_point(uint index)
{
    const virga_surfel_gpu surfel = surfels[index];
    const vec3 normal = unpack_octahedron(surfel.normal);
    const vec3 position = vec3(surfel.position[0], surfel.position[1], surfel.position[2]);
    const bool faces = dot(normal, position + own.origin.xyz) < 0.0;
    return Point(position, faces ? 0.4 * surfel.radius : 0.0, 0.5 + 0.5 * normal);
}

void main()
{
    const uint index = uint(gl_VertexIndex) / 6u;
    const uint corner = uint[](0u, 1u, 2u, 2u, 1u, 3u)[gl_VertexIndex % 6];
    const Point point = view.mode.x == WATER_VIEW_SURFELS ? surfel_point(index) : particle_point(index);
    const vec3 relative = point.position + own.origin.xyz;
    const float depth = -dot(view.back.xyz, relative);
    out_at = vec2(corner & 1u, corner >> 1) * 2.0 - 1.0;
    out_color = point.color;
    gl_Position = NOWHERE;
    if (point.radius <= 0.0 || !(depth > 0.02))
        return;
    const vec2 aside = vec2(dot(view.right.xyz, relative), dot(view.up.xyz, relative));
    const vec2 at = 0.5 + 0.5 * (aside * view.projection.xy / depth - view.jitter.xy);
    const float px = max(0.5 * view.area.w * abs(view.projection.y) * point.radius / depth, 0.75);
    const vec2 pixel = view.area.xy + at * view.area.zw + out_at * px;
    if (all(greaterThan(pixel, view.area.xy)) && all(lessThan(pixel, view.area.xy + view.area.zw)))
        gl_Position = vec4(pixel / window * 2.0 - 1.0, 0.0, 1.0);
}
