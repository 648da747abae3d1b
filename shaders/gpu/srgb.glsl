// srgb.glsl - the curve of sRGB, IEC 61966-2-1, and its inverse. Above 1 the curve goes on.
#ifndef SRGB_GLSL
#define SRGB_GLSL
vec3 srgb_encoded(vec3 light)
{
    return mix(12.92 * light, 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, greaterThan(light, vec3(0.0031308)));
}

vec3 srgb_decoded(vec3 value)
{
    return mix(value / 12.92, pow((value + 0.055) / 1.055, vec3(2.4)), greaterThan(value, vec3(0.04045)));
}
#endif
