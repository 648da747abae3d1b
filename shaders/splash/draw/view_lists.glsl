// view_lists.glsl - the two lists of a view, sprites and sheets: which words of the selection belong to each, and where
// their entries are.
struct WordRange {
    uint first, count;    // first word of the selection, and the number of words
    uint entry, capacity; // first entry in the list buffer, and room for entries
};

WordRange word_range_of(uint kind)
{
    const uint sprites = state.sprite_groups[0] * GROUP_WORDS, sheets = state.splash_groups[0] * GROUP_WORDS;
    if (kind == SPRITES)
        return WordRange(0u, sprites, 0u, look.max_sprites);
    return WordRange(sprites, sheets, look.max_sprites, look.max_crowns);
}

// Entries at the front that have no sprite: the paper's pyramids read their droplets directly.
uint unwritten(virga_list_gpu sprites) { return is_film() ? 0u : sprites.second_kind; }
