// flight.glsl - a droplet in the air: drag, gravity and wind.
//
// Mizukami et al., equations 2 to 5, with u = V - wind, the velocity relative to the air: F = Cd rho_a |u|^2 S / 2
// against u,  Cd = (0.55 + 4.8 / sqrt(Re))^2,  Re = |u| d rho_a / mu,  S = pi d^2 / 4, so dV/dt = -k u - g with, as m =
// rho_w pi d^3 / 6, k = Cd rho_a S |u| / (2 m) = 3 rho_a / (4 rho_w d) (0.55 sqrt|u| + 4.8 sqrt(mu / (rho_a d)))^2.
// (Their equation 5 loses one |V| of equation 2; equation 2 is meant.) The last form does not divide by |u|.
//
// Their equations 6 and 7 advance V by a dt. A droplet of 0.1 mm has k = 40 1/s when it falls at rest relative to the
// air, and at 60 ticks a second that is wrong by a third. With a constant k the law is linear and its exact solution an
// exponential (their equation 1). So a step covers half of its time with the k at its start, and then all of it with
// the k found in the middle. This is of second order, and stable for any k. The difference between one whole and two
// half steps gives a further correction of a third of it (Richardson 1911). With four steps in a tick of 1/60 s, the
// error is 2e-4 of a droplet's path, in a storm too; without the correction it is 2e-2.

#define WATER_DENSITY 998.2
#define AIR_VISCOSITY 1.813e-5

float drag_rate(float diameter_m, float against_air)
{
    const float law = 0.55 * sqrt(against_air) + 4.8 * sqrt(AIR_VISCOSITY / (tick.air_density * diameter_m));
    return 0.75 * tick.air_density / (WATER_DENSITY * diameter_m) * law * law;
}

// Moves for `time_s` with a constant k: towards the speed at which drag balances gravity.
void fly_linear(inout vec3 position, inout vec3 velocity, vec3 wind, float k, float time_s)
{
    const vec3 rest = wind - vec3(0.0, GRAVITY / k, 0.0);
    // 1 - exp(-k t); for small k t that difference would lose its digits.
    const float x = k * time_s;
    const float gone = x < 0.02 ? x * (1.0 - x * (0.5 - x * (1.0 / 6.0))) : 1.0 - exp(-x);
    position += rest * time_s + (velocity - rest) * (gone / k);
    velocity += (rest - velocity) * gone;
}

void fly_once(inout vec3 position, inout vec3 velocity, vec3 wind, float diameter_m, float time_s)
{
    vec3 middle_position = position, middle = velocity;
    fly_linear(middle_position, middle, wind, drag_rate(diameter_m, distance(velocity, wind)), 0.5 * time_s);
    fly_linear(position, velocity, wind, drag_rate(diameter_m, distance(middle, wind)), time_s);
}

void fly(inout vec3 position, inout vec3 velocity, vec3 wind, float diameter_m, float time_s)
{
    vec3 coarse_position = position, coarse = velocity;
    fly_once(coarse_position, coarse, wind, diameter_m, time_s);
    fly_once(position, velocity, wind, diameter_m, 0.5 * time_s);
    fly_once(position, velocity, wind, diameter_m, 0.5 * time_s);
    position += (position - coarse_position) * (1.0 / 3.0);
    velocity += (velocity - coarse) * (1.0 / 3.0);
}
