// sprite_find.comp - marks what a view may see: droplets, piles, and splashes from afar.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#include "sprite.glsl"
#include "compact.glsl"
#include "gpu/compact_find.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

// In the film's style by its sheet; in the paper's by its pyramids, those of a crown at any size.
bool is_shown_otherwise(virga_splash_gpu splash)
{
    if (is_film())
        return is_sheet(splash, crown_at(splash, view.time_close_s));
    return splash.kind >> 16 != 0u || VIRGA_DROPLET_MODEL(splash.kind) == VIRGA_SPLASH_CROWN_CONE;
}

uint pick(Slot slot)
{
    if (slot.kind == SLOT_NONE || (slot.kind == SLOT_SPLASH && is_shown_otherwise(splashes[slot.place])))
        return NOT_PICKED;
    const Projected p = project_sprite(sprite_of(slot));
    if (p.coverage <= 0.0)
        return NOT_PICKED;
    if (!is_film())
        return slot.kind == SLOT_PILE ? SECOND_KIND : FIRST_KIND;
    return p.width_px >= WIDE_PX && slot.kind != SLOT_SPLASH ? SECOND_KIND : FIRST_KIND;
}

void main() { mark_pick(pick(slot_of(gl_GlobalInvocationID.x))); }
