// fresnel.glsl - how much of the light the surface mirrors.
#define WATER 1.333

// Fresnel's equations for unpolarised light, from air into water.
float fresnel(float cos_air, float cos_water)
{
    const float s = (cos_air - WATER * cos_water) / (cos_air + WATER * cos_water);
    const float p = (cos_water - WATER * cos_air) / (cos_water + WATER * cos_air);
    return 0.5 * (s * s + p * p);
}
