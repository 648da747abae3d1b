// enter_cell.glsl - round of movement, second half, for one drop: it enters the cell that it claimed, or merges.

// For an entry of the active list.
void enter_cell(uint entry)
{
    const uint slot = slot_of_active(entry);
    const uint old_target = drops[slot].absorbed_by;
    if (old_target < OUTSIDE && (drops[slot].kind & VIRGA_GLASS_KIND) != VIRGA_GLASS_PARTICLE)
        claims[claim_of(old_target, round_index + 1u)] = NONE;
    const uint target = drops[slot].target;
    if (target >= OUTSIDE || (drops[slot].kind & VIRGA_GLASS_KIND) != VIRGA_GLASS_DROP)
        return;
    passed[drops[slot].cell] = wetted_now(); // several invocations may write the same value
    passed[target] = wetted_now();
    const uint occupant = occupants[target];
    const bool occupied = occupant != 0u && drops[occupant - 1u].target == NONE;
    const uint first = claims[claim_of(target, round_index)];
    if (!occupied && first == slot) {
        drops[slot].from_cell = drops[slot].cell;
        drops[slot].cell = target;
        return;
    }
    transfer_water(occupied ? occupant - 1u : first, drops[slot]);
    clear_slot(slot);
    count(VIRGA_GLASS_MERGED, 1u);
}
