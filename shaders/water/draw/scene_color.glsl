// scene_color.glsl - the host's picture.
#include "gpu/host_color.glsl"
layout(set = 0, binding = 18) uniform sampler2D scene_color;
