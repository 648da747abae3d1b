// sprite_mark.glsl - which sprites a droplet or a splash shows on the picture. Many droplets and many splashes have a
// dispatch each, because software Vulkan runs every lane through all branches.
#define IN_FORMS
#include "sprite.glsl"
#include "compact.glsl"
#include "gpu/line.glsl"
#include "gpu/compact_mark.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

// Whether the crowns of a puff are drawn one by one, in the film's style: where most of its pixels are between them.
// Such a puff has all the vertices that a puff may have, so a small one is not worth it. Small crowns close together
// have a veil between them, see puff_crowns.glsl.
#define ONE_BY_ONE_PX2 2048.0
#define CROWN_PX2      32.0 // of a cell: without a veil

bool has_own_crowns(Sprite sprite, Projected p)
{
    const vec2 half_viewport = 0.5 * vec2(view.viewport[2], view.viewport[3]);
    const float high_px = length((p.head.xy / p.head.w - p.tail.xy / p.tail.w) * half_viewport);
    const float area = high_px * (p.body_px + p.spread_px);
    return is_film() && sprite.kind == VIRGA_SPRITE_PUFF && p.columns > 1.5 && area >= ONE_BY_ONE_PX2 &&
           area >= CROWN_PX2 * p.columns * p.rows;
}

// In the film's style the second kind shows the background through it, or is a puff whose crowns are drawn one by one;
// in the paper's style it is a pyramid.
uint kind_of(Sprite sprite, Projected p)
{
    const bool pile = sprite.kind == VIRGA_SPRITE_PILE;
    const bool clear = sprite.kind == VIRGA_SPRITE_DROPLET || pile;
    const bool second = is_film() ? (p.width_px >= WIDE_PX && clear) || has_own_crowns(sprite, p) : pile;
    return p.coverage <= 0.0 ? NOT_SELECTED : second ? SECOND_KIND : FIRST_KIND;
}

// Whether a droplet is as thin as droplets can be, so that all lines have the same width.
bool is_line(Projected p)
{
    return look.lines != 0u && p.width_px <= view.min_width_px &&
           is_whole(p.head.xy / p.head.w, p.tail.xy / p.tail.w, 0.5 * view.min_width_px + 0.5);
}

// Selection of a droplet: as a line, as another sprite, and of its pile.
uint[3] droplet_kinds(uint slot)
{
    if (slot >= state.staying)
        return uint[3](NOT_SELECTED, NOT_SELECTED, NOT_SELECTED);
    const virga_droplet_gpu droplet = droplet_of(slot);
    const Sprite flies = droplet_sprite(droplet, 0.0), pile = pile_sprite(droplet, 0.0);
    const Projected p = project_sprite(flies);
    const uint kind = kind_of(flies, p);
    const bool line = kind == FIRST_KIND && is_line(p);
    return uint[3](line ? kind : NOT_SELECTED, line ? NOT_SELECTED : kind, kind_of(pile, project_sprite(pile)));
}

uint[3] droplet_sets()
{
    const uint groups = state.view_groups[0];
    return uint[3](0u, groups, 2u * groups);
}

// In the film's style by its sheet; in the paper's style by its pyramids, where a crown is large enough.
bool is_shown_otherwise(virga_splash_gpu splash, Crown crown)
{
    return is_film() || crown.model == VIRGA_SPLASH_CROWN_CONE ? is_sheet(splash, crown) : crown.droplets != 0u;
}

bool on_picture(Crown crown)
{
    const vec4 clip = project(to_mat(view.clip_from_rel), crown.center);
    const float margin = 2.0 * crown.radius + 2.0 * crown.height;
    const vec2 m = margin / view.pixel_angle * 2.0 / vec2(view.viewport[2], view.viewport[3]);
    return clip.w > NEAR_W && all(lessThan(abs(clip.xy) - clip.w, m));
}

uint sheet_kind(virga_splash_gpu splash, Crown crown)
{
    const Crown before = crown_at(splash, view.time_open_s);
    if (max(crown.height, before.height) <= 0.0 || !on_picture(crown))
        return NOT_SELECTED;
    // The paper has no sheets except crowns, which are pyramids.
    const bool drawn = is_film() || crown.model == VIRGA_SPLASH_CROWN_CONE;
    return drawn && is_sheet(splash, crown) ? FIRST_KIND : NOT_SELECTED;
}

// Selection of a splash: its puff, and its sheet where that is large enough on the picture.
uint[2] splash_kinds(uint entry)
{
    const uint slot = splash_slot(entry);
    if (slot == NO_SLOT)
        return uint[2](NOT_SELECTED, NOT_SELECTED);
    const virga_splash_gpu splash = splash_of(slot);
    const Crown crown = crown_at(splash, view.time_close_s);
    const Sprite sprite = puff_sprite(splash, 0.0);
    const uint puff = is_shown_otherwise(splash, crown) ? NOT_SELECTED : kind_of(sprite, project_sprite(sprite));
    return uint[2](puff, sheet_kind(splash, crown));
}

// Behind droplets and piles; and behind all sprites.
uint[2] splash_sets() { return uint[2](3u * state.view_groups[0], state.sprite_groups[0]); }
