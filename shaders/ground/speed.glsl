// speed.glsl - how fast the water of a cell runs, and where to. Include cells.glsl and flow_average.glsl before.
//
// Manning's speed h^(2/3) sqrt(S) / n through each side of the cell, as flow.comp moves it: h is what runs in the upper
// one of two cells, above what its roughness holds back, S the slope from one surface to the other. The mean of the two
// sides along an axis is the cell's speed along it.
#define FASTEST_M_S 3.0

struct Runner {
    int height_um, free_nl;
    uint material;
};

// Without the oscillation of pairs, see flow_average.glsl. A cell that is no ground is a wall: nothing runs there.
Runner runner_at(uint cell_index)
{
    const virga_floor_gpu own = floor_of(cell_index == NO_CELL ? 0u : cell_index);
    const uint found = cell_index == NO_CELL ? 0u : cell_index;
    const int free_nl = int(min(cell_of(found).free_nl, uint(MAX_STEP_NL))) - swing_um(swings[found]) * tick.nl_per_um;
    return Runner(own.height_um, max(free_nl, 0), cell_index == NO_CELL ? NO_GROUND : own.material);
}

// Depth (m) of what runs.
float running_m(Runner r)
{
    const uint material = min(r.material, uint(VIRGA_GROUND_MATERIALS - 1));
    return float(max(r.free_nl - int(min(tick.soils[material].retention_nl, uint(MAX_STEP_NL))), 0)) * tick.m_per_nl;
}

// From the first to the second.
float speed_between(Runner a, Runner b)
{
    if (a.material == NO_GROUND || b.material == NO_GROUND)
        return 0.0;
    const int max_um = MAX_STEP_NL / tick.nl_per_um;
    const int difference =
        clamp(a.height_um - b.height_um, -max_um, max_um) * tick.nl_per_um + a.free_nl - b.free_nl;
    Runner upper = b;
    if (difference > 0)
        upper = a;
    const float slope = abs(float(difference)) * tick.m_per_nl * tick.inv_cell_m, h = running_m(upper);
    const float manning = tick.soils[min(upper.material, uint(VIRGA_GROUND_MATERIALS - 1))].inv_manning;
    const float speed = h > 0.0 ? manning * pow(h, 2.0 / 3.0) * sqrt(slope) : 0.0;
    return difference > 0 ? speed : -speed;
}

// m/s along x and z, and the depth (m) of what runs there.
vec2 speed_at(ivec2 cell, out float depth_m, out uint material)
{
    const Runner own = runner_at(index_of_cell(cell));
    depth_m = own.material == NO_GROUND ? 0.0 : running_m(own);
    material = own.material;
    vec2 speed;
    for (int axis = 0; axis < 2; axis++) {
        const ivec2 aside = axis == 0 ? ivec2(1, 0) : ivec2(0, 1);
        const Runner low = runner_at(index_of_cell(cell - aside)), high = runner_at(index_of_cell(cell + aside));
        speed[axis] = 0.5 * (speed_between(low, own) + speed_between(own, high));
    }
    const float size = length(speed);
    return depth_m > 0.0 ? speed * min(1.0, FASTEST_M_S / max(size, FASTEST_M_S)) : vec2(0.0);
}

// The surface is faster than the mean over the depth, which is 0.85 of it: the coefficient with which hydrologists
// gauge streams by floats (Rantz 1982, Measurement and computation of streamflow, USGS Water-Supply Paper 2175).
#define MEAN_SHARE 0.85
