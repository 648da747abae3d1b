// exchange_out.comp - particles that have come to rest, or are not in the box, are given to the ground, in the order of
// their slots; and what the ground needs to know of the simulation. Those that find no room in the list wait.
// One workgroup, in which each invocation takes a run of slots. Reads and writes: particles, slot_pressures,
// exchange. Writes: entries.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "exchange.glsl"
#include "gpu/group_scan.glsl"

layout(local_size_x = SCAN_LANES) in;

shared uint live, free_slots;

bool is_leaving(uint slot)
{
    if (is_free(slot) || frame.gives_back == 0u)
        return false;
    const vec3 p = to_vec(particles[slot].position);
    const bool inside =
        all(greaterThanEqual(p, to_vec(frame.low_m))) && all(lessThanEqual(p, to_vec(frame.high_m))); // false for NaN
    return !inside || rest_of(slot) >= frame.rest_s;
}

// What the first particle takes along of the rest: never so much that it has no water, or more than 32 bits.
int rest_with_first()
{
    const int least = 1 - int(frame.particle_nl), most = 0x3fffffff;
    const bool negative = int(exchange.rest_nl[1]) < 0;
    if (exchange.rest_nl[1] != (negative ? 0xffffffffu : 0u) || (int(exchange.rest_nl[0]) < 0) != negative)
        return negative ? least : most;
    return clamp(int(exchange.rest_nl[0]), least, most);
}

void give(uint slot, uint index)
{
    const uint nl = frame.particle_nl + uint(index == 0u ? rest_with_first() : 0);
    entries[exchange.capacity + index] = virga_exchanged_gpu(particles[slot].position, nl);
    particles[slot].share = 0.0;
    begin_rest(slot);
}

void add_signed(inout uint sum[2], int nl)
{
    uint carry;
    sum[0] = uaddCarry(sum[0], uint(nl), carry);
    sum[1] += (nl < 0 ? 0xffffffffu : 0u) + carry;
}

void describe(uint given)
{
    exchange.capacity = frame.max_exchanged;
    exchange.free_slots = free_slots;
    exchange.particle_nl = frame.particle_nl;
    exchange.spacing_m = frame.spacing_m;
    exchange.floor_m = frame.low_m[1];
    exchange.ceiling_m = frame.high_m[1];
    exchange.particles = live;
    if (given == 0u)
        return;
    exchange.given = given;
    exchange.given_groups = uint[3]((given + 63u) / 64u, 1u, 1u);
    add_water(exchange.given_nl, given);
    const int rest = rest_with_first();
    add_signed(exchange.given_nl, rest);
    add_signed(exchange.rest_nl, -rest);
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, run = (frame.particles + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(lane * run, frame.particles), end = min(begin + run, frame.particles);
    const uint room = exchange.given == 0u ? exchange.capacity : 0u;
    if (lane == 0u)
        live = free_slots = 0u;
    uint leaving = 0u, own_live = 0u, own_free = 0u;
    for (uint slot = begin; slot < end; slot++)
        leaving += is_leaving(slot) ? 1u : 0u;
    uvec2 all;
    uint next = scan_group(uvec2(leaving, 0u), all).x;
    for (uint slot = begin; slot < end; slot++) {
        if (next < room && is_leaving(slot))
            give(slot, next++);
        const bool empty = is_free(slot);
        own_live += empty ? 0u : 1u;
        own_free += empty && slot < frame.exchanged ? 1u : 0u;
    }
    atomicAdd(live, own_live);
    atomicAdd(free_slots, own_free);
    barrier();
    if (lane == 0u)
        describe(min(all.x, room));
}
