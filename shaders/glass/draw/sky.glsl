// sky.glsl - for gpu/light.glsl: the environment's coefficients, fetched as texels of the view. One fetch reads four
// words; in a fragment shader software Vulkan reads each word of a uniform buffer lane by lane. They are too many for
// flat inputs.
#define SH_FETCHED
layout(location = 12) flat in uint view_texel; // first texel of the view
layout(set = 0, binding = 28) uniform usamplerBuffer view_texels;

vec3 sh_coefficient(uint i)
{
    const uint word = VIRGA_VIEW_SH_WORD + 3u * i, texel = view_texel + word / 4u, first = word % 4u;
    const uvec4 low = texelFetch(view_texels, int(texel)), high = texelFetch(view_texels, int(texel + 1u));
    const uvec3 words = first == 0u   ? low.xyz
                        : first == 1u ? low.yzw
                        : first == 2u ? uvec3(low.zw, high.x)
                                      : uvec3(low.w, high.xy);
    return uintBitsToFloat(words);
}
