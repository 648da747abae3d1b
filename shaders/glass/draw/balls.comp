// balls.comp - each drop and particle becomes one to four metaballs, which are counted in the tiles that they reach.
// One invocation per live slot. Reads: the live list, drops, nodes. Writes: balls, the tiles' counts, work.
// Paper: Goto et al. 2009, section 4.7.
//
// One loop emits all balls of a drop, in all cases: in a shader that writes buffers, software Vulkan runs every write
// for every lane.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "density.glsl"
#include "tiles.glsl"
#include "drop_size.glsl"
#include "glass/outline.glsl"
#include "pinning.glsl"

layout(constant_id = 0) const uint MODE = 0u; // 1: small drops are drawn as textures
layout(local_size_x = VIRGA_GLASS_GROUP) in;
layout(scalar, set = 0, binding = 1) readonly buffer Drops { virga_glass_drop_gpu drops[]; };
layout(scalar, set = 0, binding = 10) readonly buffer List
{
    virga_list_gpu list;
    uint listed[];
};
layout(scalar, set = 0, binding = 22) readonly buffer State { virga_glass_state_gpu state; };

#define SUB_WATER 0.27  // part of a drop's water in its three sub-balls when it lands
#define MIN_TAIL 0.05   // a shorter tail is within the head
#define WIDER 0.25      // how much farther a ball reaches on displaced glass, at a pinning of 1

shared uint widest, shape_count, entry_count; // of the workgroup

// The balls of a drop; the first is the main one. Radius 0: no ball.
vec2 middles[VIRGA_GLASS_DROP_BALLS];
float radii[VIRGA_GLASS_DROP_BALLS];
float sub_peak; // of the sub-balls

// Gravity along the pane's surface, at the nearest node.
vec2 gravity_at(vec2 middle)
{
    const vec2 grid = middle / vec2(look.pane.width_m, look.pane.height_m) * float(VIRGA_GLASS_NODES - 1);
    const uvec2 node = uvec2(clamp(grid + 0.5, vec2(0.0), vec2(VIRGA_GLASS_NODES - 1)));
    const Frame at = node_frame(node);
    return vec2(dot(to_vec(look.gravity), at.along_u), dot(to_vec(look.gravity), at.along_v));
}

// A cap on an inclined surface, for small slopes: surface tension x laplacian of the height + density x gravity x
// distance downhill is constant, and the height is 0 at the rim. The solution is the level cap times 1 + s x, with x
// the distance downhill over the radius and s = Bond number / (8 height over radius).
// `bond`: that number by the radius, with the direction of gravity.
vec2 sag_of(vec2 bond)
{
    const vec2 s = bond * (1.0 / 8.0 / look.cap_height);
    return s * min(1.0, 0.6 / max(length(s), 1e-6));
}

// The strain of a drop on an inclined surface, which is longer than it is wide: by 1 + 0.096 x its
// Bond number (ElSherbini and Jacobi 2004). That number, density x gravity along the pane x diameter^2 / surface
// tension, is four times that by the radius.
vec2 pinned_strain(vec2 bond) { return strain_along(bond, log(1.0 + 0.096 * 4.0 * look.pinning * length(bond))); }

// A drop that has just landed: three sub-balls around the main one, which flow into it (section 4.7). All are caps, so
// radii go with the cube root of the water. Their shares, distances and angles are random, so two may look like one;
// with equal ones every splat would look like a clover leaf.
void shape_landing(float t, uint random)
{
    const float left = (1.0 - t) * (1.0 - t), radius = radii[0], first_angle = 6.2831853 * virga_unit(random);
    vec3 shares;
    for (uint i = 0u; i < 3u; i++) {
        const vec4 chance = unpackUnorm4x8(virga_hash2(random, i));
        const float angle = first_angle + 2.0943951 * float(i) + 1.6 * (chance.x - 0.5);
        middles[i + 1u] = middles[0] + vec2(cos(angle), sin(angle)) * (radius * left * (0.85 + 0.6 * chance.y));
        shares[i] = 0.3 + chance.z;
    }
    shares *= SUB_WATER * left / dot(shares, vec3(1.0));
    for (uint i = 0u; i < 3u; i++)
        radii[i + 1u] = radius * pow(shares[i], 1.0 / 3.0);
    radii[0] = radius * pow(1.0 - SUB_WATER * left, 1.0 / 3.0);
    sub_peak = min(4.0 * (1.0 - t), 1.0);
}

