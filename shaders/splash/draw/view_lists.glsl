// view_lists.glsl - a view's two lists: whose picks they take, and what is written of them.
struct Words {
    uint first, count; // words
    uint entry, most;  // of their list
};

Words words_of(uint kind)
{
    const uint sprites = state.sprite_groups[0] * GROUP_WORDS, sheets = state.splash_groups[0] * GROUP_WORDS;
    if (kind == SPRITES)
        return Words(0u, sprites, 0u, look.max_sprites);
    return Words(sprites, sheets, look.max_sprites, look.max_crowns);
}

// Entries at the front that are drawn without a sprite: the paper's pyramids look at their droplets.
uint unwritten(virga_list_gpu sprites) { return is_film() ? 0u : sprites.second_kind; }
