// environment.glsl - what the passes of the environment read: an image of the surroundings, texel by texel or by
// direction.
#define VIRGA_GLSL
#include "shared/environment_gpu.h"
#include "shared/sh.h"
#include "shared/view_gpu.h"
#include "gpu/host_color.glsl"
#include "gpu/vectors.glsl"

#define KIND_PANORAMA 0u
#define KIND_PICTURE 2u
#define PI 3.14159265358979

layout(scalar, set = 0, binding = 0) uniform Info { virga_environment_gpu info; };
#ifdef CUBE
layout(set = 0, binding = 4) uniform samplerCube image;
#else
layout(set = 0, binding = 3) uniform sampler2D image;
#endif

void harmonics(vec3 d, out float y[9])
{
    y = float[9](VIRGA_SH_00, VIRGA_SH_1 * d.y, VIRGA_SH_1 * d.z, VIRGA_SH_1 * d.x, VIRGA_SH_2 * d.x * d.y,
                 VIRGA_SH_2 * d.y * d.z, VIRGA_SH_20 * (3.0 * d.z * d.z - 1.0), VIRGA_SH_2 * d.x * d.z,
                 VIRGA_SH_22 * (d.x * d.x - d.y * d.y));
}

vec3 rest(vec3 d)
{
    float y[9];
    vec3 sum = vec3(0.0);
    harmonics(d, y);
    for (uint i = 0u; i < 9u; i++)
        sum += y[i] * vec3(info.rest_sh[3u * i], info.rest_sh[3u * i + 1u], info.rest_sh[3u * i + 2u]);
    return max(sum, vec3(0.0));
}

vec3 light_of(vec3 stored)
{
    return info.gain * min(host_color(mix(stored, vec3(0.0), isnan(stored)), info.color_given), vec3(1e6));
}

mat3 world_from_image()
{
    const float m[9] = info.image_from_world;
    return mat3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]); // its transpose is image_from_world
}
