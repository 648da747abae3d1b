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

// Four samples, with one loop for all of them.
void host_colors(inout vec3 a, inout vec3 b, inout vec3 c, inout vec3 d, uint given)
{
    for (; given == VIRGA_COLOR_SRGB; given = VIRGA_COLOR_LINEAR) {
        a = srgb_decoded(max(a, vec3(0.0)));
        b = srgb_decoded(max(b, vec3(0.0)));
        c = srgb_decoded(max(c, vec3(0.0)));
        d = srgb_decoded(max(d, vec3(0.0)));
    }
}
