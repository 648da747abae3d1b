// fog_cells.glsl - the droplets of a cell's fog, by its amount. Include it after view.glsl.

#define FOG_COVER 0.55 // the share of the glass that droplets cover when they begin to merge (Beysens 1995)

struct Droplets {
    float cover;  // [0; 1], share of the glass
    float radius; // m, mean
};

// Fog with a mean thickness h (m), of caps that began as `dense` droplets per m^2. Alone they grow with h = dense V
// r^3, V the volume of a cap with a base of 1 m, and cover dense pi r^2. Once that is FOG_COVER, at the radius r0, they
// merge and cover no more: with r in place of their number, h = FOG_COVER V r / pi. What merging leaves bare fogs anew,
// with droplets that hold hardly any water: those larger than x cover 1 - (x / R)^(1/3) (Le Fevre and Rose 1966), so
// the bare share falls with the cube root of r.
Droplets droplets_of(float thickness_m, float dense)
{
    const float cap = look.drop_nl_of_m3 * 1e-12, alone = pow(thickness_m / (dense * cap), 1.0 / 3.0);
    const float cover = dense * 3.14159265 * alone * alone;
    if (cover < FOG_COVER)
        return Droplets(cover, alone);
    const float radius = 3.14159265 * thickness_m / (FOG_COVER * cap), first = sqrt(FOG_COVER / (dense * 3.14159265));
    return Droplets(1.0 - (1.0 - FOG_COVER) * pow(first / radius, 1.0 / 3.0), radius);
}
