// balls.comp - each drop and particle becomes one to four metaballs (Goto et al. 2009, section 4.7), which
// count themselves in the tiles that they reach.
//
// One loop emits all of a drop's balls, whatever becomes of it: software Vulkan runs every place in a shader that
// writes for every lane, taken or not.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "density.glsl"
#include "tiles.glsl"
#define NODES_BINDING 5
#include "glass/nodes.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;
layout(scalar, set = 0, binding = 1) readonly buffer Drops { virga_glass_drop_gpu drops[]; };
layout(scalar, set = 0, binding = 10) readonly buffer List { virga_list_gpu list; uint listed[]; };
layout(scalar, set = 0, binding = 22) readonly buffer State { virga_glass_state_gpu state; };

#define SUB_WATER 0.27              // share of a drop's water in its three sub-balls as it lands
#define TEAR_SPEED 0.03             // m/s at which half of a tear has formed

shared uint widest, shaped, entered; // of the workgroup

// A drop's balls: the first is its own. Radius 0: there is none.
vec2 middles[VIRGA_GLASS_DROP_BALLS];
float radii[VIRGA_GLASS_DROP_BALLS];
float sub_peak; // of all but the first

// Gravity along the pane's surface, by the nearest node.
vec2 gravity_at(vec2 middle)
{
    const vec2 grid = middle / vec2(look.pane.width_m, look.pane.height_m) * float(VIRGA_GLASS_NODES - 1);
    const uvec2 node = uvec2(clamp(grid + 0.5, vec2(0.0), vec2(VIRGA_GLASS_NODES - 1)));
    const Frame at = node_frame(node);
    return vec2(dot(to_vec(look.gravity), at.along_u), dot(to_vec(look.gravity), at.along_v));
}

// A cap on an inclined surface, where it is flat enough: surface tension x laplacian of the height + density x
// gravity x way down is the same everywhere, and 0 the height at the rim. Its solution is the level cap times 1 + s x,
// with the way down x over the radius and s = Bond number / (8 height over radius).
vec2 sag_of(vec2 middle, float radius)
{
    const vec2 s = gravity_at(middle) * (998.2 / 0.0728 / 8.0) * radius * radius / look.cap_height;
    return s * min(1.0, 0.6 / max(length(s), 1e-6));
}

// Three sub-balls around one that has just landed, which flow in (section 4.7). All have the shape of caps, so that
// radii are cube roots of the shares of water. No splat is like another: shares, distances and the angles between them
// are left to chance, so that two may look like one; were they even, each splat would be a clover leaf.
void shape_landing(float t, uint random)
{
    const float left = (1.0 - t) * (1.0 - t), radius = radii[0], turn = 6.2831853 * virga_unit(random);
    vec3 shares;
    for (uint i = 0u; i < 3u; i++) {
        const vec4 chance = unpackUnorm4x8(virga_hash2(random, i));
        const float angle = turn + 2.0943951 * float(i) + 1.6 * (chance.x - 0.5);
        middles[i + 1u] = middles[0] + vec2(cos(angle), sin(angle)) * (radius * left * (0.85 + 0.6 * chance.y));
        shares[i] = 0.3 + chance.z;
    }
    shares *= SUB_WATER * left / dot(shares, vec3(1.0));
    for (uint i = 0u; i < 3u; i++)
        radii[i + 1u] = radius * pow(shares[i], 1.0 / 3.0);
    radii[0] = radius * pow(1.0 - SUB_WATER * left, 1.0 / 3.0);
    sub_peak = min(4.0 * (1.0 - t), 1.0);
}

// A tear: smaller balls behind, the farther the faster it runs. All together hold its water.
void shape_tear(vec2 velocity)
{
    const float speed = length(velocity), run = speed / (speed + TEAR_SPEED);
    const vec3 sizes = run * vec3(0.80, 0.60, 0.42);
    const vec3 ways = (0.35 + 0.65 * run) * vec3(0.75, 1.45, 2.05);
    const float head = radii[0] / pow(1.0 + dot(sizes, sizes * sizes), 1.0 / 3.0);
    radii[0] = head;
    for (int i = 0; i < 3; i++) {
        middles[i + 1] = middles[0] - velocity / speed * (head * ways[i]);
        radii[i + 1] = head * sizes[i];
    }
}

