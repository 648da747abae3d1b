// view.glsl - a view of the water: its parameters, and positions in the effect's images.
#define VIRGA_GLSL
#include "gpu/vectors.glsl"
#include "shared/view_gpu.h"
#include "shared/water_gpu.h"
#include "shared/water_draw_gpu.h"

layout(scalar, set = 0, binding = 0) uniform View
{
    virga_view_gpu view;
    virga_water_look_gpu look;
};

#include "gpu/view.glsl"

// The images have their own depth buffer, whatever the host's is like: NEAR_W over view depth, 0 at infinity.
vec3 camera_right() { return vec3(look.axes[0], look.axes[1], look.axes[2]); }
vec3 camera_up() { return vec3(look.axes[3], look.axes[4], look.axes[5]); }
vec3 camera_back() { return vec3(look.axes[6], look.axes[7], look.axes[8]); }

// A normal that faces the camera, as two numbers that can be averaged: its stereographic projection from the direction
// of view. It has no border where the normal is at right angles to the camera's axis, unlike the normal's own x and y.
vec2 facing_of(vec3 normal)
{
    const vec3 n = vec3(dot(normal, camera_right()), dot(normal, camera_up()), dot(normal, camera_back()));
    return n.xy / max(1.0 + n.z, 0.1);
}

// In a word; half floats would turn the normal by 0.0005.
uint pack_facing(vec2 facing) { return packSnorm2x16(0.5 * facing); }
vec2 unpack_facing(uint packed) { return 2.0 * unpackSnorm2x16(packed); }

// What the depth pass does to a splat, in the high half of a word: how much farther away it is drawn, [0; 4] as a share
// of its distance, and a factor of its size, [0; 1].
uint pack_push_scale(vec2 push_scale)
{
    const vec2 bytes = ceil(255.0 * clamp(vec2(0.5 * sqrt(push_scale.x), push_scale.y), vec2(0.0), vec2(1.0)));
    return uint(bytes.x) << 16 | uint(bytes.y) << 24;
}
vec2 unpack_push_scale(uint packed)
{
    const float root = float(packed >> 16 & 255u) * (2.0 / 255.0);
    return vec2(root * root, float(packed >> 24) / 255.0);
}

vec3 normal_of(vec2 facing)
{
    const float s = dot(facing, facing);
    const vec3 n = vec3(2.0 * facing, 1.0 - s) / (1.0 + s);
    return n.x * camera_right() + n.y * camera_up() + n.z * camera_back();
}
