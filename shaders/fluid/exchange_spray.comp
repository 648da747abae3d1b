// exchange_spray.comp - particles whose droplets fly on their own end here, see shared/leaver.h. The droplets have
// their water in whole nanolitres; what a particle had more, or less, waits for the next water that goes to the ground.
// One workgroup, in which each invocation takes a run of leavers. Reads: leavers. Writes: particles, slot_pressures,
// exchange.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "exchange.glsl"
#include "shared/leaver.h"

#define LANES 256u
layout(local_size_x = LANES) in;

layout(scalar, set = 0, binding = 4) readonly buffer Leavers
{
    virga_leavers_gpu leavers_head;
    virga_leaver_gpu leavers[];
};

shared uint ended, given_low, given_high;

// A particle ends only once, also if two leavers had the same id.
bool end_particle(virga_leaver_gpu leaver)
{
    const uint slot = leaver.particle;
    if ((leaver.flags & VIRGA_LEAVER_HANDED) == 0u || slot >= frame.particles || particles[slot].id != leaver.id)
        return false;
    return atomicExchange(share_bits[slot * SHARE_STRIDE + SHARE_AT], 0u) != 0u;
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, count = min(leavers_head.count, leavers_head.max);
    const uint first = leavers_head.half_now * leavers_head.max;
    if (lane == 0u)
        ended = given_low = given_high = 0u;
    barrier();
    for (uint i = lane; i < count; i += LANES) {
        const virga_leaver_gpu leaver = leavers[first + i];
        if (!end_particle(leaver))
            continue;
        begin_rest(leaver.particle);
        atomicAdd(ended, 1u);
        const uint old = atomicAdd(given_low, leaver.given_nl);
        if (old + leaver.given_nl < old)
            atomicAdd(given_high, 1u);
    }
    barrier();
    if (lane != 0u || ended == 0u)
        return;
    uint before[2] = exchange.rest_nl;
    add_water(before, ended);
    uint borrow;
    exchange.rest_nl[0] = usubBorrow(before[0], given_low, borrow);
    exchange.rest_nl[1] = before[1] - given_high - borrow;
    uint carry;
    exchange.sprayed_nl[0] = uaddCarry(exchange.sprayed_nl[0], given_low, carry);
    exchange.sprayed_nl[1] += given_high + carry;
}
