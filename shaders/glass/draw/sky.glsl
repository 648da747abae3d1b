// sky.glsl - for gpu/light.glsl: the environment's coefficients, fetched as texels of the view. Four words are
// one fetch then; from a uniform buffer software Vulkan reads each word lane by lane in a fragment shader. They are too
// many to come from corners.
#define SH_FETCHED
layout(location = 12) flat in uint view_texel; // the view's first
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
