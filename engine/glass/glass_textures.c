/* glass/glass_textures.c - drops as textures: a drop's picture is made at each point of a mesh over the pane, and every
 * drop is a quad that blends the four around it.
 * Paper: Sato, Dobashi and Yamamoto 2002, sections 3.1 to 3.4. */
#include "glass/glass_internal.h"

#include "gpu/record.h"
#include "gpu/timers.h"

#include <math.h>
#include <string.h>

/* Texels of all levels of a texture, per texel of the first: 1 + 1/4 + 1/16 + 1/64. */
#define LEVELS_NUMERATOR   85u
#define LEVELS_DENOMINATOR 64u

#define STREAK_MAX_DEG 40.0f /* a little below the angle of total reflection in water */

uint32_t glass_texture_texels(uint32_t asked)
{
    uint32_t texels = 8;
    while (texels < asked && texels < 64)
        texels *= 2;
    return texels;
}

bool glass_is_front(const virga_glass_settings *settings)
{
    return settings->style == VIRGA_GLASS_STYLE_FRONT && !settings->opaque;
}

/* Drops on a surface that is not glass show what is directly under each of them, which no texture has. */
bool glass_is_all_textured(const virga_glass_settings *settings)
{
    return (settings->style == VIRGA_GLASS_STYLE_TEXTURES && !settings->opaque) || glass_is_front(settings);
}

bool glass_is_textured(const virga_glass_settings *settings)
{
    const bool small = settings->style == VIRGA_GLASS_STYLE_PHYSICAL && settings->textured_px > 0 && !settings->opaque;
    return small || glass_is_all_textured(settings);
}

static uint32_t texture_count(const virga_glass *glass)
{
    return glass->def.texture_columns * glass->def.texture_rows;
}

/* What of a view decides on the textures: all but times, the size of the height map and whose turn it is. */
static void fill_kept(const glass_view_block *block, glass_view_block *kept)
{
    const virga_glass_picture_gpu *look = &block->look;
    memset(kept, 0, sizeof *kept);
    kept->view = block->view;
    kept->view.time_close_s = kept->view.time_open_s = kept->view.frame_interval_s = 0;
    memset(kept->view.open_clip_from_rel, 0, sizeof kept->view.open_clip_from_rel);
    memset(kept->view.previous_clip_from_rel, 0, sizeof kept->view.previous_clip_from_rel);
    memcpy(kept->look.world_from_pane, look->world_from_pane, sizeof look->world_from_pane);
    memcpy(kept->look.origin, look->origin, sizeof look->origin);
    memcpy(kept->look.tint, look->tint, sizeof look->tint);
    kept->look.cap_height = look->cap_height;
    kept->look.thickness_m = look->thickness_m;
    kept->look.gain = look->gain;
    kept->look.hemispheres = look->hemispheres;
}

/* Whether two views have drops and glass of the same kind. */
static bool same_kind(const virga_glass_picture_gpu *a, const virga_glass_picture_gpu *b)
{
    return !memcmp(a->tint, b->tint, sizeof a->tint) && a->cap_height == b->cap_height &&
           a->thickness_m == b->thickness_m && a->gain == b->gain && a->hemispheres == b->hemispheres;
}

/* Chooses the textures that this prepare makes: those that are late, in turn. Where a frame has more than max_views
 * views, some share the textures, so each of them makes all. */
static void choose_textures(virga_glass *glass, glass_view_block *block)
{
    struct glass_picture *picture = &glass->picture;
    glass_prepared *seen = &picture->prepared[glass->base.slot];
    const virga_glass_settings *s = &glass->settings;
    const uint32_t count = texture_count(glass), index = virga_ring_used(glass->base.context, &picture->view_ring);
    const bool alone = index < glass->base.max_views && picture->view_index < glass->base.max_views;
    glass_view_block kept;
    fill_kept(block, &kept);
    const bool all =
        !seen->has_textures || !alone || !s->textures_per_frame || !same_kind(&kept.look, &seen->textures_view.look);
    if (!seen->has_textures || !alone || !s->still_behind || memcmp(&kept, &seen->textures_view, sizeof kept))
        seen->late_textures = count;
    block->look.textures =
        all || s->textures_per_frame > seen->late_textures ? seen->late_textures : s->textures_per_frame;
    block->look.first_texture = seen->next_texture;
    seen->next_texture = (seen->next_texture + block->look.textures) % count;
    seen->late_textures -= block->look.textures;
    picture->view_index = index;
    seen->textures_view = kept;
    seen->has_textures = true;
}

