// glow.glsl - the light of a lamp that the rain's haze scatters towards the camera.
//
// Half of what haze takes out of a ray is light that diffraction bends by less than half a degree; it stays in the
// lamp's own picture. The other half meets drops, which spread it by their phase function p. Along a ray that passes a
// lamp of intensity I at a distance h, by light that is bent there by the angle a,
//
//     L = int (k / 2) (I / r^2) p(a) ds      with   r = h / sin a,   s = -h / tan a,   ds / r^2 = da / h
//       = (k / 2) (I / h) (F(a1) - F(a0))    where  F(a) = int_0^a p,
//
// with a0 at the camera, or where haze begins, and a1 where the ray ends. A lamp's glow is that of the haze around it,
// so k is the extinction there, and what the lamp loses on its way to the camera the glow loses too.

// F, read linearly from its values at the borders of the phase function's bins.
float bent_up_to(float angle)
{
    const float place = clamp(angle * (float(VIRGA_RAIN_BENT - 1) / 3.14159265), 0.0, float(VIRGA_RAIN_BENT - 1));
    const uint bin = min(uint(place), uint(VIRGA_RAIN_BENT - 2));
    return mix(look.bent[bin], look.bent[bin + 1u], place - float(bin));
}

// A ray past a lamp.
struct Pass {
    float along;   // m from the camera to where it comes nearest to the lamp
    float nearest; // m that it is away there
    vec3 aside;    // from the lamp to there
};

Pass pass_of(vec3 lamp, vec3 direction, float pixel_angle)
{
    Pass pass;
    pass.along = dot(lamp, direction);
    pass.aside = direction * pass.along - lamp;
    const float pixel = 0.5 * pixel_angle * pass.along;
    pass.nearest = sqrt(dot(pass.aside, pass.aside) + LAMP_RADIUS_M * LAMP_RADIUS_M + pixel * pixel);
    return pass;
}
