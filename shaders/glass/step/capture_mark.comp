// capture_mark.comp - drops whose bases touch flow together, not only those that come to one cell: a drop is often
// wider than that. The heavier takes the lighter in. Who lies still and has not changed touches nobody whom it has not
// touched before, so those look around that run, and those that landed, took water in or stopped.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#define FEW
#include "live.glsl"

#define RUN_TOUCH 0.9 // of the sum of both radii: rims of those in motion flow into each other a little after they meet
#define MOST_REACH 8.0 // cells
#define YOUNG_S 0.5 // what a slow runner left behind within this time still lies at its rear

bool runs(uint kind) { return (kind & VIRGA_GLASS_RUNNING) != 0u; }

// Where a drop is: one that runs is drawn on its way to where it is by now.
vec2 middle_of(uint place)
{
    return runs(drops[place].kind) ? cell_middle(drops[place].cell) : to_vec2(drops[place].position);
}

void meet(uint place, uint water, vec2 middle, float a, bool running, uint other)
{
    const uint others = drops[other].water_nl;
    const bool lighter = others < water || (others == water && other > place);
    const bool young_tail = (drops[other].kind & VIRGA_GLASS_TAIL) != 0u && drops[other].age_s < YOUNG_S;
    const float touch = running || runs(drops[other].kind) ? min(RUN_TOUCH, tick.touch) : tick.touch;
    if (length(middle_of(other) - middle) >= touch * (a + base_radius(others)) || (!running && young_tail))
        return;
    if (lighter)
        atomicMin(drops[other].captor, place);
    else if (!running)
        atomicMin(drops[place].captor, other);
}

void main()
{
    const uint place = awake_place();
    if (place == NOWHERE)
        return;
    const uint kind = drops[place].kind;
    if ((kind & VIRGA_GLASS_KIND) != VIRGA_GLASS_DROP || (kind & (VIRGA_GLASS_RUNNING | VIRGA_GLASS_LOOKS)) == 0u)
        return;
    const uint water = drops[place].water_nl;
    const float a = base_radius(water), widest = runs(kind) ? a : base_radius(state.most_nl);
    const vec2 middle = middle_of(place);
    // A drop's middle may lie beside its cell, as far as mergers have shifted it: half a cell, mostly.
    const float touch = runs(kind) ? min(RUN_TOUCH, tick.touch) : tick.touch;
    const int reach = int(min(ceil(touch * (a + widest) / tick.pane.cell_m + (runs(kind) ? 0.0 : 0.5)), MOST_REACH));
    const ivec2 here = cell_at(middle), last = ivec2(tick.pane.columns, tick.pane.rows) - 1;
    const ivec2 from = max(here - reach, ivec2(0)), to = min(here + reach, last);
    for (int y = from.y; y <= to.y; y++)
        for (int x = from.x; x <= to.x; x++) {
            const uint other = occupants[cell_number(ivec2(x, y))];
            if (other != 0u && other != place + 1u)
                meet(place, water, middle, a, runs(kind), other - 1u);
        }
}
