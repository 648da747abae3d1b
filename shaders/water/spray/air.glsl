// air.glsl - a drop of water in air at 20 C: drag, and when it breaks.
#define WATER_DENSITY 998.2    // kg/m^3
#define AIR_DENSITY 1.204      // kg/m^3
#define AIR_VISCOSITY 1.813e-5 // Pa s
#define SURFACE_TENSION 0.0728 // N/m

// Deceleration of a drop over its speed (1/s): 3/4 C_d rho_air / rho_water speed / diameter, from the balance of the
// drag C_d rho_air speed^2 / 2 on its cross section and the inertia of the ball. C_d = (0.55 + 4.8 / sqrt(Re))^2, as
// for the droplets of splashes (Mizukami et al.).
float drag_rate(float speed, float diameter)
{
    const float reynolds = max(AIR_DENSITY / AIR_VISCOSITY * speed * diameter, 1e-6);
    const float root = 0.55 + 4.8 * inversesqrt(reynolds);
    return 0.75 * AIR_DENSITY / WATER_DENSITY * root * root * speed / diameter;
}

// A drop breaks in an air stream where the Weber number exceeds 12, and takes about five times D / U sqrt(rho_water /
// rho_air) for it (Pilch and Erdman 1987). 1 / that time (1/s); 0 for a drop that stays whole.
float break_rate(float speed, float diameter)
{
    const float weber = AIR_DENSITY * speed * speed * diameter / SURFACE_TENSION;
    return weber > 12.0 ? 0.2 * speed / diameter * sqrt(AIR_DENSITY / WATER_DENSITY) : 0.0;
}

// The largest drop that motions of this speed within the water leave whole (m): the Weber number with the water's own
// density is 12 (Hinze 1955).
float whole_diameter(float speed)
{
    return 12.0 * SURFACE_TENSION / (WATER_DENSITY * max(speed * speed, 1e-12));
}
