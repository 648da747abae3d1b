// contacts.glsl - wheels and feet in a tick: which cells are near them, and which they stand on. Include cells.glsl
// before.

// A number below tick.contacts[tick.contact_count - 1].end, as a contact and a cell near it.
struct Near {
    uint contact;
    ivec2 cell;
    uint cell_index; // NO_CELL: no ground
};

uint contact_cells() { return tick.contact_count > 0u ? tick.contacts[tick.contact_count - 1u].end : 0u; }

Near near_of(uint number)
{
    Near near;
    near.contact = 0u;
    while (number >= tick.contacts[near.contact].end)
        near.contact++;
    const uint first = near.contact > 0u ? tick.contacts[near.contact - 1u].end : 0u;
    const uint width = tick.contacts[near.contact].width, inside = number - first;
    near.cell = ivec2(tick.contacts[near.contact].low[0], tick.contacts[near.contact].low[1]) +
                ivec2(inside % width, inside / width);
    const uint cell_index = index_of_cell(near.cell);
    near.cell_index = is_ground(cell_index) ? cell_index : NO_CELL;
    return near;
}

// The middle of a cell, from the window's low corner.
vec2 middle_of(ivec2 cell)
{
    return (vec2(cell - ivec2(tick.low_tile[0], tick.low_tile[1]) * VIRGA_GROUND_TILE) + 0.5) * tick.cell_m;
}

vec2 ahead_of(uint contact) { return vec2(tick.contacts[contact].ahead[0], tick.contacts[contact].ahead[1]); }

// Along and across, from the middle of the patch at the end of the tick; and the other way.
vec2 in_contact(uint contact, vec2 at)
{
    const vec2 ahead = ahead_of(contact);
    precise vec2 d = at - vec2(tick.contacts[contact].middle[0], tick.contacts[contact].middle[1]);
    precise float along = d.x * ahead.x + d.y * ahead.y, across = d.y * ahead.x - d.x * ahead.y;
    return vec2(along, across);
}

vec2 out_of_contact(uint contact, vec2 at)
{
    const vec2 ahead = ahead_of(contact);
    return vec2(tick.contacts[contact].middle[0], tick.contacts[contact].middle[1]) + at.x * ahead +
           at.y * vec2(-ahead.y, ahead.x);
}

// Whether the patch was over a position in the tick.
bool covers(uint contact, vec2 at)
{
    const vec2 half_m = vec2(tick.contacts[contact].half_m[0], tick.contacts[contact].half_m[1]);
    return abs(at.y) <= half_m.y && at.x <= half_m.x && at.x > -half_m.x - tick.contacts[contact].swept_m;
}
