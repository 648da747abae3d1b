// fog_drops.glsl - which cells a drop clears of fog. Include it after pane.glsl, with live.glsl.
//
// A drop that runs, lands or grows takes the fog under its base, from where it was at the tick's start to where it is
// now. Two drops may reach for the same cell: fog_claim.comp writes the lowest slot there, and fog_take.comp gives it
// the water, so the order of invocations does not matter. Claims are free (VIRGA_GLASS_NONE) between ticks.

#define MAX_REACH 8.0 // cells

bool clears_fog(uint kind)
{
    return (kind & VIRGA_GLASS_KIND) == VIRGA_GLASS_DROP &&
           (kind & (VIRGA_GLASS_RUNNING | VIRGA_GLASS_CHANGED | VIRGA_GLASS_MERGE_CHECK)) != 0u;
}

struct Sweep {
    vec2 from, way; // m
    float radius;
    ivec2 low, high; // cells
};

Sweep sweep_of(uint slot)
{
    Sweep sweep;
    const vec2 to = to_vec2(drops[slot].position);
    sweep.from = to_vec2(drops[slot].previous_position);
    sweep.way = to - sweep.from;
    sweep.radius = min(base_radius(drops[slot].water_nl), MAX_REACH * tick.pane.cell_m);
    const ivec2 last = ivec2(tick.pane.columns, tick.pane.rows) - 1;
    sweep.low = max(cell_at(min(sweep.from, to) - sweep.radius), ivec2(0));
    sweep.high = min(cell_at(max(sweep.from, to) + sweep.radius), last);
    return sweep;
}

// Whether the base passes over the middle of a cell. Its own cell always counts.
bool is_cleared(Sweep sweep, uint slot, uint cell)
{
    const vec2 offset = (vec2(cell_coordinates(cell)) + 0.5) * tick.pane.cell_m - sweep.from;
    const float along = clamp(dot(offset, sweep.way) / max(dot(sweep.way, sweep.way), 1e-12), 0.0, 1.0);
    return length(offset - along * sweep.way) <= sweep.radius || cell == drops[slot].cell;
}
