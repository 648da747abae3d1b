// host_color.glsl - a sample of the host's picture as linear light. The includer has shared/view_gpu.h.
#include "gpu/srgb.glsl"

// `given`: virga_view_gpu.color_given. Software Vulkan decodes in any case, so passes that read many samples have
// pipelines of their own for linear light.
vec3 host_color(vec3 stored, uint given)
{
    vec3 light = stored;
    for (; given == VIRGA_COLOR_SRGB; given = VIRGA_COLOR_LINEAR)
        light = srgb_decoded(max(stored, vec3(0.0)));
    return light;
}
