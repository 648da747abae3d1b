// scene_color.glsl - the host's picture as linear light. The includer has lens.glsl.
#include "shared/view_gpu.h"
#include "gpu/host_color.glsl"

layout(set = 0, binding = 5) uniform sampler2D scene_picture;

vec3 scene_color(ivec2 pixel)
{
    return host_color(finite(texelFetch(scene_picture, pixel, 0)).rgb, view.color_given);
}
