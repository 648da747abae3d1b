// cloth.glsl - thin cloth: a part of the light that falls on one side comes out of the other, as diffuse as what comes
// back (a Lambert surface on both sides, as KHR_materials_diffuse_transmission of glTF has it).
//
// Wet cloth. Two streams of diffuse light go through a layer in which a part S of each is scattered back and a part K
// absorbed per unit of thickness X (Kubelka and Munk 1931; Kubelka 1948, New contributions to the optics of intensely
// light-scattering materials, quoted from memory). With a = 1 + K / S, b = sqrt(a^2 - 1) and y = b S X
//     R = sinh y / (a sinh y + b cosh y),    T = b / (a sinh y + b cosh y).
// R and T of dry cloth give S X and K X: from the two, R / T = sinh y / b, and 1 + R^2 - T^2 = 2 a R, as
// (a sinh + b cosh)^2 + sinh^2 - b^2 = 2 a sinh (a sinh + b cosh), where cosh^2 = 1 + sinh^2 and b^2 = a^2 - 1.
// Water between fibres has nearly their index of refraction, so they scatter less and absorb as before: it comes
// through more and comes back less. What is left of S is our estimate: fibres wholly in water would have a seventh of
// it, but threads keep air inside.
const float CLOTH_WET_SCATTERS = 0.5;

struct Cloth {
    vec3 back, through; // shares of the light: on the side that it came from, and on the other
};

// `base`: what is not absorbed of dry cloth; `passes`: the part of that which comes through, above 0; `damp`: [0; 1].
Cloth cloth_of(vec3 base, float passes, float damp)
{
    const vec3 whole = clamp(base, 0.002, 0.995), r = whole * (1.0 - min(passes, 0.99)), t = whole - r;
    const vec3 a = (1.0 + r * r - t * t) / (2.0 * r), b = sqrt(max(a * a - 1.0, 1e-6));
    const vec3 scatters = asinh(b * r / t) / b, absorbs = (a - 1.0) * scatters;
    const vec3 wet = scatters * mix(1.0, CLOTH_WET_SCATTERS, damp);
    const vec3 a_wet = 1.0 + absorbs / wet, b_wet = sqrt(max(a_wet * a_wet - 1.0, 1e-6)), y = b_wet * wet;
    const vec3 sum = a_wet * sinh(y) + b_wet * cosh(y);
    return Cloth(sinh(y) / sum, b_wet / sum);
}
