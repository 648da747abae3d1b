// begin.comp - begins a substep: its time, the grid, and the sizes of its passes. After the step's time is over all of
// them are 0.
// One invocation. Reads and writes: state. Writes: the grid's state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#define STATE_ACCESS
#include "fluid.glsl"

layout(local_size_x = 1) in;

uint[3] groups(bool on, uint items, uint each) { return uint[3](on ? (items + each - 1u) / each : 0u, 1u, 1u); }

// Nothing may move farther than cfl spacings (the condition of Courant, Friedrichs and Lewy, as in Bender and Koschier
// 2015). Water at rest counts as moving with what gravity gives to a particle that falls a spacing: with cfl = 0.4 a
// substep is then 0.28 sqrt(d / g), where Monaghan (1992, Smoothed Particle Hydrodynamics) has 0.25 sqrt(h / f) for a
// force f. Pressure asks for no shorter ones, as it is solved for.
//
// Bodies do. Impulses stop them at walls one after the other, and what gravity gives to a body in a long substep makes
// it rock. The rest of the step is divided evenly, and the last of max_substeps takes whatever is left.
float substep_time()
{
    const float moving = max(sqrt(uintBitsToFloat(state.max_speed2)), frame.body_speed_m_s);
    const float falling2 = 2.0 * length(to_vec(frame.gravity_m_s2)) * frame.spacing_m;
    const float speed = frame.bodies > 0u ? moving + sqrt(10.0 * falling2) : max(moving, sqrt(falling2));
    const uint left = frame.max_substeps - min(state.substeps, frame.max_substeps - 1u);
    const float wanted = state.time_left_s * speed * frame.inv_spacing_m / frame.cfl;
    return state.time_left_s / clamp(ceil(wanted), 1.0, float(left));
}

void main()
{
    const bool on = state.time_left_s > 0.0 && state.substeps < frame.max_substeps;
    const float dt = on ? substep_time() : 0.0;
    const uint cells = on ? frame.dims[0] * frame.dims[1] * frame.dims[2] : 0u;
    const bool last = state.substeps + 1u >= frame.max_substeps || dt > 0.999 * state.time_left_s;
    state.dt_s = dt;
    state.time_left_s = last ? 0.0 : state.time_left_s - dt;
    state.substeps += on ? 1u : 0u;
    if (on)
        state.max_speed2 = state.moved = 0u;
    state.slot_groups = groups(on, frame.particles, VIRGA_FLUID_LANES);
    state.fluid_groups = state.loop_groups = groups(false, 0u, 1u); // see copy.comp
    state.body_groups = groups(on, frame.bodies, 1u);
    state.loop_body_groups = groups(false, 0u, 1u);
    grid.first = frame.first_cell;
    grid.dims = frame.dims;
    grid.cells = cells;
    grid.scan_groups = groups(on, cells, VIRGA_GRID_SCAN_CELLS);
    grid.cell_groups = groups(on, cells, VIRGA_GRID_LANES);
    grid.sorted = 0u;
    grid.sorted_groups = groups(false, 0u, 1u);
}
