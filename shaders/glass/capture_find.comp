// capture_find.comp - a drop that runs takes in the lighter ones that its base touches, not only those whose cell it
// enters: a drop is often wider than a cell.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "alive.glsl"

#define TOUCH 0.9 // of the sum of both radii: rims flow into each other a little after they meet

void main()
{
    const uint place = awake_place();
    if (place == NOWHERE)
        return;
    const virga_glass_drop_gpu drop = drops[place];
    if (kind_of(drop) != VIRGA_GLASS_DROP || (drop.kind & VIRGA_GLASS_RUNNING) == 0u)
        return;
    const float a = base_radius(drop.water_nl);
    const vec2 middle = cell_middle(drop.cell);
    const int reach = int(min(ceil(TOUCH * 2.0 * a / tick.pane.cell_m), 8.0)); // the other is no larger
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            const ivec2 cell = cell_place(drop.cell) + ivec2(x, y);
            if (!on_pane(cell))
                continue;
            const uint other = occupants[cell_number(cell)];
            if (other == 0u || other == place + 1u)
                continue;
            const uint water = drops[other - 1u].water_nl;
            const bool lighter = water < drop.water_nl || (water == drop.water_nl && other - 1u > place);
            if (lighter && length(cell_middle(cell_number(cell)) - middle) < TOUCH * (a + base_radius(water)))
                atomicMin(drops[other - 1u].captor, place);
        }
}
