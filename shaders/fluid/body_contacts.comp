// body_contacts.comp - lists the particles that touch a body, in the order in which they are sorted, and lets gravity
// act on the body.
// One workgroup per body. Reads: cell_starts, touches. Writes: bodies, contacts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define STATE_ACCESS readonly
#define BODIES_ACCESS
#include "fluid.glsl"
#include "bodies.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

shared uint words[VIRGA_FLUID_LANES / 32];

// Index of the particle's touch of this body; NO_BODY if there is none.
uint touch_of(uint i, uint body)
{
    for (uint k = 0u; k < VIRGA_FLUID_TOUCHES; k++)
        if (touch_body(touch_texel(VIRGA_FLUID_TOUCHES * i + k)) == body)
            return VIRGA_FLUID_TOUCHES * i + k;
    return NO_BODY;
}

// Appends the touches of the particles from `first` on to the list, after `before` others. Returns their number.
uint append(uint body, uint first, uint end, uint before)
{
    const uint lane = gl_LocalInvocationIndex, i = first + lane, word = lane / 32u, bit = lane % 32u;
    const uint touch = i < end ? touch_of(i, body) : NO_BODY;
    barrier();
    if (lane < VIRGA_FLUID_LANES / 32u)
        words[lane] = 0u;
    barrier();
    if (touch != NO_BODY)
        atomicOr(words[word], 1u << bit);
    barrier();
    uint all = 0u, rank = bitCount(words[word] & ((1u << bit) - 1u));
    for (uint w = 0u; w < VIRGA_FLUID_LANES / 32u; w++) {
        all += bitCount(words[w]);
        rank += w < word ? bitCount(words[w]) : 0u;
    }
    if (touch != NO_BODY && before + rank < frame.max_contacts)
        contacts[body * frame.max_contacts + before + rank] = touch;
    return all;
}

void main()
{
    const uint body = gl_WorkGroupID.x;
    const uvec3 dims = grid_dims();
    const vec3 center = to_vec(bodies[body].center), reach = vec3(shapes.of[body].radius_m);
    const ivec3 inner = ivec3(VIRGA_GRID_MARGIN), outer = ivec3(dims) - 1 - VIRGA_GRID_MARGIN;
    const ivec3 low = max(cell_of(center - reach) - grid_first(), inner);
    const ivec3 high = min(cell_of(center + reach) - grid_first(), outer);
    const bool is_free = shapes.of[body].inv_mass > 0.0;
    uint count = 0u;
    if (is_free && all(lessThanEqual(low, high)))
        for (int z = low.z; z <= high.z; z++)
            for (int y = low.y; y <= high.y; y++) {
                const uint row = cell_index(uvec3(0, y, z), dims);
                const uint end = cell_starts[row + uint(high.x) + 1u];
                for (uint first = cell_starts[row + uint(low.x)]; first < end; first += VIRGA_FLUID_LANES)
                    count += append(body, first, end, count);
            }
    if (gl_LocalInvocationIndex != 0u)
        return;
    bodies[body].contacts = min(count, frame.max_contacts);
    bodies[body].dropped = count - min(count, frame.max_contacts);
    for (uint axis = 0u; axis < 3u; axis++) {
        if (is_free)
            bodies[body].velocity[axis] += state.dt_s * frame.gravity_m_s2[axis];
        bodies[body].free_velocity[axis] = bodies[body].velocity[axis];
        bodies[body].free_spin[axis] = bodies[body].spin[axis];
    }
}
