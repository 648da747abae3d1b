// puff_find.comp - marks the splashes that a view may see from afar.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#define COMPACT_FIRST_GROUP (2u * state.view_groups[0]) // behind droplets and piles
#include "sprite_find.glsl"

// In the film's style by its sheet; in the paper's by its pyramids, a crown where it is large enough.
bool is_shown_otherwise(virga_splash_gpu splash)
{
    if (is_film() || VIRGA_DROPLET_MODEL(splash.kind) == VIRGA_SPLASH_CROWN_CONE)
        return is_sheet(splash, crown_at(splash, view.time_close_s));
    return splash.kind >> 16 != 0u;
}

void main()
{
    const uint place = splash_place(gl_GlobalInvocationID.x);
    const bool shown = place != NO_PLACE && !is_shown_otherwise(splashes[place]);
    mark_pick(shown ? kind_of(puff_sprite(splashes[place])) : NOT_PICKED);
}
