// splash_share.glsl - how much of a drop's water flies up, and in how many droplets. Ground subtracts the water that
// splash adds to droplets.

// Secondary droplets and their mass after Bai, Rusche and Gosman 2002 ("Modeling of gasoline spray impingement"). A
// drop of Weber number We = rho |v|^2 D / sigma makes N = 5 (We / We_c - 1) droplets on a wet wall, with We_c = 1320
// La^-0.18 and La = rho sigma D / mu^2. On a dry wall We_c = 2634 La^-0.18.
//
// Returns We / We_c - 1, at least 0.
float splash_excess(float diameter_m, float speed_m_s, bool wet)
{
    const float weber = 998.2 * speed_m_s * speed_m_s * diameter_m / 0.0728;
    const float laplace = 998.2 * 0.0728 * diameter_m / (1.002e-3 * 1.002e-3);
    return max(weber / ((wet ? 1320.0 : 2634.0) * pow(laplace, -0.18)) - 1.0, 0.0);
}

// Fraction of the drop's water that flies up. In the paper it is random, 0.2 to 1.1 on a wet wall, for any We. Here it
// goes to zero at the onset, as 1 - We_c / We. No water comes from the film: all water of a droplet is that of its
// drop.
float splash_share(virga_splash_rule_gpu rule, uint mode, float diameter_m, float speed_m_s, bool wet, uint hash)
{
    const float chance = mix(rule.share[0], rule.share[1], virga_unit(hash));
    if (mode == VIRGA_SPLASH_PAPER)
        return chance;
    const float excess = splash_excess(diameter_m, speed_m_s, wet);
    return min((0.2 + 0.8 * virga_unit(hash)) * excess / (1.0 + excess), 0.9) * min(rule.strength, 1.0);
}
