// flood.glsl - what simulated water does on cells (VIRGA_GLASS_DRY and so on). Include it after pane.glsl.
//
// A pane that takes water has a word for each cell behind its occupants, and behind those a flag for each block of
// cells: 1 where a word may not be 0.

uint flood_word(uint cell) { return cell_count() + cell; }
uint flood_flag(uint block) { return 2u * cell_count() + block; }
uint flood_phase(uint word) { return word >> VIRGA_GLASS_PHASE; }

// Whether simulated water stands against the pane there. What comes to such a cell joins it.
bool is_under_water(uint cell)
{
    return tick.flooded != 0u && flood_phase(occupants[flood_word(cell)]) >= VIRGA_GLASS_UNDER;
}
