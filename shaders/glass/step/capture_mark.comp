// capture_mark.comp - drops whose bases touch flow together, not only drops in the same cell: a drop is often wider
// than a cell. The heavier drop captures the lighter one; this pass marks each drop with its captor. A drop at rest
// that has not changed touches no new neighbour, so only running drops look around, and those that landed, merged or
// stopped.
// One invocation per active slot, or PARTS of them. Reads: drops, occupants. Writes: captors.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#define FEW
#include "live.glsl"
#include "gpu/variants.glsl"

#define RUN_TOUCH 0.9 // of the sum of both radii: moving rims merge a little after they meet
#define MAX_REACH 8.0 // cells
#define YOUNG_S 0.5   // a tail younger than this is still at the rear of the slow drop that left it

// Active slots are few, and an invocation that reads all cells around one waits for each. On a GPU PARTS invocations
// share them by columns. The captor is the lowest slot of all that capture a drop, so the order is of no matter.
const uint PARTS = FOR_GPU ? 8u : 1u;

bool is_running(uint kind) { return (kind & VIRGA_GLASS_RUNNING) != 0u; }

// Center of a drop. A running drop is drawn between its old cell and the new one; here its new cell counts.
vec2 drop_center(uint slot)
{
    return is_running(drops[slot].kind) ? cell_middle(drops[slot].cell) : to_vec2(drops[slot].position);
}

void test_pair(uint slot, uint water, vec2 middle, float radius, bool running, uint other)
{
    const uint other_water = drops[other].water_nl;
    const bool lighter = other_water < water || (other_water == water && other > slot);
    const bool young_tail = (drops[other].kind & VIRGA_GLASS_TAIL) != 0u && drops[other].age_s < YOUNG_S;
    const float touch =
        running || is_running(drops[other].kind) ? min(RUN_TOUCH, tick.merge_distance) : tick.merge_distance;
    if (length(drop_center(other) - middle) >= touch * (radius + base_radius(other_water)) || (!running && young_tail))
        return;
    if (lighter)
        atomicMin(drops[other].absorbed_by, slot);
    else if (!running)
        atomicMin(drops[slot].absorbed_by, other);
}

// Looks at every PARTS-th column of the cells around a slot's drop, from column `part` on.
void look_around(uint slot, uint part)
{
    const uint kind = drops[slot].kind;
    if ((kind & VIRGA_GLASS_KIND) != VIRGA_GLASS_DROP || (kind & (VIRGA_GLASS_RUNNING | VIRGA_GLASS_MERGE_CHECK)) == 0u)
        return;
    const uint water = drops[slot].water_nl;
    const float radius = base_radius(water), max_radius = is_running(kind) ? radius : base_radius(state.max_nl);
    const vec2 middle = drop_center(slot);
    // A drop's center may lie outside its cell, where merges have shifted it: mostly up to half a cell.
    const float touch = is_running(kind) ? min(RUN_TOUCH, tick.merge_distance) : tick.merge_distance;
    const int reach =
        int(min(ceil(touch * (radius + max_radius) / tick.pane.cell_m + (is_running(kind) ? 0.0 : 0.5)), MAX_REACH));
    const ivec2 center_cell = cell_at(middle), last = ivec2(tick.pane.columns, tick.pane.rows) - 1;
    const ivec2 from = max(center_cell - reach, ivec2(0)), to = min(center_cell + reach, last);
    for (int y = from.y; y <= to.y; y++)
        for (int x = from.x + int(part); x <= to.x; x += int(PARTS)) {
            const uint other = occupants[cell_number(ivec2(x, y))];
            if (other != 0u && other != slot + 1u)
                test_pair(slot, water, middle, radius, is_running(kind), other - 1u);
        }
}

void main()
{
    const uint count = PARTS * state.active_count, all = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += all)
        look_around(slot_of_active(i / PARTS), i % PARTS);
}
