// blade_film.glsl - the film that a blade leaves behind it, on the cells that it sweeps. One dispatch per blade, over
// the rectangle of cells around it. Include it after pane.glsl and blades.glsl.
layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant) uniform Box
{
    uint blade;
    uint low_column, low_row, columns, rows;
};

// How much more or less film than its mean a blade leaves at a position along it. Streaks are some millimetres wide and
// always at the same positions, so they are arcs.
float streak_factor(float along_m)
{
    const uint stripe = uint(int(floor(along_m / 0.003)) + 4096);
    const float random = virga_unit(virga_hash2(tick.blades[blade].random, stripe));
    return mix(1.0, random > 0.85 ? 6.0 : 0.4, tick.blades[blade].wear);
}

// Finds this invocation's cell. False: the blade does not sweep it in this tick, or there is no glass.
bool find_cell(out uint cell, out vec2 middle)
{
    cell = 0u;
    middle = vec2(0.0);
    if (gl_GlobalInvocationID.x >= columns || gl_GlobalInvocationID.y >= rows)
        return false;
    const uvec2 at = uvec2(low_column, low_row) + gl_GlobalInvocationID.xy;
    cell = cell_number(ivec2(at));
    middle = cell_middle(cell);
    return on_pane(ivec2(at)) && is_swept(blade, middle, middle, 0.0);
}

// Film (nl) that the blade leaves on a cell at a position along it.
uint left_on(uint cell, float along_m)
{
    const float nl = tick.blades[blade].film_m * streak_factor(along_m) * tick.pane.cell_m * tick.pane.cell_m * 1e12;
    return round_randomly(nl, virga_hash3(tick.blades[blade].random, tick.tick, cell));
}
