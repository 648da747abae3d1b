// sky.glsl - for gpu/light.glsl: the environment's coefficients in a fragment shader. A GPU reads a constant of a view
// once for all pixels of a wave. Software Vulkan reads each word of a uniform buffer pixel by pixel, so there they are
// texels of the view, of which one fetch reads four words. They are too many for flat inputs.
#include "gpu/variants.glsl"
#define SH_FETCHED
layout(location = 12) flat in uint view_texel; // first texel of the view
layout(set = 0, binding = 28) uniform usamplerBuffer view_texels;

vec3 fetched_coefficient(uint i)
{
    const uint word = VIRGA_VIEW_SH_WORD + 3u * i, texel = view_texel + word / 4u, first = word % 4u;
    const uvec4 low = texelFetch(view_texels, int(texel)), high = texelFetch(view_texels, int(texel + 1u));
    const uvec3 words = first == 0u   ? low.xyz
                        : first == 1u ? low.yzw
                        : first == 2u ? uvec3(low.zw, high.x)
                                      : uvec3(low.w, high.xy);
    return uintBitsToFloat(words);
}

#define sh_coefficient(i) (FOR_GPU ? uniform_coefficient(i) : fetched_coefficient(i))
