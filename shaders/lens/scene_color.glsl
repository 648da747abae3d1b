// scene_color.glsl - the host's picture as linear light. The includer has lens.glsl. A pass with a form of its own for
// light that is linear already defines SCENE_LINEAR: the curve costs as much as reading the picture.
#include "shared/view_gpu.h"
#include "gpu/host_color.glsl"

#ifndef SCENE_LINEAR
#define SCENE_LINEAR false
#endif

layout(set = 0, binding = 5) uniform sampler2D scene_picture;

vec3 scene_light(vec3 stored)
{
    return SCENE_LINEAR ? finite(stored) : host_color(finite(stored), view.color_given);
}

vec3 scene_color(ivec2 pixel) { return scene_light(texelFetch(scene_picture, pixel, 0).rgb); }
