// move.comp - moves the drops: where each slot's drop is at the end of a tick.
// One invocation per slot. Reads: slots, travel of the classes, sways. Writes: drops.
//
// A slot is a point of a lattice that moves with its class: lattice coordinate = slot.lattice + travel. The box around
// the camera contains one cell of the lattice, so each slot has one drop there. The lattice's layers (above each other)
// are shifted sideways by a hash, and the columns of a layer again; else every drop would land where the one before it
// landed. Everything is in integers: wrapping around is overflow, a position has the same bits however far from the
// start, and the camera only selects the cell.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
// Each is a virga_drop_gpu, written as a vector: separate members take a third longer on software Vulkan.
layout(scalar, set = 0, binding = 3) writeonly buffer Drops { uvec4 drops[]; };

// virga_travel_gpu of each class, as pairs: software Vulkan reads small tables several times faster from a uniform
// buffer.
layout(std140, set = 0, binding = 14) uniform Travels { uvec4 travels[2 * VIRGA_RAIN_CLASSES]; };

// 64-bit values as (low, high).
uvec2 add64(uvec2 a, uvec2 b)
{
    uint carry;
    const uint low = uaddCarry(a.x, b.x, carry);
    return uvec2(low, a.y + b.y + carry);
}

uvec2 shift64(uvec2 a, uint bits) { return bits == 0u ? a : uvec2(a.x << bits, (a.y << bits) | (a.x >> (32u - bits))); }

// One round of multiply-xorshift: good enough for layers, of which a few thousand pass in an hour.
uint scatter(uint h, uint word)
{
    h = (h ^ word) * 0xed5ad4bbu;
    h ^= h >> 15;
    h *= 0xac4c1b51u;
    return h ^ (h >> 16);
}

// The lattice coordinate relative to the camera along one axis, from the lower side of the box; .y is the cell.
uvec2 from_camera(uint slot_coordinate, uint low, uint high, uint shift)
{
    const uvec2 moved = shift64(uvec2(low, high), shift);
    return add64(uvec2(moved.x, moved.y), add64(uvec2(slot_coordinate, 0u), uvec2(0x80000000u, 0u)));
}

void main()
{
    const uint slot_index = gl_GlobalInvocationID.x;
    const uint level = slot_level(slot_index);
    const uint shift = tick.levels - 1u - level;
    const virga_slot_gpu slot = slot_of(slot_index);
    const uint size_class = slot.class_rank & 0xffffu;
    const uvec4 low = travels[2u * size_class], high = travels[2u * size_class + 1u];

    uvec2 x = from_camera(slot.lattice[0], low.x, high.x, shift);
    uvec2 y = from_camera(slot.lattice[1], low.y, high.y, shift);
    uvec2 z = from_camera(slot.lattice[2], low.z, high.z, shift);
    if (SWAYS && tick.sway != 0u) {
        const virga_sway_gpu sway = sways[slot_index];
        x = add64(x, uvec2(sway.offset_low[0], sway.offset_high[0]));
        y = add64(y, uvec2(sway.offset_low[1], sway.offset_high[1]));
        z = add64(z, uvec2(sway.offset_low[2], sway.offset_high[2]));
    }
    uint h = scatter(slot_index ^ tick.seed, y.y);
    x = add64(x, uvec2(h, 0u));
    h = scatter(h, x.y);
    z = add64(z, uvec2(h, 0u));
    h = scatter(h, z.y);

    const float unit = tick.side_m * uintBitsToFloat((95u - shift) << 23); // side / 2^(32 + shift)
    const ivec3 middle = ivec3(uvec3(x.x, y.x, z.x) - 0x80000000u);
    const vec3 p = vec3(middle) * unit;
    const uint id = slot_index | (h << VIRGA_RAIN_ID_SLOT_BITS);
    drops[slot_index] = uvec4(floatBitsToUint(p), id);
}