/* How far a blade reaches at an angle to its middle, as shaders/lens/aperture.glsl has it. */
static double blade_reach(double blade, double roundness, double angle)
{
    return cos(0.5 * blade) / cos(angle) * (1 - roundness) + roundness;
}

/* The opening of the lens, and the area of the corners that front_overlap.glsl has. */
static void fill_opening(const virga_glass_settings *s, virga_glass_picture_gpu *look)
{
    const double roundness = (double)s->opening_roundness;
    look->opening_blades = s->opening_blades < 3 || roundness >= 1 ? 0 : s->opening_blades;
    look->opening_round = s->opening_roundness;
    look->opening_turn = s->opening_deg * (float)(3.14159265358979 / 180);
    look->opening_area = (float)3.14159265358979;
    if (!look->opening_blades)
        return;
    const double blade = 2 * 3.14159265358979 / look->opening_blades, part = blade / VIRGA_GLASS_BLADE_PARTS;
    double area = 0;
    for (int i = 0; i < VIRGA_GLASS_BLADE_PARTS; i++)
        area += 0.5 * sin(part) * blade_reach(blade, roundness, i * part - 0.5 * blade) *
                blade_reach(blade, roundness, (i + 1) * part - 0.5 * blade);
    look->opening_area = (float)(area * look->opening_blades);
}

void glass_fill_textures(virga_glass *glass, glass_view_block *block)
{
    const virga_glass_settings *s = &glass->settings;
    virga_glass_picture_gpu *look = &block->look;
    if (!glass_is_textured(s)) {
        glass->picture.prepared[glass->base.slot].has_textures = false;
        return;
    }
    look->textured_px = glass_is_all_textured(s) ? GLASS_ALL_TEXTURED : s->textured_px;
    look->texture_columns = glass->def.texture_columns;
    look->texture_rows = glass->def.texture_rows;
    look->texture_texels = glass->def.texture_texels;
    look->veil = s->veil;
    look->starburst = s->starburst;
    look->starburst_rad = fminf(s->receding_deg, STREAK_MAX_DEG) * (float)(3.14159265358979 / 180);
    look->starburst_turn = s->starburst_deg * (float)(3.14159265358979 / 180);
    look->starburst_rays = s->starburst_rays;
    fill_opening(s, look);
    look->hemispheres = s->texture_shape == VIRGA_GLASS_TEXTURE_HEMISPHERE;
    look->quads_offset = look->bounds_offset + 2 * look->max_tiles;
    if (glass_is_front(s))
        glass->picture.prepared[glass->base.slot].has_textures = false;
    else
        choose_textures(glass, block);
    /* Without a height map no bead of film has a shape: with texels as wide as the pane all film is mist. */
    if (glass_is_all_textured(s))
        look->texel_m[0] = look->texel_m[1] = fmaxf(glass->def.width_m, glass->def.height_m);
}

bool glass_keeps_textures(const virga_glass *glass, const glass_view_block *block)
{
    const virga_glass_settings *s = &glass->settings;
    return glass_is_textured(s) && !glass_is_front(s) && s->still_behind && !block->look.textures;
}

void glass_record_textures(virga_glass *glass, VkCommandBuffer cmd, const glass_view_block *block)
{
    virga_context *context = glass->base.context;
    const struct glass_picture *picture = &glass->picture;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "glass.textures");
    virga_compute_barrier(context, cmd); /* the copies of the plate, and the counts of passes before */
    if (block->look.textures) {
        const uint32_t side = glass->def.texture_texels, each = side * side * LEVELS_NUMERATOR / LEVELS_DENOMINATOR;
        const uint32_t texels = block->look.textures * each;
        virga_dispatch(context, cmd, picture->texture_passes[block->view.depth_given ? 1 : 0],
                       (texels + VIRGA_GLASS_TEXTURE_GROUP - 1) / VIRGA_GLASS_TEXTURE_GROUP);
        glass->base.journal.doing |= GLASS_DID_TEXTURES;
    }
    if (glass_is_front(&glass->settings)) /* also without a drop: veil and streaks */
        virga_dispatch(context, cmd, picture->front_quads, glass->def.max_drops / VIRGA_GLASS_GROUP);
    else
        virga_dispatch_indirect(context, cmd, picture->drop_quads, glass->state->buffer,
                                offsetof(virga_glass_state_gpu, shown_groups));
    virga_pass_end(context, cmd, scope);
}
