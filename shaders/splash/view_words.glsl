// view_words.glsl - the words of picks of a view's two lists.
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
