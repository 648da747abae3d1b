// splash_find.comp - marks the splashes that a view may see from afar, and those whose sheets are large enough on the picture to
// be drawn as such.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#include "sprite_find.glsl"

// In the film's style by its sheet; in the paper's by its pyramids, a crown where it is large enough.
bool is_shown_otherwise(virga_splash_gpu splash, Crown crown)
{
    return is_film() || crown.model == VIRGA_SPLASH_CROWN_CONE ? is_sheet(splash, crown) : splash.kind >> 16 != 0u;
}

bool on_picture(Crown crown)
{
    const vec4 clip = project(to_mat(view.clip_from_rel), crown.centre);
    const float margin = 2.0 * crown.radius + 2.0 * crown.height;
    const vec2 m = margin / view.pixel_angle * 2.0 / vec2(view.viewport[2], view.viewport[3]);
    return clip.w > NEAR_W && all(lessThan(abs(clip.xy) - clip.w, m));
}

uint sheet_kind(virga_splash_gpu splash, Crown crown)
{
    const Crown before = crown_at(splash, view.time_open_s);
    if (max(crown.height, before.height) <= 0.0 || !on_picture(crown))
        return NOT_PICKED;
    // The paper has no sheets but crowns, which are pyramids.
    const bool drawn = is_film() || crown.model == VIRGA_SPLASH_CROWN_CONE;
    return drawn && is_sheet(splash, crown) ? FIRST_KIND : NOT_PICKED;
}

void main()
{
    const uint place = splash_place(gl_GlobalInvocationID.x);
    uint kinds[2] = uint[2](NOT_PICKED, NOT_PICKED);
    if (place != NO_PLACE) {
        const virga_splash_gpu splash = splashes[place];
        const Crown crown = crown_at(splash, view.time_close_s);
        kinds[0] = is_shown_otherwise(splash, crown) ? NOT_PICKED : kind_of(puff_sprite(splash));
        kinds[1] = sheet_kind(splash, crown);
    }
    // Behind droplets and piles; and behind all sprites.
    mark_picks(kinds, uint[2](2u * state.view_groups[0], state.sprite_groups[0]));
}
