// picture_balls.comp - each drop and particle becomes one to four metaballs (Goto et al. 2009, section 4.7), which
// count themselves
// in the tiles that they reach.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "picture_density.glsl"
#include "picture_tiles.glsl"
#include "picture_mist.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;
layout(scalar, set = 0, binding = 1) readonly buffer Drops { virga_glass_drop_gpu drops[]; };
layout(scalar, set = 0, binding = 5) readonly buffer Nodes { virga_glass_node_gpu nodes[]; };
layout(scalar, set = 0, binding = 10) buffer Counts { uint ball_count, cut_count; };

#define SUB_WATER 0.09              // share of a drop's water in each of its three sub-balls as it lands
#define TEAR_SPEED 0.03             // m/s at which half of a tear has formed

struct Drop {
    uint id;
    float radius; // of the base, all water in one cap
    vec2 middle, sag;
};

// Gravity along the pane's surface, by the nearest node.
vec2 gravity_at(vec2 middle)
{
    const vec2 grid = middle / vec2(look.pane.width_m, look.pane.height_m) * float(VIRGA_GLASS_NODES - 1);
    const uvec2 node = uvec2(clamp(grid + 0.5, vec2(0.0), vec2(VIRGA_GLASS_NODES - 1)));
    const virga_glass_node_gpu at = nodes[node.x + node.y * VIRGA_GLASS_NODES];
    return vec2(dot(to_vec(look.gravity), to_vec(at.along_u)), dot(to_vec(look.gravity), to_vec(at.along_v)));
}

// A cap on an inclined surface, where it is flat enough: surface tension x laplacian of the height + density x
// gravity x way down
// is the same everywhere, and 0 the height at the rim. Its solution is the level cap times 1 + s x, with the way
// down x over the
// radius and s = Bond number / (8 height over radius).
vec2 sag_of(vec2 middle, float radius)
{
    const vec2 s = gravity_at(middle) * (998.2 / 0.0728 / 8.0) * radius * radius / look.cap_height;
    return s * min(1.0, 0.6 / max(length(s), 1e-6));
}

void count_tiles(vec2 middle, float reach_m)
{
    ivec2 first, last;
    tiles_around(middle, reach_m, first, last);
    for (int y = first.y; y <= last.y; y++)
        for (int x = first.x; x <= last.x; x++)
            atomicAdd(tiles[tile_number(ivec2(x, y))].count, 1u);
}

void emit_ball(Drop drop, vec2 middle, float radius, float peak)
{
    const float shape = peak * shape_share(radius);
    if (shape < 1.0 && peak == 1.0) {
        add_mist(middle, radius, 1.0 - shape);
        mark_tiles(middle, max(look.texel_m[0], look.texel_m[1]), VIRGA_GLASS_HAS_MIST);
    }
    if (shape > 0.0 && radius > 0.0) {
        balls[atomicAdd(ball_count, 1u)] =
            virga_glass_ball_gpu(float[2](middle.x, middle.y), radius, radius * look.cap_height,
                                 float[2](drop.sag.x, drop.sag.y), drop.id, shape);
        count_tiles(middle, radius * density_reach());
    }
}

// Three sub-balls around one that has just landed, which flow in (section 4.7). All have the shape of caps, so that
// radii are
// cube roots of the shares of water.
void emit_landing(Drop drop, float t, uint random)
{
    const float left = (1.0 - t) * (1.0 - t), water = SUB_WATER * left;
    emit_ball(drop, drop.middle, drop.radius * pow(1.0 - 3.0 * water, 1.0 / 3.0), 1.0);
    const float turn = 6.2831853 * virga_unit(random);
    for (uint i = 0u; i < 3u; i++) {
        const float angle = turn + 2.0943951 * float(i) + 0.9 * (virga_unit(virga_hash2(random, i)) - 0.5);
        emit_ball(drop, drop.middle + vec2(cos(angle), sin(angle)) * (drop.radius * 1.15 * left),
                  drop.radius * pow(water, 1.0 / 3.0), min(4.0 * (1.0 - t), 1.0));
    }
}

// A tear: smaller balls behind, the farther the faster it runs. All together hold its water.
void emit_tear(Drop drop, vec2 velocity)
{
    const float speed = length(velocity), run = speed / (speed + TEAR_SPEED);
    const vec3 sizes = run * vec3(0.80, 0.60, 0.42);
    const vec3 ways = (0.35 + 0.65 * run) * vec3(0.75, 1.45, 2.05);
    const float head = drop.radius / pow(1.0 + dot(sizes, sizes * sizes), 1.0 / 3.0);
    const vec2 back = -velocity / speed;
    emit_ball(drop, drop.middle, head, 1.0);
    for (int i = 0; i < 3; i++)
        emit_ball(drop, drop.middle + back * (head * ways[i]), head * sizes[i], 1.0);
}

void make(uint place)
{
    const virga_glass_drop_gpu at = drops[place];
    Drop drop = Drop(at.id, 0.0, vec2(0.0), vec2(0.0));
    drop.middle = mix(vec2(at.before[0], at.before[1]), vec2(at.position[0], at.position[1]), look.share);
    const bool particle = (at.kind & VIRGA_GLASS_KIND) == VIRGA_GLASS_PARTICLE;
    drop.radius = particle ? look.particle_m : cap_radius(float(at.water_nl));
    drop.sag = particle ? vec2(0.0) : sag_of(drop.middle, drop.radius);
    const vec2 velocity = vec2(at.velocity[0], at.velocity[1]);
    const float age = max(at.age_s + look.late_s, 0.0);
    const bool lands = !particle && age < look.impact_s && (at.kind & VIRGA_GLASS_TAIL) == 0u;
    const bool runs = !particle && !lands && (at.kind & VIRGA_GLASS_RUNNING) != 0u && dot(velocity, velocity) > 1e-8;
    if (lands)
        emit_landing(drop, age / look.impact_s, at.random);
    if (runs)
        emit_tear(drop, velocity);
    if (!lands && !runs)
        emit_ball(drop, drop.middle, drop.radius, 1.0);
}

void main()
{
    const uint place = gl_GlobalInvocationID.x;
    if ((drops[place].kind & VIRGA_GLASS_KIND) != VIRGA_GLASS_FREE)
        make(place);
}
