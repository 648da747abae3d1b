// vapour.glsl - how fast vapour condenses on a cell of a pane, or fog evaporates. Include it after pane.glsl.

// Vapour (kg/m^3) of air over water of this temperature. Magnus' formula gives its pressure, with the coefficients of
// the World Meteorological Organization (2008, Guide to Meteorological Instruments, annex 4.B); the law of gases its
// density, with 461.5 J/(kg K). Where the air has more than the glass's, its dew point is above the glass.
float saturated_vapour(float celsius)
{
    const float pascal = 611.2 * exp(17.62 * celsius / (243.12 + celsius));
    return pascal / (461.5 * (celsius + 273.15));
}

// Temperature of the glass: a heater adds its mean and the waves of its wires (engine/glass/glass_fog.c).
float glass_celsius(float v_m)
{
    float celsius = tick.glass_c + tick.heat_k[0];
    if (tick.heat_wave > 0.0)
        for (uint i = 1u; i < VIRGA_GLASS_HEAT_WAVES; i++)
            celsius += tick.heat_k[i] * cos(float(i) * (tick.heat_wave * v_m + tick.heat_phase));
    return celsius;
}

// Picolitres that condense on a cell around a point since its last turn; negative: that evaporate, if they are there.
//
// The flux of vapour to the glass is h_m (rho_air - rho_sat(glass)). The boundary layer, some millimetres thick, is
// much thicker than droplets are apart, so it does not see single droplets, and the flux is the same on all of them
// together whatever they cover, as long as there are any. h_m follows from the coefficient of heat by Lewis' analogy
// (engine/glass/glass_fog.c). Breath mixes with the air before the glass, and its jet adds to the coefficient.
float condensing_pl(vec2 point)
{
    const float at_glass = saturated_vapour(glass_celsius(point.y));
    float sum = tick.fog_pl * (tick.air_vapour - at_glass);
    for (uint i = 0u; i < tick.breath_count; i++) {
        const vec2 offset = point - to_vec2(tick.breaths[i].middle);
        const float share = tick.breaths[i].share * exp(-dot(offset, offset) * tick.breaths[i].inv_radius2);
        const float before_glass = mix(tick.air_vapour, tick.breath_vapour, share);
        const float more = (tick.fog_pl + tick.breath_pl * share) * (before_glass - at_glass) -
                           tick.fog_pl * (tick.air_vapour - at_glass);
        sum += tick.breaths[i].lasts * more;
    }
    return sum;
}