// A tear, or a comma if the tail is not straight behind: smaller balls behind the drop, farther the more of a tear
// it is. Together they hold its water.
void shape_tear(vec2 behind, vec2 tail)
{
    const float share = length(tail);
    const vec3 sizes = share * vec3(0.80, 0.60, 0.42);
    const vec3 distances = (0.35 + 0.65 * share) * vec3(0.75, 1.45, 2.05);
    const float head = radii[0] / pow(1.0 + dot(sizes, sizes * sizes), 1.0 / 3.0);
    radii[0] = head;
    for (int i = 0; i < 3; i++) {
        const vec2 towards = mix(behind, tail / share, float(i + 1) / 3.0);
        middles[i + 1] = middles[0] + towards * (head * distances[i] / max(length(towards), 0.2));
        radii[i + 1] = head * sizes[i];
    }
}

// The drop's outline as it is at the drawn time. Returns its strain.
vec2 shape_moved(virga_glass_drop_gpu drop, bool runs)
{
    const float age_s = max(float(look.tick - drop.outline_tick) * look.tick_s + look.late_s, 0.0);
    const float left = outline_left(age_s, radii[0]);
    const vec2 tail = unpack_tail(drop.tail) * left, velocity = vec2(drop.velocity[0], drop.velocity[1]);
    if (length(tail) > MIN_TAIL)
        shape_tear(runs ? -normalize(velocity) : normalize(tail), tail);
    const vec2 strain = strain_left(unpack_strain(drop.strain), left);
    const float size = length(strain); // what is held is less where the glass holds less
    return strain * (1.0 - (1.0 - look.pinning) * min(size, HELD_STRAIN) / max(size, 1e-6));
}

// `content`: a hash of the ball.
void count_tiles(uvec2 reached, uvec2 content)
{
    const uvec2 first = reached & 0xffffu, number = reached >> 16;
    for (uint y = 0u; y < number.y; y++)
        for (uint x = 0u; x < number.x; x++) {
            const uint tile = tile_number(first + uvec2(x, y));
            atomicAdd(tiles[tile].count, 1u);
            atomicAdd(tiles[tile].content[0], content.x);
            atomicAdd(tiles[tile].content[1], content.y);
        }
    atomicAdd(entry_count, number.x * number.y);
}

// All that height.glsl reads of a ball.
uvec2 hash_of_ball(vec2 at, vec3 size, vec2 sag, vec2 stretch)
{
    uvec2 hash = absorb(absorb(BALL_HASH, at.x), at.y);
    hash = absorb(absorb(absorb(hash, size.x), size.y), size.z);
    return absorb(absorb(absorb(absorb(hash, sag.x), sag.y), stretch.x), stretch.y);
}

// Texels that a ball covers as mist. A fading sub-ball has none.
float mist_of(uint i)
{
    const float radius = radii[i], texel_m2 = look.texel_m[0] * look.texel_m[1];
    const bool misty = i == 0u || sub_peak == 1.0;
    return misty ? (1.0 - shape_share(radius)) * min(3.14159265 * radius * radius / texel_m2, 4.0) : 0.0;
}

