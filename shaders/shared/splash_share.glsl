// splash_share.glsl - how much of a drop flies up, and in how many droplets: ground takes off what splash gives away.

// Secondary droplets and their mass after Bai, Rusche and Gosman 2002 ("Modeling of gasoline spray impingement"): from
// a drop of Weber number We = rho |v|^2 D / sigma on a wet wall come N = 5 (We / We_c - 1), We_c = 1320 La^-0.18 with
// La = rho sigma D / mu^2; on a dry one We_c = 2634 La^-0.18.
float splash_excess(float diameter_m, float speed_m_s, bool wet)
{
    const float weber = 998.2 * speed_m_s * speed_m_s * diameter_m / 0.0728;
    const float laplace = 998.2 * 0.0728 * diameter_m / (1.002e-3 * 1.002e-3);
    return max(weber / ((wet ? 1320.0 : 2634.0) * pow(laplace, -0.18)) - 1.0, 0.0);
}

// Share of the drop's water that flies up. They have a random share of 0.2 to 1.1 on a wet wall, whatever We is; ours
// goes to none at the onset, as 1 - We_c / We, and takes no water from the film, so that a droplet's water is its
// drop's.
float splash_share(virga_splash_rule_gpu rule, uint mode, float diameter_m, float speed_m_s, bool wet, uint hash)
{
    const float chance = mix(rule.share[0], rule.share[1], virga_unit(hash));
    if (mode == VIRGA_SPLASH_PAPER)
        return chance;
    const float excess = splash_excess(diameter_m, speed_m_s, wet);
    return min((0.2 + 0.8 * virga_unit(hash)) * excess / (1.0 + excess), 0.9) * min(rule.strength, 1.0);
}
