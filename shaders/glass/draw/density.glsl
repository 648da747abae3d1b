// density.glsl - density functions and their inverses. They are functions of x^2, the square of distance / radius of
// the ball, scaled so that each is 0.5 at x = 1. All but one need only x^2.

// The density function, and whether Chen and Zhang's weights are used, are constants of the pipeline, because software
// Vulkan runs all sides of a branch.
#ifdef DENSITY_SPECIAL
layout(constant_id = 0) const uint MODE = 0u;
#define DENSITY (MODE & 7u)
#define WEIGHTED ((MODE & 8u) != 0u)
#define FILM ((MODE & 16u) != 0u)       // for tiles with film
#define WITH_BEADS ((MODE & 64u) != 0u) // some film is in beads that have a shape
#define WITH_MAP ((MODE & 32u) != 0u)   // the host reads the map
#define PAPER ((MODE & 128u) != 0u)     // the paper's style, which shows densities only
#define HEIGHTS ((MODE & 160u) != 128u) // heights are needed: not the paper's style, or the host reads the map
#define MASKED ((MODE & 512u) != 0u)    // (paper) there may be cells without glass
#define PINNED ((MODE & 1024u) != 0u)    // outlines are uneven
#define USUAL_STEPS ((MODE & 256u) != 0u) // at most VIRGA_GLASS_USUAL_STEPS steps of compression
#else
#define DENSITY look.density
#endif

// Where each function ends, in radii. Murakami's is 0.5 at 1 - 1 / sqrt(3) of its own radius of influence, Wyvill's at
// sqrt(1 - sqrt(1/2)), Nishimura's at 1/2.
float density_reach()
{
    return DENSITY == DENSITY_MURAKAMI    ? 2.3660254
           : DENSITY == DENSITY_WYVILL    ? 1.8477591
           : DENSITY == DENSITY_NISHIMURA ? 2.0
                                          : 2.0;
}

// Window: 1 up to two thirds of the reach, then smoothly to 0. Without it the end of a function would show as an edge
// on neighbouring drops.
float density_window(float x2, float reach)
{
    const float t = clamp((x2 / (reach * reach) - 4.0 / 9.0) * (9.0 / 5.0), 0.0, 1.0);
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

float density_at(float x2, float reach)
{
    const float y2 = x2 / (reach * reach); // distance / radius of influence, squared
    if (y2 >= 1.0)
        return 0.0;
    if (DENSITY == DENSITY_GOTO)
        return density_window(x2, reach) / (1.0 + x2 * x2); // Goto et al. 2009, equation 1
    if (DENSITY == DENSITY_BLINN)
        return density_window(x2, reach) * exp2(-x2); // Chen and Zhang, equation 2 with a = ln 2 / R^2
    if (DENSITY == DENSITY_MURAKAMI) {
        const float y = sqrt(y2);
        return y < 1.0 / 3.0 ? 1.0 - 3.0 * y2 : 1.5 * (1.0 - y) * (1.0 - y); // equation 3
    }
    if (DENSITY == DENSITY_WYVILL)
        return (1.0 - y2) * (1.0 - y2);                                   // equation 4
    return 1.0 + y2 * (-22.0 / 9.0 + y2 * (17.0 / 9.0 - 4.0 / 9.0 * y2)); // equation 5 with its missing term
}

// The inverse: x^2 at which a single ball has the density v; 0 for v > 1.
float density_inverse(float v)
{
    v = clamp(v, 1e-4, 1.0);
    if (DENSITY == DENSITY_GOTO)
        return sqrt(1.0 / v - 1.0);
    if (DENSITY == DENSITY_BLINN)
        return -log2(v);
    const float reach = density_reach(), reach2 = reach * reach;
    if (DENSITY == DENSITY_MURAKAMI) {
        const float y = 1.0 - sqrt(v * (2.0 / 3.0));
        return reach2 * (v > 2.0 / 3.0 ? (1.0 - v) / 3.0 : y * y);
    }
    if (DENSITY == DENSITY_WYVILL)
        return reach2 * (1.0 - sqrt(v));
    // Newton's method for the root of the cubic. It starts on the line through the middle and the edge, where the line
    // is exact.
    float y2 = 0.5 * (1.0 - v);
    for (int i = 0; i < 4; i++) {
        const float f = 1.0 - v + y2 * (-22.0 / 9.0 + y2 * (17.0 / 9.0 - 4.0 / 9.0 * y2));
        const float slope = -22.0 / 9.0 + y2 * (34.0 / 9.0 - 12.0 / 9.0 * y2);
        y2 = clamp(y2 - f / min(slope, -0.05), 0.0, 1.0);
    }
    return reach2 * y2;
}

#ifdef DENSITY_SPECIAL
#include "gpu/variants.glsl"

// Compression: Goto et al. 2009, equation 2, repeated with a rising V0. The loop has a constant length; Texel in
// height.glsl says why.
#define MAX_STEPS (USUAL_STEPS ? VIRGA_GLASS_USUAL_STEPS : 16u)
float compressed(float v)
{
    const uint steps = look.compress_steps;
    const float step_up = look.compress_step, share = 1.0 - look.compress_k;
    float from = look.compress_from;
    if (FOR_GPU && v <= from)
        return v; // V0 only rises, so no step changes it: so it is with most texels
    for (uint i = 0u; i < MAX_STEPS; i++) {
        v -= (i < steps ? share : 0.0) * max(v - from, 0.0);
        from += step_up;
    }
    return v;
}
#endif
