// move.comp - moves foam, and tells by the water around each particle what it is (sections 3.2 and 3.3 of Ihmsen et al.
// 2012). Marks which slots are free.
//
// Steps here are as long as frames of a film, ten times those of the paper, so what a step computes is exact in time
// where it can be:
//
//   spray   flies as a drop in air at rest, as droplets do (spray/air.glsl), in short steps.
//   foam    has the velocity of the water around it (equation 7). Where the water is then depends on where the foam is
//           then, so it is found in two rounds, and the foam moves with the mean of its velocities before and after:
//           it stays where it is in water that flows as a whole. It is also held at the surface, which such steps would
//           lead it away from.
//   bubble  dv/dt = k_d (u - v) + k_b up (equation 6), with the exact solution for constant u.
//
// Foam and spray dissolve with time, bubbles do not. In the paper spray does not, either; here it has no floor to fall
// onto.
// One invocation per slot. Reads: sorted, sorted_velocities. Reads and writes: foam. Writes: selection,
// state.foam_kinds.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "foam.glsl"
#include "water/spray/air.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 7
#define COMPACT_LIST_BINDING 9
#include "gpu/compact_mark.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

vec3 here;
float weight_sum, count, inv_h2;
vec3 velocity_sum, gradient_sum;

void visit(uint i, vec4 particle);
#include "gather.glsl"
TEXELS(velocity_texel, 16, 14)

void visit(uint i, vec4 particle)
{
    const vec3 apart = here - particle.xyz;
    const float x = max(1.0 - dot(apart, apart) * inv_h2, 0.0), squared = particle.w * x * x;
    count += x > 0.0 ? particle.w : 0.0;
    weight_sum += squared * x;
    gradient_sum += squared * apart;
    if (x > 0.0)
        velocity_sum += squared * x * uintBitsToFloat(velocity_texel(i)).xyz;
}

// Adds up the water around a position; also just outside the grid's inner cells.
void look_around(vec3 at)
{
    const uvec3 dims = grid_dims();
    const ivec3 local = cell_of(at) - grid_first();
    here = at;
    inv_h2 = frame.inv_h2;
    weight_sum = count = 0.0;
    velocity_sum = gradient_sum = vec3(0.0);
    if (is_valid(at) && all(greaterThanEqual(local, ivec3(1))) && all(lessThan(local, ivec3(dims) - 1)))
        gather(cell_index(uvec3(local), dims));
}

#define STEPS_PER_S 240.0

void fly(inout vec3 position, inout vec3 velocity, float diameter, float time_s)
{
    const uint steps = clamp(uint(ceil(time_s * STEPS_PER_S)), 1u, 64u);
    const float step_s = time_s / float(steps);
    for (uint i = 0u; i < steps; i++) {
        const vec3 before = velocity;
        const float slowed = 1.0 + step_s * drag_rate(max(length(velocity), 1e-6), diameter);
        velocity = (velocity - vec3(0.0, 9.81 * step_s, 0.0)) / slowed;
        position += 0.5 * step_s * (before + velocity);
    }
}

// How far the surface is, along the density's gradient (Newton's method); half a spacing at most.
vec3 to_surface()
{
    const vec3 slope = frame.kernel_gradient * gradient_sum;
    const float missing = frame.level - frame.kernel * weight_sum, reach = 0.5 * frame.spacing;
    const vec3 step_m = slope * (missing / max(dot(slope, slope), 1e-20));
    return step_m * min(1.0, reach * inversesqrt(max(dot(step_m, step_m), 1e-20)));
}

void move(inout virga_foam_gpu own, float gap_s)
{
    const vec3 from = to_vec(own.position), before = to_vec(own.velocity);
    vec3 position = from, velocity = before;
    fly(position, velocity, 2.0 * own.radius, gap_s);
    look_around(own.kind == VIRGA_FOAM_SPRAY ? position : from + gap_s * before);
    if (count >= frame.foam_few) {
        const vec3 flow = velocity_sum / max(weight_sum, 1e-20);
        look_around(from + 0.5 * gap_s * (before + flow));
    }
    own.around = count;
    own.kind = count < frame.foam_few ? VIRGA_FOAM_SPRAY
                                      : count > frame.foam_many ? VIRGA_FOAM_BUBBLE : VIRGA_FOAM_SURFACE;
    const vec3 flow = velocity_sum / max(weight_sum, 1e-20);
    if (own.kind == VIRGA_FOAM_SURFACE) {
        velocity = flow;
        position = from + 0.5 * gap_s * (before + flow) + to_surface();
    } else if (own.kind == VIRGA_FOAM_BUBBLE) {
        const vec3 rising = flow + vec3(0.0, frame.foam_buoyancy / frame.foam_drag, 0.0);
        const float kept = exp(-frame.foam_drag * gap_s);
        velocity = mix(rising, before, kept);
        position = from + gap_s * rising + (before - rising) * ((1.0 - kept) / frame.foam_drag);
    }
    own.position = float[3](position.x, position.y, position.z);
    own.velocity = float[3](velocity.x, velocity.y, velocity.z);
    const vec3 moved = gap_s > 0.0 ? (position - from) / gap_s : velocity;
    own.moved = float[3](moved.x, moved.y, moved.z);
}

void main()
{
    const uint slot = gl_GlobalInvocationID.x;
    const float gap_s = foam_gap_s();
    uint selected = NOT_SELECTED;
    if (slot < frame.max_foam) {
        selected = FIRST_KIND;
        virga_foam_gpu own = foam[slot];
        if (own.life_s > 0.0) {
            own.age_s += gap_s;
            own.life_s = gap_s < 0.0 ? 0.0 : own.kind == VIRGA_FOAM_BUBBLE ? own.life_s : max(own.life_s - gap_s, 0.0);
            if (own.life_s > 0.0) {
                move(own, gap_s);
                atomicAdd(state.foam_kinds[own.kind], 1u);
                selected = SECOND_KIND;
            }
            foam[slot] = own;
        }
    }
    mark_selected(selected);
}
