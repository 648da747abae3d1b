// recall.comp - spray whose particle has fallen back into the water ends: its water is the particle's again.
// The droplet is still drawn in this frame, as the particle is water from the next one on.
// One invocation per droplet in the air. Reads: leavers, their table. Writes: droplets, leavers, counts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/splash_gpu.h"
#include "shared/droplet.h"
#include "shared/leaver.h"
#include "shared/random.h"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

layout(scalar, set = 0, binding = 0) buffer State { virga_splash_state_gpu state; };
layout(scalar, set = 0, binding = 1) buffer Droplets { uvec4 droplets[]; };
layout(scalar, set = 0, binding = 2) buffer Leavers
{
    virga_leavers_gpu leavers_head;
    virga_leaver_gpu leavers[];
};
layout(std430, set = 0, binding = 3) readonly buffer LeaverTable { uint leaver_table[]; };
#include "counters.glsl"

#define NO_LEAVER 0xffffffffu

// Index of a particle among the leavers; NO_LEAVER: it is none.
uint leaver_of(uint id)
{
    const uint first = leavers_head.half_now * (leavers_head.mask + 1u);
    for (uint i = 0u, at = virga_hash1(id); i <= leavers_head.mask; i++, at++) {
        const uint entry = leaver_table[first + (at & leavers_head.mask)];
        if (entry == 0u)
            return NO_LEAVER;
        const uint leaver = leavers_head.half_now * leavers_head.max + entry - 1u;
        if (leavers[leaver].id == id)
            return leaver;
    }
    return NO_LEAVER;
}

void main()
{
    const uint slot = gl_GlobalInvocationID.x;
    if (slot >= state.staying || leavers_head.count == 0u)
        return;
    const uvec4 last = droplets[4u * slot + 3u]; // kind, id, water, weight
    if ((last.x & VIRGA_DROPLET_SPRAY) == 0u || (last.x & VIRGA_DROPLET_FALLEN) != 0u)
        return;
    const uint leaver = leaver_of(last.y);
    if (leaver == NO_LEAVER || (leavers[leaver].flags & VIRGA_LEAVER_RETURNED) == 0u)
        return;
    atomicAdd(leavers[leaver].taken_nl, last.z);
    count(VIRGA_SPLASH_SPRAY_BACK, last.z);
    droplets[4u * slot + 3u] = uvec4(last.x | VIRGA_DROPLET_FALLEN, last.y, 0u, last.w);
}
