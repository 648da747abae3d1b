// pyramid.frag - a side of a pyramid, in one shade of its surroundings, premultiplied.
// One invocation per pixel of a pyramid. Reads: the scene's depth. Writes: radiance, motion, reactive.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/splash_gpu.h"
#include "shared/view_gpu.h"
#include "gpu/vectors.glsl"
layout(scalar, set = 0, binding = 1) uniform View { virga_view_gpu view; };
#include "gpu/light.glsl"
#define SCENE_DEPTH_BINDING 16
#include "gpu/scene_depth.glsl"
#include "gpu/temporal.glsl"
#include "gpu/encode.glsl"
#ifdef MOTION
layout(location = 2) in vec3 before; // in the previous frame's clip coordinates: x, y, w
#endif

layout(constant_id = 0) const bool HAS_DEPTH = true;
layout(location = 0) in vec3 position;
layout(location = 1) flat in vec2 shade;
layout(location = 0) out vec4 radiance;

void main()
{
    const vec3 d = normalize(position);
    const vec3 face = cross(dFdx(position), dFdy(position));
    vec3 n = dot(face, face) > 0.0 ? normalize(face) : -d;
    n = dot(n, d) > 0.0 ? -n : n;
    const vec3 light = 0.5 * environment(reflect(d, n), vec2(0.9, 0.7)) + 0.5 * environment(d, vec2(0.9, 0.7)) +
                       0.5 * lamps(position, d);
    const float alpha = shade.x * (HAS_DEPTH ? soft_edge(1.0 / gl_FragCoord.w) : 1.0);
    radiance = for_target(vec4(light * alpha, alpha));
    WRITE_MOTION(motion_from(before), alpha);
    WRITE_REACTIVE(alpha, view.reactive_gain);
}
