// ring.vert - a hexagon around each living ring in the ripple map, as wide as its fastest waves have travelled: it has
// 0.87 of a square's area. Software Vulkan draws squares: twice as many vertices, also of slots without a ring, would
// take it as long. Rings of drops and wakes are two draws.
// One invocation per vertex, VIRGA_RING_VERTICES per ring. Reads: rings. Writes: offset, constants of the ring.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RINGS_ACCESS readonly
#include "tick.glsl"
#include "rings.glsl"
#include "gpu/variants.glsl"
#include "gpu/vectors.glsl"

layout(location = 0) noperspective out vec2 offset_m; // from where the drop fell
// x: table radii per metre; y: position between two times of the table; z: crater (cm), reduced while it opens and
// where the waves end.
layout(location = 1) flat out vec3 moment;
layout(location = 2) flat out vec2 row; // x: time in the table, as a fraction; y: its layer

const float DEPTHS_M[VIRGA_RING_DEPTHS] = float[VIRGA_RING_DEPTHS](VIRGA_RING_DEPTH_LIST);

int layer_of(float depth_m)
{
    int layer = 0;
    for (int i = 1; i < VIRGA_RING_DEPTHS; i++)
        layer = depth_m * depth_m > DEPTHS_M[i - 1] * DEPTHS_M[i] ? i : layer; // the nearest by ratio
    return layer;
}

const float LIVES_S[VIRGA_RING_WIDTHS] = float[VIRGA_RING_WIDTHS](VIRGA_RING_LIFE_LIST);
const float STARTS_M[VIRGA_RING_WIDTHS] = float[VIRGA_RING_WIDTHS](VIRGA_RING_START_LIST);
const float FRONTS_M_S[VIRGA_RING_WIDTHS] = float[VIRGA_RING_WIDTHS](VIRGA_RING_FRONT_LIST);

// A corner of the hexagon around a circle of radius 1, by a vertex of its four triangles.
vec2 hexagon_corner(uint vertex)
{
    const uint corner = vertex % 3u == 0u ? 0u : vertex / 3u + vertex % 3u;
    const float right = corner == 0u || corner == 3u ? 0.0 : corner < 3u ? 1.0 : -1.0;
    return vec2(right, (corner + 1u) % 6u < 3u ? 1.0 : -1.0) * vec2(1.0, right == 0.0 ? 1.1547006 : 0.5773503);
}

vec2 square_corner(uint vertex)
{
    return vec2((vertex & 1u) != 0u ? 1.0 : -1.0, vertex == 0u || vertex == 1u || vertex == 5u ? -1.0 : 1.0);
}

void main()
{
    const uint vertices = VIRGA_RING_VERTICES(FOR_GPU), ring_index = uint(gl_VertexIndex) / vertices;
    const uint vertex = uint(gl_VertexIndex) - ring_index * vertices;
    const virga_ring_gpu ring = rings[ring_index];
    const float age = (float(tick.last_tick - ring.tick) + 1.0 - ring.share) * tick.tick_s;
    const uint width = min(ring.width, VIRGA_RING_WIDTHS - 1u);
    const bool wake = width >= VIRGA_RING_DROP_WIDTHS;
    const int layer = layer_of(ring.depth_m);
    const float front_m_s = wake && layer < VIRGA_WAKE_SHALLOW ? VIRGA_WAKE_SHALLOW_FRONT : FRONTS_M_S[width];
    const float life_s = LIVES_S[width], radius = STARTS_M[width] + front_m_s * age;
    const vec2 cell =
        vec2(ivec2(ring.cell[0], ring.cell[1]) - ivec2(tick.low_tile[0], tick.low_tile[1]) * VIRGA_GROUND_TILE) +
        vec2(ring.in_cell[0], ring.in_cell[1]);
    offset_m = (FOR_GPU ? hexagon_corner(vertex) : square_corner(vertex)) * radius;
    const vec2 drifted_m = cell * tick.cell_m + vec2(ring.drift[0], ring.drift[1]) * max(age, 0.0);
    const vec2 at = (drifted_m - vec2(tick.ripple_low_m[0], tick.ripple_low_m[1]) + offset_m) / tick.ripple_side_m;
    const float time = clamp(age / life_s, 0.0, 1.0) * float(VIRGA_RING_TIMES - 1);
    // The table begins with the crater, which opens while the crown around it rises. A crater that is there at once
    // would pop up in pictures that are a few milliseconds apart.
    const float ends = 1.0 - smoothstep(VIRGA_RING_FADES, 1.0, age / life_s);
    const float there = smoothstep(0.0, wake ? VIRGA_WAKE_OPENS_S : VIRGA_RING_OPENS_S, age) * ends *
                        (wake ? tick.wake_waves : 1.0);
    moment = vec3(float(VIRGA_RING_RADII - 1) / radius, fract(time), 100.0 * ring.crater_m * there);
    row = vec2((floor(time) + 0.5) / float(VIRGA_RING_TIMES),
               float(int(width) * VIRGA_RING_DEPTHS + layer));
    const bool lives = ring.crater_m > 0.0 && age > 0.0 && age < life_s;
    gl_Position = lives ? vec4(at * 2.0 - 1.0, 0.0, 1.0) : DRAWN_NOWHERE;
}