void count_tiles(uvec2 reached)
{
    const uvec2 first = reached & 0xffffu, number = reached >> 16;
    for (uint y = 0u; y < number.y; y++)
        for (uint x = 0u; x < number.x; x++)
            atomicAdd(tiles[tile_number(first + uvec2(x, y))].count, 1u);
    atomicAdd(entered, number.x * number.y);
}

// Texels that a ball covers besides its shape. A sub-ball that is fading has none.
float mist_of(uint i)
{
    const float radius = radii[i], texel_m2 = look.texel_m[0] * look.texel_m[1];
    const bool misty = i == 0u || sub_peak == 1.0;
    return misty ? (1.0 - shape_share(radius)) * min(3.14159265 * radius * radius / texel_m2, 4.0) : 0.0;
}

void emit_balls(vec2 sag, float whole)
{
    // Of a drop that has no shape at all one ball has all mist, which is spread over a texel anyway.
    const bool as_one = shape_share(whole) == 0.0;
    const float all = mist_of(0u) + mist_of(1u) + mist_of(2u) + mist_of(3u);
    for (uint i = 0u; i < VIRGA_GLASS_DROP_BALLS; i++) {
        const float radius = radii[i], shape = shape_share(radius), peak = (i == 0u ? 1.0 : sub_peak) * shape;
        const float mist = as_one ? (i == 0u ? all : 0.0) : mist_of(i);
        if (radius > 0.0 && peak + mist > 0.0) {
            const uvec2 reached =
                tiles_reached(middles[i], ball_reach(peak > 0.0 ? radius : 0.0, density_reach()));
            balls[atomicAdd(work.balls, 1u)] =
                virga_glass_ball_gpu(float[2](middles[i].x, middles[i].y), radius, mist, float[2](sag.x, sag.y), peak,
                                     uint[2](reached.x, reached.y));
            atomicAdd(shaped, peak > 0.0 ? 1u : 0u);
            count_tiles(reached);
            atomicMax(widest, floatBitsToUint(radius));
        }
    }
}

void make(uint place)
{
    const virga_glass_drop_gpu at = drops[place];
    const bool particle = (at.kind & VIRGA_GLASS_KIND) == VIRGA_GLASS_PARTICLE;
    const float radius = particle ? look.particle_m : cap_radius(float(at.water_nl));
    for (int i = 0; i < VIRGA_GLASS_DROP_BALLS; i++)
        radii[i] = 0.0;
    middles[0] = mix(vec2(at.before[0], at.before[1]), vec2(at.position[0], at.position[1]), look.share);
    radii[0] = radius;
    sub_peak = 1.0;
    const vec2 sag = particle ? vec2(0.0) : sag_of(middles[0], radius);
    const vec2 velocity = vec2(at.velocity[0], at.velocity[1]);
    const float age = max(at.age_s + look.late_s, 0.0);
    const bool lands = !particle && age < look.impact_s && (at.kind & VIRGA_GLASS_TAIL) == 0u;
    const bool runs = !particle && !lands && (at.kind & VIRGA_GLASS_RUNNING) != 0u && dot(velocity, velocity) > 1e-8;
    if (lands)
        shape_landing(age / look.impact_s, at.random);
    if (runs)
        shape_tear(velocity);
    emit_balls(sag, radius);
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        widest = shaped = entered = 0u;
    barrier();
    const uint i = gl_GlobalInvocationID.x, place = listed[min(i, look.pane.max_drops - 1u)];
    if (i < state.shown && (drops[place].kind & VIRGA_GLASS_KIND) != VIRGA_GLASS_FREE)
        make(place);
    barrier();
    if (gl_LocalInvocationIndex != 0u || widest == 0u)
        return;
    atomicMax(work.highest, widest);
    atomicAdd(work.shaped, shaped);
    atomicAdd(work.entries, entered);
}
