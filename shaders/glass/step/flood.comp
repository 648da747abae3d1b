// flood.comp - simulated water reaches cells of the pane: those under a particle that is on the outside of the pane,
// less than the distance of particles from it. A particle covers a disc. That is wider than the particle, so that there
// are no gaps between those of a layer.
// One invocation per particle of water, once a step. Reads: particles, nodes. Writes: what water does on cells.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "flood.glsl"
#include "shared/particle.h"

layout(local_size_x = VIRGA_GLASS_GROUP) in;
layout(scalar, set = 0, binding = 14) readonly buffer Water { virga_particle_gpu particles[]; };

#define COVERS 0.75 // radius of the disc, in distances of particles
#define BEHIND 0.25 // how far behind the surface a particle still counts, in distances of particles: it is not exact
#define MOST_CELLS 64 // under a particle, along each axis
#define COARSE 8      // nodes from one to the next among which the search begins

// From the world's axes to the pane's.
vec3 to_axes(vec3 world)
{
    const float m[9] = tick.world_from_pane;
    return vec3(dot(vec3(m[0], m[1], m[2]), world), dot(vec3(m[3], m[4], m[5]), world),
                dot(vec3(m[6], m[7], m[8]), world));
}

vec3 node_position(ivec2 node)
{
    return uintBitsToFloat(texelFetch(nodes, 3 * (node.x + node.y * VIRGA_GLASS_NODES)).xyz);
}

// The surface at a point, and its derivatives; it goes on straight beyond the edges.
vec3 surface_at(vec2 at, out vec3 by_u, out vec3 by_v)
{
    const vec2 per_m = float(VIRGA_GLASS_NODES - 1) / vec2(tick.pane.width_m, tick.pane.height_m);
    const ivec2 low = clamp(ivec2(floor(at * per_m)), ivec2(0), ivec2(VIRGA_GLASS_NODES - 2));
    const vec2 t = at * per_m - vec2(low);
    const vec3 a = node_position(low), b = node_position(low + ivec2(1, 0)), c = node_position(low + ivec2(0, 1)),
               d = node_position(low + ivec2(1, 1));
    by_u = mix(b - a, d - c, t.y) * per_m.x;
    by_v = mix(c - a, d - b, t.x) * per_m.y;
    return mix(mix(a, b, t.x), mix(c, d, t.x), t.y);
}

// The nearest of some nodes.
vec2 search_from(vec3 point)
{
    vec2 best = vec2(0.0);
    float least = 1e30;
    for (int y = 0; y < VIRGA_GLASS_NODES; y += COARSE)
        for (int x = 0; x < VIRGA_GLASS_NODES; x += COARSE) {
            const vec3 away = point - node_position(ivec2(x, y));
            if (dot(away, away) < least) {
                least = dot(away, away);
                best = vec2(x, y);
            }
        }
    return best * vec2(tick.pane.width_m, tick.pane.height_m) / float(VIRGA_GLASS_NODES - 1);
}

// The point (u, v) of the surface below a point, by Gauss and Newton. `outward`: how far the point is from it.
vec2 point_below(vec3 point, out float outward, out vec3 normal)
{
    const vec2 size = vec2(tick.pane.width_m, tick.pane.height_m), beyond = vec2(2.0 * tick.water_spacing_m);
    vec2 at = tick.water_rounds > 1u ? search_from(point) : 0.5 * size;
    vec3 by_u, by_v;
    for (uint i = 0u; i < tick.water_rounds; i++) {
        const vec3 away = point - surface_at(at, by_u, by_v);
        const float uu = dot(by_u, by_u), uv = dot(by_u, by_v), vv = dot(by_v, by_v);
        const vec2 right = vec2(dot(by_u, away), dot(by_v, away));
        at += vec2(vv * right.x - uv * right.y, uu * right.y - uv * right.x) / max(uu * vv - uv * uv, 1e-12);
        at = clamp(at, -beyond, size + beyond);
    }
    const vec3 below = surface_at(at, by_u, by_v);
    normal = normalize(cross(by_u, by_v));
    outward = dot(point - below, normal);
    return at;
}

void reach(vec2 at, float speed_m_s)
{
    const uint most = (1u << VIRGA_GLASS_SPEED) - 1u;
    const uint word =
        VIRGA_GLASS_REACHED << VIRGA_GLASS_PHASE | uint(clamp(speed_m_s * 1000.0 + 0.5, 0.0, float(most)));
    const float radius = min(COVERS * tick.water_spacing_m, 0.5 * float(MOST_CELLS) * tick.pane.cell_m);
    const ivec2 own = cell_at(at), last = ivec2(tick.pane.columns, tick.pane.rows) - 1;
    const ivec2 from = max(cell_at(at - radius), ivec2(0)), to = min(cell_at(at + radius), last);
    for (int y = from.y; y <= to.y; y++)
        for (int x = from.x; x <= to.x; x++) {
            const ivec2 cell = ivec2(x, y);
            const vec2 offset = (vec2(cell) + 0.5) * tick.pane.cell_m - at;
            if (!(dot(offset, offset) <= radius * radius || cell == own) || !on_pane(cell))
                continue;
            const uint at_word = flood_word(cell_number(cell));
            if (occupants[at_word] >= word)
                continue;
            atomicMax(occupants[at_word], word);
            const uvec2 block = uvec2(cell) / VIRGA_GLASS_FILM_BLOCK;
            occupants[flood_flag(block.x + block.y * film_block_counts().x)] = 1u;
        }
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= tick.water_count || !(particles[i].share > 0.0))
        return;
    const float position[3] = particles[i].position, velocity[3] = particles[i].velocity;
    const vec3 point = to_axes(to_vec(position) + to_vec(tick.water_offset));
    const vec3 low = to_vec(tick.low) - tick.water_spacing_m, high = to_vec(tick.high) + tick.water_spacing_m;
    if (!(all(greaterThanEqual(point, low)) && all(lessThanEqual(point, high)))) // also for NaN
        return;
    float outward;
    vec3 normal;
    const vec2 at = point_below(point, outward, normal);
    if (!(outward < tick.water_spacing_m && outward > -BEHIND * tick.water_spacing_m))
        return;
    const vec3 moves = to_axes(to_vec(velocity)) - to_vec(tick.pane_velocity) - cross(to_vec(tick.spin), point);
    const float speed = length(moves - dot(moves, normal) * normal);
    reach(at, speed >= 0.0 ? speed : 0.0);
}