// `left`: part of the drop's shape that is drawn; a texture shows the rest.
void emit_balls(vec2 sag, vec2 strain, float whole, float left)
{
    const float size = length(strain);
    const vec2 stretch = size > 0.0 ? strain * (-sinh(size) / size) : vec2(0.0);
    // A drop without any shape gives all its mist to one ball; it is spread over a texel anyway.
    const bool as_one = shape_share(whole) == 0.0;
    const float all = mist_of(0u) + mist_of(1u) + mist_of(2u) + mist_of(3u);
    for (uint i = 0u; i < VIRGA_GLASS_DROP_BALLS; i++) {
        const float radius = radii[i], shape = shape_share(radius);
        const float peak = (i == 0u ? 1.0 : sub_peak) * shape * left;
        const float mist = left * (as_one ? (i == 0u ? all : 0.0) : mist_of(i));
        if (radius > 0.0 && peak + mist > 0.0) {
            const float reach = density_reach() * (1.0 + WIDER * look.pinning);
            const uvec2 reached = tiles_reached(middles[i], ball_reach(peak > 0.0 ? radius : 0.0, reach, stretch));
            const vec2 at = middles[i] + (look.pinning > 0.0 ? pinned(middles[i]) : vec2(0.0));
            balls[atomicAdd(work.balls, 1u)] = virga_glass_ball_gpu(
                float[2](at.x, at.y), radius, mist, float[2](sag.x, sag.y), peak, uint[2](reached.x, reached.y),
                float[2](stretch.x, stretch.y));
            atomicAdd(shape_count, peak > 0.0 ? 1u : 0u);
            count_tiles(reached, hash_of_ball(at, vec3(radius, mist, peak), sag, stretch));
            atomicMax(widest, floatBitsToUint(radius));
        }
    }
}

// Water that a blade pushes is higher than a drop at rest, so it is narrower: between the particle of the paper and the
// cap with its water. Particles side by side are one ridge then, without a notch between them.
float particle_radius(float water_nl)
{
    return look.particles_as_given != 0u ? look.particle_m : sqrt(look.particle_m * cap_radius(water_nl));
}

void emit_drop(uint slot)
{
    const virga_glass_drop_gpu at = drops[slot];
    const bool particle = (at.kind & VIRGA_GLASS_KIND) == VIRGA_GLASS_PARTICLE;
    const float radius = particle ? particle_radius(float(at.water_nl)) : cap_radius(float(at.water_nl));
    for (int i = 0; i < VIRGA_GLASS_DROP_BALLS; i++)
        radii[i] = 0.0;
    // Of a drop that stands still this is the same to the bit at any time.
    const vec2 before = vec2(at.previous_position[0], at.previous_position[1]);
    const vec2 middle = before + look.share * (vec2(at.position[0], at.position[1]) - before);
    middles[0] = middle;
    radii[0] = radius;
    sub_peak = 1.0;
    const vec2 bond = particle ? vec2(0.0) : gravity_at(middle) * (998.2 / 0.0728 * radius * radius);
    const vec2 sag = sag_of(bond);
    const vec2 velocity = vec2(at.velocity[0], at.velocity[1]);
    const float age = max(at.age_s + look.late_s, 0.0);
    const bool lands = !particle && age < look.impact_s && (at.kind & VIRGA_GLASS_TAIL) == 0u;
    const bool runs = !particle && !lands && (at.kind & VIRGA_GLASS_RUNNING) != 0u && dot(velocity, velocity) > 1e-8;
    if (lands)
        shape_landing(age / look.impact_s, at.random);
    vec2 strain = vec2(0.0);
    if (!particle && !lands)
        strain = shape_moved(at, runs);
    // Without pinning outlines of balls are circles: see PINNED in height.glsl.
    strain = look.pinning > 0.0 ? strain + pinned_strain(bond) : vec2(0.0);
    float left = 1.0;
    if (MODE != 0u) {
        const vec4 clip = clip_of_pane(frame_on(middle).position, 1.0);
        left = clip.w > 0.0 ? shape_left(relative_size(radius, clip.w)) : 1.0;
    }
    emit_balls(sag, strain, radius, left);
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        widest = shape_count = entry_count = 0u;
    barrier();
    const uint i = gl_GlobalInvocationID.x, slot = listed[min(i, look.pane.max_drops - 1u)];
    if (i < state.shown && (drops[slot].kind & VIRGA_GLASS_KIND) != VIRGA_GLASS_FREE)
        emit_drop(slot);
    barrier();
    if (gl_LocalInvocationIndex != 0u || widest == 0u)
        return;
    atomicMax(work.highest, widest);
    atomicAdd(work.shaped, shape_count);
    atomicAdd(work.entries, entry_count);
}
