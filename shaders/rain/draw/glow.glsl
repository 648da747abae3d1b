// glow.glsl - the light of a lamp that haze scatters towards the camera.
//
// Haze of k per metre is the light that hits drops (see haze.frag), which spread it by their phase function p. Along a
// ray that passes a lamp of intensity I at the distance h, light is scattered by the angle a, which gives
//
//     L = int k (I / r^2) p(a) ds      with   r = h / sin a,   s = -h / tan a,   ds / r^2 = da / h
//       = k (I / h) (F(a1) - F(a0))    where  F(a) = int_0^a p,
//
// with a0 at the camera, or where haze begins, and a1 at the end of the ray. A lamp's glow comes from the haze around
// it, so k is the extinction there, and the glow is attenuated on the way to the camera as the lamp is.

// F: linear between its values at the borders of the phase function's bins.
float scattered_below(float angle)
{
    const float bin_position =
        clamp(angle * (float(VIRGA_RAIN_BENT - 1) / 3.14159265), 0.0, float(VIRGA_RAIN_BENT - 1));
    const uint bin = min(uint(bin_position), uint(VIRGA_RAIN_BENT - 2));
    return mix(look.bent[bin], look.bent[bin + 1u], bin_position - float(bin));
}

// Where a ray comes closest to a lamp.
struct Closest {
    float along;   // m from the camera to that point
    float nearest; // distance from the lamp there, m
    vec3 aside;    // from the lamp to that point
};

Closest closest_to_lamp(vec3 lamp, vec3 direction, float pixel_angle)
{
    Closest closest;
    closest.along = dot(lamp, direction);
    closest.aside = direction * closest.along - lamp;
    const float pixel = 0.5 * pixel_angle * closest.along;
    closest.nearest = sqrt(dot(closest.aside, closest.aside) + LAMP_RADIUS_M * LAMP_RADIUS_M + pixel * pixel);
    return closest;
}
