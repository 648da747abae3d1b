// texels.glsl - droplets and splashes, four texels each: how passes read and write them.
//
// Stores of four words at a time are also the fastest on software Vulkan.
#include "gpu/texels.glsl"

TEXELS(droplet_texel, 18, 6)
TEXELS(splash_texel, 19, 5)

float[3] floats(uvec3 words)
{
    const vec3 numbers = uintBitsToFloat(words);
    return float[3](numbers.x, numbers.y, numbers.z);
}

uvec4 texel_of(float three[3], uint fourth) { return uvec4(floatBitsToUint(to_vec(three)), fourth); }
uvec4 texel_of(float three[3], float fourth) { return texel_of(three, floatBitsToUint(fourth)); }

virga_droplet_gpu droplet_from(uvec4 a, uvec4 b, uvec4 c, uvec4 d)
{
    return virga_droplet_gpu(floats(a.xyz), uintBitsToFloat(a.w), floats(b.xyz), uintBitsToFloat(b.w), floats(c.xyz),
                             c.w, d.x, d.y, d.z, d.w);
}

virga_droplet_gpu droplet_of(uint slot)
{
    const uint texel = 4u * slot;
    return droplet_from(droplet_texel(texel), droplet_texel(texel + 1u), droplet_texel(texel + 2u),
                        droplet_texel(texel + 3u));
}

// One that this invocation has written itself, which its texels may not show yet.
virga_droplet_gpu stored_droplet(uint slot)
{
    const uint texel = 4u * slot;
    return droplet_from(droplets[texel], droplets[texel + 1u], droplets[texel + 2u], droplets[texel + 3u]);
}

uvec4[4] texels_of(virga_droplet_gpu droplet)
{
    return uvec4[4](texel_of(droplet.position, droplet.age_s), texel_of(droplet.velocity, droplet.diameter_m),
                    texel_of(droplet.base, droplet.slopes),
                    uvec4(droplet.kind, droplet.id, droplet.water_nl, droplet.weight_free));
}

virga_splash_gpu splash_of(uint slot)
{
    const uint texel = 4u * slot;
    const uvec4 a = splash_texel(texel), b = splash_texel(texel + 1u), c = splash_texel(texel + 2u),
                d = splash_texel(texel + 3u);
    return virga_splash_gpu(floats(a.xyz), uintBitsToFloat(a.w), b.x, uintBitsToFloat(b.y), uintBitsToFloat(b.z), b.w,
                            floats(c.xyz), c.w, uintBitsToFloat(d.x), d.y, d.z, d.w);
}

uvec4[4] texels_of(virga_splash_gpu splash)
{
    return uvec4[4](
        texel_of(splash.position, splash.share),
        uvec4(splash.tick, floatBitsToUint(splash.diameter_m), floatBitsToUint(splash.speed_m_s), splash.depth_weight),
        texel_of(splash.normal, splash.random),
        uvec4(floatBitsToUint(splash.life_s), splash.lean, splash.kind, splash.id));
}
