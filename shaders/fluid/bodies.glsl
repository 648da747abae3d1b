// bodies.glsl - bodies in the water: where they are, the particles that touch them, and their maps.
//
// A particle feels up to VIRGA_FLUID_TOUCHES bodies, as it feels the walls of the box: their part of its density, and
// the gradient G of that part. Its pressure p pushes it by -p G, and the body by p G: what one gets the other loses.
// The solver sees the body move under these pushes in each of its iterations. So a light body, which water would throw
// about if it moved only after the last iteration, is as stable as a heavy one.
#include "gpu/quaternion.glsl"

#ifndef BODIES_ACCESS
#define BODIES_ACCESS readonly
#endif
#ifndef TOUCHES_ACCESS
#define TOUCHES_ACCESS readonly
#endif

#define NO_BODY 0xffffffffu

// The last word of a touch: the body, and which shares of the particle's weight it carries across its surface and along
// it, in 12 bits each.
uint touch_word(uint body, vec2 shares)
{
    const uvec2 parts = uvec2(4095.0 * clamp(shares, 0.0, 1.0) + 0.5);
    return parts.x << 20 | parts.y << 8 | body;
}
uint touch_body(uvec4 touch) { return touch.w == NO_BODY ? NO_BODY : touch.w & 0xffu; }

// The part of gravity (m/s^2) that a body takes from a particle, and that it feels in its place. The gradient stands on
// its surface.
vec3 body_carries(uvec4 touch)
{
    const vec3 normal = uintBitsToFloat(touch.xyz), gravity = to_vec(frame.gravity_m_s2);
    const vec3 across = dot(gravity, normal) / max(dot(normal, normal), 1e-12) * normal;
    const vec2 shares = vec2(touch.w >> 20, touch.w >> 8 & 0xfffu) / 4095.0;
    return shares.x * across + shares.y * (gravity - across);
}

// Their states; then, for each of them, frame.max_contacts indices of touches.
layout(scalar, set = 0, binding = 7) BODIES_ACCESS buffer Bodies {
    virga_fluid_body_gpu bodies[VIRGA_FLUID_MAX_BODIES];
    uint contacts[];
};
// For each sorted particle and each body that it touches: the gradient of the body's part of its density (1 / spacing),
// and touch_word. After advance.comp: the momentum that it gave to the body, as a velocity of the particle.
layout(std430, set = 0, binding = 21) TOUCHES_ACCESS buffer Touches { uvec4 touches[]; };
TEXELS(touch_texel, 22, 21)
// Nodes of all maps, then points. See engine/fluid/body_mesh.h.
TEXELS(map_texel, 24, 23)
layout(scalar, set = 0, binding = 25) uniform Shapes { virga_fluid_shapes_gpu shapes; };

vec4 rotation_of(uint body)
{
    return vec4(bodies[body].rotation[0], bodies[body].rotation[1], bodies[body].rotation[2],
                bodies[body].rotation[3]);
}

// A symmetric matrix in the axes of the body, times a vector of the world.
vec3 times(float m[6], vec4 rotation, vec3 v)
{
    const vec3 u = turn_back(rotation, v);
    return turn(rotation, vec3(m[0] * u.x + m[3] * u.y + m[4] * u.z, m[3] * u.x + m[1] * u.y + m[5] * u.z,
                               m[4] * u.x + m[5] * u.y + m[2] * u.z));
}

// Velocity of a point that moves with the body (m/s).
vec3 body_velocity(uint body, vec3 p)
{
    return to_vec(bodies[body].velocity) + cross(to_vec(bodies[body].spin), p - to_vec(bodies[body].center));
}

// What a body means for a particle.
struct Near {
    float density;
    vec3 gradient; // 1 / spacing
    float pull;    // sum of |x . grad W|, for the pressure
    float distance; // in spacings
    vec3 normal;
};

// Between the eight nodes around a position (m).
Near near_body(uint body, vec3 p)
{
    const vec4 rotation = rotation_of(body);
    const vec3 at =
        (turn_back(rotation, p - to_vec(bodies[body].center)) - to_vec(shapes.of[body].low)) *
        shapes.of[body].inv_node_m;
    const uvec3 dims = uvec3(shapes.of[body].dims[0], shapes.of[body].dims[1], shapes.of[body].dims[2]);
    Near near = Near(0.0, vec3(0.0), 0.0, VIRGA_FLUID_MAP_REACH, vec3(0.0));
    if (any(lessThan(at, vec3(0.0))) || any(greaterThanEqual(at, vec3(dims) - 1.0)))
        return near;
    const uvec3 node = uvec3(at);
    const vec3 f = at - vec3(node);
    const uint first = shapes.of[body].first_node + (node.z * dims.y + node.y) * dims.x + node.x;
    near.distance = 0.0;
    for (uint corner = 0u; corner < 8u; corner++) {
        const uvec3 side = uvec3(corner, corner >> 1, corner >> 2) & 1u;
        const uvec4 words = map_texel(first + (side.z * dims.y + side.y) * dims.x + side.x);
        const vec3 part = mix(1.0 - f, f, bvec3(side));
        const vec2 xy = unpackSnorm2x16(words.x), z = unpackSnorm2x16(words.y);
        const float weight = part.x * part.y * part.z, distance = uintBitsToFloat(words.z);
        near.gradient += weight * vec3(xy, z.x);
        near.density += weight * z.y;
        near.distance += weight * distance;
        near.pull += weight * uintBitsToFloat(words.w);
        near.normal += distance * (2.0 * vec3(side) - 1.0) * (part.yzx * part.zxy);
    }
    near.gradient = turn(rotation, VIRGA_FLUID_MAP_GRADIENT * near.gradient);
    near.normal = turn(rotation, near.normal / max(length(near.normal), 1e-6));
    return near;
}
