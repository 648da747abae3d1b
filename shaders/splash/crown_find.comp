// crown_find.comp - marks the splashes whose sheets are large enough on the picture to be drawn as such.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#include "sprite.glsl"
#include "compact_crowns.glsl"
#include "gpu/compact_find.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

bool on_picture(Crown crown)
{
    const vec4 clip = project(to_mat(view.clip_from_rel), crown.centre);
    const float margin = 2.0 * crown.radius + 2.0 * crown.height;
    const vec2 m = margin / view.pixel_angle * 2.0 / vec2(view.viewport[2], view.viewport[3]);
    return clip.w > NEAR_W && all(lessThan(abs(clip.xy) - clip.w, m));
}

uint pick(uint place)
{
    if (place == NO_PLACE)
        return NOT_PICKED;
    const virga_splash_gpu splash = splashes[place];
    const Crown crown = crown_at(splash, view.time_close_s), before = crown_at(splash, view.time_open_s);
    if (max(crown.height, before.height) <= 0.0 || !on_picture(crown))
        return NOT_PICKED;
    // The paper has no sheets but crowns, which are pyramids.
    const bool drawn = is_film() || crown.model == VIRGA_SPLASH_CROWN_CONE;
    return drawn && is_sheet(splash, crown) ? FIRST_KIND : NOT_PICKED;
}

void main()
{
    mark_pick(pick(splash_place(gl_GlobalInvocationID.x)));
}
