// blocks.glsl - the list of blocks of cells that have ground: passes over ground run on these alone. It lies behind the
// floors, which change where it does: a stage sees no more buffers than there are. Include cells.glsl before.
layout(scalar, set = 0, binding = 3) buffer FloorWords { uint floor_words[]; };

uint block_count() { return tick.tiles * tick.tiles * (VIRGA_GROUND_TILE_CELLS / VIRGA_GROUND_BLOCK); }

// Index of a word of the head, and of what is behind it. A floor has two words.
uint block_word(uint word) { return 2u * block_count() * VIRGA_GROUND_BLOCK + word; }

uint mark_word(uint block) { return block_word(VIRGA_GROUND_BLOCK_MARKS) + block; }

uint list_word(uint entry) { return mark_word(block_count() + entry); }
