/* glass/glass_draw.c - renders a pane for a view: prepare makes the height map, draw shades it. */
#include "glass/glass_internal.h"

#include "core/settings.h"
#include "gpu/builds.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/target.h"
#include "gpu/timers.h"
#include "gpu/view.h"

#include <virga/shared/random.h>

#include "shaders/glass_shaders.h"

#include <math.h>
#include <string.h>

#define TILE        VIRGA_GLASS_TILE
#define BLOCK       VIRGA_GLASS_MIST_BLOCK
#define PI          3.14159265358979323846
#define GRAVITY     9.80665
#define BEAD_STREAM 0x6265u /* of random numbers: beads of film */
#define UNSEEN      0.0078  /* texels: a pixel this close to a dry texel does not show the wet texel beside it */
#define SINGLE_PX   0.7     /* as SINGLE.x in shaders/glass/draw/fog.frag */
#define MIN_TEXELS  64u     /* min texels of the map along the pane's longer side, at any distance */

/* ---- the size of the pane in a view */

/* Copies the pane's axes in the world. If none are given, they are the world's axes. */
static void copy_rotation(const virga_glass_pose *pose, float m[9])
{
    bool none = true;
    for (int i = 0; i < 9; i++) {
        m[i] = pose->world_from_pane[i];
        none = none && m[i] == 0;
    }
    for (int i = 0; none && i < 9; i++)
        m[i] = i % 4 == 0;
}

/* Clip coordinates of a point of the pane. */
static void project(const glass_view_block *block, const float point[3], double clip[4])
{
    const float *m = block->look.world_from_pane, *p = block->view.clip_from_rel;
    double at[3];
    for (int i = 0; i < 3; i++)
        at[i] = (double)block->look.origin[i] + (double)m[i] * (double)point[0] + (double)m[3 + i] * (double)point[1] +
                (double)m[6 + i] * (double)point[2];
    for (int i = 0; i < 4; i++)
        clip[i] = (double)p[i] * at[0] + (double)p[4 + i] * at[1] + (double)p[8 + i] * at[2] + (double)p[12 + i];
}

/* Max length in pixels of a metre of the pane, measured between its 3 x 3 outline points. If a point is behind or very
 * near the camera, the result is a very large number. */
static double pixels_per_metre(const virga_glass *glass, const glass_view_block *block)
{
    double pixels[9][2], max = 0;
    for (int i = 0; i < 9; i++) {
        double clip[4];
        project(block, glass->outline[i], clip);
        if (clip[3] < 0.02)
            return 1e6;
        for (int axis = 0; axis < 2; axis++)
            pixels[i][axis] = 0.5 * clip[axis] / clip[3] * (double)block->view.viewport[2 + axis];
    }
    for (int i = 0; i < 9; i++)
        for (int along = 0; along < 2; along++) {
            const int next = along ? i + 3 : i + 1;
            if (along ? next > 8 : i % 3 == 2)
                continue;
            const double metres = 0.5 * (double)(along ? glass->def.height_m : glass->def.width_m);
            max = fmax(max, hypot(pixels[next][0] - pixels[i][0], pixels[next][1] - pixels[i][1]) / metres);
        }
    return max;
}

static uint32_t whole_tiles(double texels, uint32_t max)
{
    const double tiles = ceil(fmin(texels, 1e6) / TILE - 1e-4);
    return (uint32_t)fmin(fmax(tiles, 1), max);
}

/* Sets the resolution of the height map: about one texel per pixel, in whole tiles, within the max size. */
static void fit_map(const virga_glass *glass, glass_view_block *block)
{
    const struct glass_picture *picture = &glass->picture;
    virga_glass_picture_gpu *look = &block->look;
    const double width = (double)glass->def.width_m, height = (double)glass->def.height_m;
    const double min = MIN_TEXELS / fmax(width, height);
    const double dense = fmax(pixels_per_metre(glass, block), min);
    look->fog_single_m = (float)(SINGLE_PX / dense);
    look->tile_columns = whole_tiles(width * dense, picture->max_tile_columns);
    look->tile_rows = whole_tiles(height * dense, picture->max_tile_rows);
    look->map_columns = look->tile_columns * TILE;
    look->map_rows = look->tile_rows * TILE;
    look->texel_m[0] = (float)(width / look->map_columns);
    look->texel_m[1] = (float)(height / look->map_rows);
    look->written_columns = picture->max_tile_columns;
}

/* Min length in pixels of a metre of the pane, over its 9 outline points and all directions. It is the smallest
 * singular value of the Jacobian of the projection. 0 if a point is behind the camera. */
static double min_pixels_per_metre(const virga_glass *glass, const glass_view_block *block)
{
    double min = 1e12;
    for (int i = 0; i < 9; i++) {
        double clip[4], ways[2][2];
        project(block, glass->outline[i], clip);
        if (clip[3] < 0.02)
            return 0;
        for (int along = 0; along < 2; along++) {
            const int step = along ? 3 : 1, at_end = along ? i > 5 : i % 3 == 2;
            const double metres = 0.5 * (double)(along ? glass->def.height_m : glass->def.width_m);
            double next[4];
            project(block, glass->outline[at_end ? i - step : i + step], next);
            for (int axis = 0; axis < 2; axis++)
                ways[along][axis] = (next[axis] - clip[axis] * next[3] / clip[3]) / clip[3] / metres * 0.5 *
                                    (double)block->view.viewport[2 + axis];
        }
        const double sum =
            ways[0][0] * ways[0][0] + ways[0][1] * ways[0][1] + ways[1][0] * ways[1][0] + ways[1][1] * ways[1][1];
        const double area = ways[0][0] * ways[1][1] - ways[0][1] * ways[1][0];
        min = fmin(min, sqrt(fmax(sum - sqrt(fmax(sum * sum - 4 * area * area, 0)), 0) / 2));
    }
    return min;
}

/* Sets how far the water of a texel is visible beyond the texel. A pixel interpolates four texels, so water is visible
 * up to the centers of the neighbour texels. Where a pixel is larger than a texel, the difference is added. */
static void fit_bounds(const virga_glass *glass, glass_view_block *block)
{
    const double texel = fmin((double)block->look.texel_m[0], (double)block->look.texel_m[1]);
    const double pixels = min_pixels_per_metre(glass, block) * texel;
    block->look.beside = (float)(0.5 - UNSEEN + fmin(fmax(1 / fmax(pixels, 1e-6) - 1, 0), TILE));
}

/* Sets the resolution of the mist map. A texel holds one cell. If cells are much smaller than pixels, a texel holds
 * several cells and is about one pixel large. */
static void fit_mist(virga_glass *glass, virga_glass_picture_gpu *look)
{
    struct glass_picture *picture = &glass->picture;
    const float texel = look->texel_m[0] > look->texel_m[1] ? look->texel_m[0] : look->texel_m[1];
    uint32_t cells = 1;
    picture->beads = glass_picture_has_beads(glass->def.cell_m, texel);
    while ((glass->columns - 1) / cells >= picture->max_mist.width ||
           (glass->rows - 1) / cells >= picture->max_mist.height || 1.5f * (float)cells * glass->def.cell_m < texel)
        cells *= 2;
    picture->mist_cells = look->mist_cells = cells;
    picture->mist_size.width = look->mist_columns = (glass->columns - 1) / cells + 1;
    picture->mist_size.height = look->mist_rows = (glass->rows - 1) / cells + 1;
    look->mist_pitch = (look->mist_columns + BLOCK - 1) / BLOCK * BLOCK;
    look->mist_scale[0] = 1 / ((float)cells * glass->def.cell_m * (float)picture->max_mist.width);
    look->mist_scale[1] = 1 / ((float)cells * glass->def.cell_m * (float)picture->max_mist.height);
}

/* ---- the uniforms of a view */

static void fill_pane(const virga_glass *glass, const virga_view *view, const virga_glass_pose *pose,
                      virga_glass_picture_gpu *look)
{
    look->pane = glass_describe_pane(glass);
    copy_rotation(pose, look->world_from_pane);
    for (int i = 0; i < 3; i++) {
        look->origin[i] = (float)(pose->position_m[i] - view->position_m[i]);
        look->gravity[i] = (float)(-GRAVITY * (double)look->world_from_pane[3 * i + 1]);
    }
}

static void fill_time(const virga_glass *glass, double time_s, virga_glass_picture_gpu *look)
{
    const double late = fmin(time_s - virga_glass_time(glass), 0), share = 1 + late / glass->def.tick_s;
    look->share = (float)fmax(share, 0);
    look->late_s = (float)fmax(late, -glass->def.tick_s);
    look->tick = glass->last_tick;
    look->tick_s = (float)glass->def.tick_s;
}

static void fill_look(const virga_glass *glass, virga_glass_picture_gpu *look)
{
    const virga_glass_settings *s = &glass->settings;
    const double angle_deg = glass_seen_deg(s);
    look->drop_nl_of_m3 = (float)(glass_cap_volume(angle_deg) * 1e12);
    look->cap_height = (float)tan(angle_deg * PI / 360);
    look->fog_cap_height = (float)tan(glass_rest_deg(s) * PI / 360);
    look->particle_m = s->particle_radius_mm * 1e-3f;
    look->particles_as_given = s->style == VIRGA_GLASS_STYLE_PAPER;
    look->impact_s = s->impact_s;
    look->film_break_s = s->film_break_s;
    look->density = (uint32_t)s->density;
    look->weighted = s->blend == VIRGA_GLASS_BLEND_WEIGHTED;
    look->compress_steps = s->compress ? s->compress_steps : 0;
    look->compress_from = s->compress_from;
    look->compress_step = s->compress_step;
    look->compress_k = s->compress_k;
    look->threshold = s->threshold;
    look->pinning = s->pinning;
    look->paper_shift = s->paper_shift;
    look->thickness_m = s->thickness_mm * 1e-3f;
    memcpy(look->tint, s->tint, sizeof look->tint);
    look->opaque = s->opaque;
    look->gain = s->gain;
    look->max_tiles = glass->picture.max_tile_columns * glass->picture.max_tile_rows;
    look->max_blocks = glass->picture.max_mist.width / BLOCK * (glass->picture.max_mist.height / BLOCK);
    look->max_entries = glass->picture.max_entries;
    look->bounds_offset = 6 * (look->max_tiles + look->max_blocks);
    look->masked = glass->masked;
    look->bead_seed = virga_hash2(glass->def.seed, BEAD_STREAM);
    look->whole_map = glass->picture.whole_map;
    glass_fill_fog_look(glass, look);
    look->sheets = s->style == VIRGA_GLASS_STYLE_PHYSICAL || look->whole_map;
}

/* Two hashes of all that the maps depend on besides water. */
static void fill_map_seed(const virga_glass *glass, virga_glass_picture_gpu *look)
{
    const float numbers[] = {look->texel_m[0],   look->texel_m[1], look->drop_nl_of_m3, look->cap_height,
                             look->film_break_s, look->threshold,  look->compress_from, look->compress_step,
                             look->compress_k,   look->pinning};
    const uint32_t words[] = {look->map_columns,
                              look->map_rows,
                              look->density,
                              look->weighted,
                              look->compress_steps,
                              look->opaque,
                              look->sheets,
                              glass->picture.beads,
                              look->mist_cells,
                              glass->shape_count,
                              (uint32_t)glass->settings.style};
    for (uint32_t k = 0; k < 2; k++) {
        uint32_t hash = virga_hash2(look->bead_seed, k);
        for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
            uint32_t bits;
            memcpy(&bits, &numbers[i], sizeof bits);
            hash = virga_hash_absorb(hash, bits);
        }
        for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
            hash = virga_hash_absorb(hash, words[i]);
        look->map_seed[k] = hash;
    }
}

static void fill_view(virga_glass *glass, const virga_view *view, const virga_glass_pose *pose, double time_s,
                      glass_view_block *block)
{
    glass_view_block filled = {.look.view_texel =
                                   virga_ring_next_offset(glass->base.context, &glass->picture.view_ring) / 16};
    virga_view_fill(view, &glass->settings.lighting, pose->position_m, virga_glass_time(glass), time_s, &filled.view);
    fill_pane(glass, view, pose, &filled.look);
    fill_time(glass, time_s, &filled.look);
    fill_look(glass, &filled.look);
    glass_fill_before(view, pose, &filled.look);
    fit_map(glass, &filled);
    fit_bounds(glass, &filled);
    fit_mist(glass, &filled.look);
    fill_map_seed(glass, &filled.look);
    glass_fill_textures(glass, &filled);
    glass->picture.columns = filled.look.map_columns;
    glass->picture.rows = filled.look.map_rows;
    *block = filled;
}

/* ---- prepare */

/* Marks all tiles as holding old contents, so that every tile is written. Needed at the start, and after a change of
 * the style, because each style has its own images. */
static void record_unwritten(virga_glass *glass, VkCommandBuffer cmd)
{
    glass_prepared *seen = &glass->picture.prepared[glass->base.slot];
    glass->base.context->vk.CmdFillBuffer(cmd, glass->picture.written->buffer, 0, VK_WHOLE_SIZE,
                                          VIRGA_GLASS_HOLDS_WATER | VIRGA_GLASS_HOLDS_RELIEF);
    seen->written_style = glass->settings.style;
    seen->has_written = true;
    glass->base.journal.doing |= GLASS_DID_UNWRITTEN;
}

/* Columns of the mist map in use, in texels, rounded up to whole blocks. */
static uint32_t mist_pitch(const struct glass_picture *picture)
{
    return (picture->mist_size.width + BLOCK - 1) / BLOCK * BLOCK;
}

static uint32_t mist_rows(const struct glass_picture *picture)
{
    return (picture->mist_size.height + BLOCK - 1) / BLOCK * BLOCK;
}

/* Clears the ball lists of the tiles and the mist map. Later passes write the mist map only where there is film. */
static void record_clear(virga_glass *glass, VkCommandBuffer cmd)
{
    virga_context *context = glass->base.context;
    struct glass_picture *picture = &glass->picture;
    /* The previous draw, of this or an earlier frame, may still read the map and the copies of the plate. */
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_COPIES | VIRGA_VERTICES | VIRGA_FRAGMENTS,
               VIRGA_PASSES | VIRGA_COPIES);
    const VkDeviceSize texels = (VkDeviceSize)picture->columns * picture->rows;
    context->vk.CmdFillBuffer(cmd, picture->tiles->buffer, 0, texels / (TILE * TILE) * sizeof(virga_glass_tile_gpu), 0);
    context->vk.CmdFillBuffer(cmd, picture->work->buffer, 0, sizeof(virga_glass_work_gpu), 0);
    context->vk.CmdFillBuffer(cmd, picture->mist->buffer, 0, (VkDeviceSize)mist_pitch(picture) * mist_rows(picture), 0);
    const glass_prepared *seen = &picture->prepared[glass->base.slot];
    if (!glass_is_all_textured(&glass->settings) &&
        (!seen->has_written || seen->written_style != glass->settings.style))
        record_unwritten(glass, cmd);
    virga_wait(context, cmd, VIRGA_COPIES, VIRGA_PASSES);
}

static void over_work(virga_glass *glass, VkCommandBuffer cmd, const virga_pipeline *pipeline, size_t groups)
{
    virga_dispatch_indirect(glass->base.context, cmd, pipeline, glass->picture.work->buffer, groups);
}

/* Writes the mist map from the film, and the list of tiles with visible film. */
static void record_film(virga_glass *glass, VkCommandBuffer cmd)
{
    virga_context *context = glass->base.context;
    const struct glass_picture *picture = &glass->picture;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "glass.film");
    const uint32_t mode = (picture->mist_cells > 1 ? GLASS_MIST_SEVERAL : 0) | (glass->masked ? GLASS_MIST_MASKED : 0);
    const uint32_t blocks = mist_pitch(picture) / BLOCK * (mist_rows(picture) / BLOCK);
    virga_dispatch(context, cmd, picture->mist_blocks, (blocks + VIRGA_GLASS_GROUP - 1) / VIRGA_GLASS_GROUP);
    virga_indirect_barrier(context, cmd);
    over_work(glass, cmd, picture->mist_passes[mode], offsetof(virga_glass_work_gpu, mist_groups));
    if (context->for_software) { /* on a GPU the pass above marks the tiles itself */
        virga_indirect_barrier(context, cmd);
        over_work(glass, cmd, picture->film_tiles, offsetof(virga_glass_work_gpu, block_groups));
    }
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_PASSES | VIRGA_COPIES);
    const VkBufferImageCopy copy = {.bufferRowLength = mist_pitch(picture),
                                    .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {picture->mist_size.width, picture->mist_size.height, 1}};
    context->vk.CmdCopyBufferToImage(cmd, picture->mist->buffer, picture->mist_map->image, VK_IMAGE_LAYOUT_GENERAL, 1,
                                     &copy);
    virga_pass_end(context, cmd, scope);
}

/* Number of workgroups of a pass over all tiles in use. */
static uint32_t tile_groups(const struct glass_picture *picture)
{
    return (picture->columns / TILE * (picture->rows / TILE) + VIRGA_GLASS_GROUP - 1) / VIRGA_GLASS_GROUP;
}

/* Writes the balls, and the list of balls of each tile that has changed. */
static void record_balls(virga_glass *glass, VkCommandBuffer cmd)
{
    virga_context *context = glass->base.context;
    const struct glass_picture *picture = &glass->picture;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "glass.balls");
    const virga_pipeline *pass = picture->ball_passes[glass_is_textured(&glass->settings)];
    virga_dispatch_indirect(context, cmd, pass, glass->state->buffer, offsetof(virga_glass_state_gpu, shown_groups));
    virga_compute_barrier(context, cmd);
    virga_dispatch(context, cmd, picture->tile_list, tile_groups(picture));
    virga_indirect_barrier(context, cmd);
    over_work(glass, cmd, picture->tile_fill, offsetof(virga_glass_work_gpu, ball_groups));
    virga_compute_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
}

/* Makes smaller copies of the host's color image. The host's barriers may cover only fragment shaders, so this adds one
 * for compute. */
static void record_copies(virga_glass *glass, VkCommandBuffer cmd, const virga_view *view)
{
    virga_context *context = glass->base.context;
    const struct glass_picture *picture = &glass->picture;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "glass.plate_copy");
    const VkPipelineStageFlags from =
        view->color.before.stage ? view->color.before.stage : VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    virga_barrier(context, cmd, from, 0, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    virga_dispatch_2d(context, cmd, picture->plate_copy, 1, VIRGA_GLASS_COPY);
    virga_compute_barrier(context, cmd);
    virga_dispatch_2d(context, cmd, picture->plate_shrink, VIRGA_GLASS_COPY / 64, VIRGA_GLASS_COPY / 64);
    virga_pass_end(context, cmd, scope);
}

static void bind(virga_glass *glass, VkCommandBuffer cmd, VkPipelineBindPoint point, VkDescriptorSet set,
                 uint32_t view_offset)
{
    virga_bind(glass->base.context, cmd, point, glass->picture.bindings, set, 1, &view_offset);
}

/* Makes the height map, with the slopes that the draws read, and lists the tiles to draw. */
static void record_height_map(virga_glass *glass, VkCommandBuffer cmd)
{
    virga_context *context = glass->base.context;
    const struct glass_picture *picture = &glass->picture;
    const uint32_t mode = glass_picture_gather(glass, &glass->settings);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "glass.height_map");
    over_work(glass, cmd, picture->gather_passes[mode], offsetof(virga_glass_work_gpu, tile_groups));
    virga_indirect_barrier(context, cmd); /* both gather passes write group counts of later passes */
    over_work(glass, cmd, picture->gather_passes[mode | GLASS_GATHER_FILM | (picture->beads ? GLASS_GATHER_BEADS : 0)],
              offsetof(virga_glass_work_gpu, film_groups));
    virga_indirect_barrier(context, cmd);
    virga_dispatch(context, cmd, picture->tile_quads, tile_groups(picture));
    if (glass->settings.style != VIRGA_GLASS_STYLE_PAPER)
        over_work(glass, cmd, picture->relief_passes[glass->masked ? 1 : 0],
                  offsetof(virga_glass_work_gpu, relief_groups));
    virga_pass_end(context, cmd, scope);
}

static void record_prepare(virga_glass *glass, VkCommandBuffer cmd, const virga_view *view,
                           const glass_view_block *block, VkDescriptorSet set, bool copies)
{
    virga_context *context = glass->base.context;
    const struct glass_picture *picture = &glass->picture;
    record_clear(glass, cmd);
    bind(glass, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, set, picture->view_offset);
    record_film(glass, cmd);
    glass_record_fog_map(glass, cmd);
    if (!glass_is_all_textured(&glass->settings)) {
        record_balls(glass, cmd);
        record_height_map(glass, cmd);
    }
    if (copies)
        record_copies(glass, cmd, view);
    if (glass_is_textured(&glass->settings))
        glass_record_textures(glass, cmd, block);
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_COPIES,
               VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_COPIES | VIRGA_VERTICES | VIRGA_FRAGMENTS);
    virga_effect_copy_statistics(
        &glass->base, cmd, GLASS_PART_PREPARE, picture->work, offsetof(virga_glass_work_gpu, shaped),
        offsetof(glass_readback, prepared[virga_effect_view_index(&glass->base)]), 2 * sizeof(uint32_t));
}

/* Checks that the gather passes of this pane are built. Where passes are built on use, recording builds the two that
 * this view needs. */
static virga_result gathers_ready(const virga_glass *glass)
{
    if (glass_is_all_textured(&glass->settings) || glass->base.context->pipeline_build_mode == VIRGA_PIPELINES_ON_USE)
        return VIRGA_OK;
    const uint32_t mode = glass_picture_gather(glass, &glass->settings);
    const virga_pipeline *gathers[] = {glass->picture.gather_passes[mode],
                                       glass->picture.gather_passes[mode | GLASS_GATHER_FILM],
                                       glass->picture.gather_passes[mode | GLASS_GATHER_FILM | GLASS_GATHER_BEADS]};
    return virga_pipelines_ready(gathers, glass->picture.any_beads ? 3 : 2);
}

virga_result glass_pose_check(const virga_log *log, const virga_glass_pose *pose)
{
    if (virga_settings_check_positions(log, "glass_pose.position_m", pose->position_m, 3))
        return VIRGA_ERROR_INVALID;
    if (virga_settings_check_positions(log, "glass_pose.previous_position_m", pose->previous_position_m, 3))
        return VIRGA_ERROR_INVALID;
    const virga_result now = glass_axes_check(log, "glass_pose.world_from_pane", pose->world_from_pane);
    return now ? now : glass_axes_check(log, "glass_pose.previous_world_from_pane", pose->previous_world_from_pane);
}

/* The side from which the whole pane is seen. 0 if it is not the same for all points, or too close to edge-on. */
static uint32_t side_of(const virga_glass *glass, const virga_view *view, const virga_glass_pose *pose)
{
    float m[9];
    int behind = 0, before = 0;
    copy_rotation(pose, m);
    for (int i = 0; i < 9; i++) {
        const float *normal = glass->normals[(VIRGA_GLASS_NODES - 1) / 2 * (i % 3 + i / 3 * VIRGA_GLASS_NODES)];
        double along = 0, length = 0;
        for (int axis = 0; axis < 3; axis++) {
            double way = pose->position_m[axis] - view->position_m[axis], facing = 0;
            for (int k = 0; k < 3; k++) {
                way += (double)m[3 * k + axis] * (double)glass->outline[i][k];
                facing += (double)m[3 * k + axis] * (double)normal[k];
            }
            along += way * facing;
            length += way * way;
        }
        behind += along > 0.2 * sqrt(length);
        before += along < -0.2 * sqrt(length);
    }
    return behind == 9 ? VIRGA_GLASS_DRAW_BEHIND : before == 9 ? VIRGA_GLASS_DRAW_BEFORE : 0;
}

static uint32_t draw_of(const virga_glass *glass, const virga_view *view, const virga_glass_pose *pose)
{
    return (view->depth.view ? VIRGA_GLASS_DRAW_DEPTH : 0) |
           (glass->settings.lighting.light_count ? VIRGA_GLASS_DRAW_LAMPS : 0) |
           (glass->settings.opaque ? VIRGA_GLASS_DRAW_OPAQUE : side_of(glass, view, pose));
}

/* Chooses whose copies of the plate a pane uses: those of `plate`, unless the pane keeps its own from an earlier frame,
 * or unless their owner replaces them while this view still lives. Returns whether it makes its own. */
static bool choose_copies(virga_glass *glass, const virga_view *view, const glass_view_block *block, glass_plate *plate,
                          VkImageView *copies)
{
    glass_prepared *seen = &glass->picture.prepared[glass->base.slot];
    *copies = VK_NULL_HANDLE;
    if (!view->color.view || (seen->has_copies && glass_keeps_textures(glass, block)))
        return false;
    if (plate->owner && plate->owner->base.max_views >= glass->base.max_views)
        *copies = plate->copies;
    else
        *plate = (glass_plate){glass, glass->picture.copies->layer_views[0]};
    seen->has_copies = !*copies;
    return !*copies;
}

static virga_result check_prepare(virga_glass *glass, VkCommandBuffer cmd, const virga_view *view,
                                  const virga_glass_pose *pose, double time_s)
{
    const virga_result result =
        virga_effect_check_prepare(&glass->base, "virga_glass_prepare", cmd, pose ? view : NULL, time_s, true);
    if (result)
        return result;
    if (glass_pose_check(&glass->base.context->log, pose))
        return VIRGA_ERROR_INVALID;
    return glass->base.contents ? gathers_ready(glass) : VIRGA_NOT_READY;
}

/* Fog on the eye's side is drawn over drops, else under them: so also where the pane is not all seen from one side. */
static void fill_fog_order(const virga_glass *glass, glass_prepared *seen)
{
    const uint32_t side = seen->draw & VIRGA_GLASS_DRAW_SIDE;
    seen->fog = glass_shows_fog(&glass->settings);
    seen->fog_before = glass->settings.condensation.side == VIRGA_GLASS_FOG_INSIDE ? side == VIRGA_GLASS_DRAW_BEHIND
                                                                                   : side == VIRGA_GLASS_DRAW_BEFORE;
}

virga_result glass_prepare_sharing(virga_glass *glass, VkCommandBuffer cmd, const virga_view *view,
                                   const virga_glass_pose *pose, double time_s, glass_plate *plate,
                                   virga_prepared *prepared)
{
    if (prepared)
        *prepared = 0;
    if (!glass)
        return VIRGA_ERROR_INVALID;
    virga_context *context = glass->base.context;
    struct glass_picture *picture = &glass->picture;
    virga_result result = check_prepare(glass, cmd, view, pose, time_s);
    if (result)
        return result;
    virga_timers_reset(context, cmd);
    glass_first_contents(glass, cmd);
    glass_view_block block;
    uint32_t index;
    fill_view(glass, view, pose, time_s, &block);
    result = virga_effect_push_view(&glass->base, "virga_glass_prepare", &picture->view_ring, &block, sizeof block,
                                    &index, &picture->view_offset);
    if (result)
        return result;
    VkImageView copies;
    const bool makes_copies = choose_copies(glass, view, &block, plate, &copies);
    const VkDescriptorSet set = glass_picture_write_set(glass, index, view, copies);
    record_prepare(glass, cmd, view, &block, set, makes_copies);
    virga_effect_set_view(&glass->base, set, picture->view_offset, view, prepared);
    glass_prepared *seen = &picture->prepared[glass->base.slot];
    seen->draw = draw_of(glass, view, pose);
    seen->plate = view->color.view != VK_NULL_HANDLE;
    seen->style = glass->settings.style;
    seen->shapes = !glass_is_all_textured(&glass->settings);
    seen->textures = glass_is_textured(&glass->settings);
    seen->front = glass_is_front(&glass->settings);
    fill_fog_order(glass, seen);
    return virga_recording_result(context);
}

virga_result virga_glass_prepare_view(virga_glass *glass, VkCommandBuffer cmd, const virga_view *view,
                                      const virga_glass_pose *pose, double time_s, virga_prepared *prepared)
{
    glass_plate plate = {0};
    return glass_prepare_sharing(glass, cmd, view, pose, time_s, &plate, prepared);
}

virga_result virga_glass_prepare(virga_glass *glass, VkCommandBuffer cmd, const virga_view *view,
                                 const virga_glass_pose *pose, double time_s)
{
    return virga_glass_prepare_view(glass, cmd, view, pose, time_s, NULL);
}

static bool panes_of_one_context(const virga_glass_pane *panes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (!panes[i].glass)
            return false;
        else if (panes[i].glass->base.context != panes[0].glass->base.context) {
            virga_wrong_argument(&panes[0].glass->base.context->log,
                                 "virga_glass_prepare_panes: expected panes of one context, but pane %u is of another",
                                 i);
            return false;
        }
    return true;
}

virga_result virga_glass_prepare_panes(VkCommandBuffer cmd, const virga_view *view, virga_glass_pane *panes,
                                       uint32_t count)
{
    virga_result result = VIRGA_OK;
    glass_plate plate = {0};
    for (uint32_t i = 0; panes && i < count; i++)
        panes[i].prepared = 0; /* also of those after an error */
    if (count && (!panes || !panes_of_one_context(panes, count)))
        return VIRGA_ERROR_INVALID;
    for (uint32_t i = 0; i < count && result >= 0; i++) {
        const virga_result prepared = glass_prepare_sharing(panes[i].glass, cmd, view, &panes[i].pose, panes[i].time_s,
                                                            &plate, &panes[i].prepared);
        result = prepared ? prepared : result;
    }
    return result;
}

void virga_glass_map_get(const virga_glass *glass, virga_glass_map *map)
{
    if (!map)
        return;
    *map = (virga_glass_map){0};
    if (!glass || !glass->picture.whole_map || !glass->picture.columns)
        return;
    const virga_image_2d *image = glass->picture.map_of_view[glass->base.newest_slot];
    *map = (virga_glass_map){image->layer_views[0], image->image, glass->picture.columns, glass->picture.rows};
}

/* ---- draw */

#define ALONE  VIRGA_GLASS_DRAW_ALONE
#define PLATE  VIRGA_GLASS_DRAW_PLATE
#define DEPTH  VIRGA_GLASS_DRAW_DEPTH
#define PAPER  VIRGA_GLASS_DRAW_PAPER
#define OPAQUE VIRGA_GLASS_DRAW_OPAQUE

static const uint32_t physical[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
static const uint32_t paper_draws[4] = {ALONE, ALONE | DEPTH, PLATE, PLATE | DEPTH};
static const uint32_t refraction_draws[4] = {0, DEPTH, PAPER, PAPER | DEPTH};
static const uint32_t textured_draws[2] = {0, DEPTH};
static const uint32_t fog_draws[4] = {0, DEPTH, VIRGA_GLASS_DRAW_DROPLETS, VIRGA_GLASS_DRAW_DROPLETS | DEPTH};
static const uint32_t solid_fog_draws[4] = {OPAQUE, OPAQUE | DEPTH, OPAQUE | VIRGA_GLASS_DRAW_DROPLETS,
                                            OPAQUE | VIRGA_GLASS_DRAW_DROPLETS | DEPTH};
static const uint32_t front_draws[2] = {0, VIRGA_GLASS_DRAW_LAMPS};
static const uint32_t mist_draws[8] = {ALONE,          ALONE | DEPTH,          PLATE,          PLATE | DEPTH,
                                       ALONE | OPAQUE, ALONE | DEPTH | OPAQUE, PLATE | OPAQUE, PLATE | DEPTH | OPAQUE};

/* In the order of the GLASS_DRAW_... indices. */
const virga_effect_draw glass_draws[GLASS_DRAW_ROWS] = {
    {"glass.physical", VIRGA_VERTEX_FORM(glass_draw_pane_vert), VIRGA_FRAGMENT_FORMS(glass_draw_physical_frag),
     physical, 16},
    {"glass.paper", VIRGA_VERTEX_FORM(glass_draw_paper_vert), VIRGA_FRAGMENT_FORMS(glass_draw_paper_frag), paper_draws,
     4},
    {"glass.refraction", VIRGA_VERTEX_FORM(glass_draw_pane_vert), VIRGA_FORM(glass_draw_refraction_frag),
     refraction_draws, 4, .replace = true},
    {"glass.mist", VIRGA_VERTEX_FORM(glass_draw_mist_vert), VIRGA_FORM(glass_draw_mist_frag), mist_draws, 8},
    {"glass.textured", VIRGA_VERTEX_FORM(glass_draw_drop_vert), VIRGA_FRAGMENT_FORMS(glass_draw_drop_frag),
     textured_draws, 2},
    {"glass.textured_refraction", VIRGA_VERTEX_FORM(glass_draw_drop_vert), VIRGA_FORM(glass_draw_drop_refraction_frag),
     textured_draws, 2, .replace = true},
    {"glass.front", VIRGA_VERTEX_FORM(glass_draw_drop_vert), VIRGA_FRAGMENT_FORMS(glass_draw_front_frag), front_draws,
     2, .no_depth = true},
    {"glass.fog", VIRGA_VERTEX_FORM(glass_draw_fog_vert), VIRGA_FORM(glass_draw_fog_frag), fog_draws, 4},
    {"glass.solid_fog", VIRGA_VERTEX_FORM(glass_draw_fog_vert), VIRGA_FORM(glass_draw_fog_frag), solid_fog_draws, 4},
};

enum {
    ROW_PHYSICAL,
    ROW_PAPER,
    ROW_REFRACTION,
    ROW_MIST,
    ROW_TEXTURED,
    ROW_TEXTURED_REFRACTION,
    ROW_FRONT,
    ROW_FOG,
    ROW_SOLID_FOG
};

/* As choose_draws chooses. */
uint32_t glass_wanted_draws(const void *glass, const void *given)
{
    (void)glass;
    const virga_glass_settings *settings = given;
    uint32_t rows = !glass_shows_fog(settings) ? 0 : 1u << (settings->opaque ? ROW_SOLID_FOG : ROW_FOG);
    if (!glass_is_all_textured(settings))
        rows |= 1u << ROW_REFRACTION | 1u << (settings->style == VIRGA_GLASS_STYLE_PAPER ? ROW_PAPER : ROW_PHYSICAL);
    if (glass_is_front(settings))
        return rows | 1u << ROW_FRONT;
    if (glass_is_textured(settings))
        rows |= 1u << ROW_TEXTURED | 1u << ROW_TEXTURED_REFRACTION;
    return rows | 1u << ROW_MIST;
}

uint32_t glass_draw_constant(const void *glass)
{
    return ((const virga_glass *)glass)->picture.filtered ? 0 : VIRGA_GLASS_DRAW_BY_HAND;
}

static void record_draw(virga_glass *glass, VkCommandBuffer cmd, const virga_pipeline *pipeline, size_t arguments)
{
    virga_draw_indexed_indirect(glass->base.context, cmd, pipeline, glass->picture.work->buffer, arguments);
}

static void begin_draw(virga_glass *glass, VkCommandBuffer cmd)
{
    const virga_effect_view *view = virga_effect_selected(&glass->base);
    virga_set_draw_area(glass->base.context, cmd, view->viewport);
    bind(glass, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, view->set, view->offset);
    glass->base.context->vk.CmdBindIndexBuffer(cmd, glass->picture.corners->buffer, 0, VK_INDEX_TYPE_UINT32);
}

/* The draws of a pane, in this order. */
enum {
    DRAW_FOG_BEHIND,
    DRAW_DROPLETS_BEHIND,
    DRAW_MIST,
    DRAW_SHAPES,
    DRAW_TEXTURED,
    DRAW_FOG_BEFORE,
    DRAW_DROPLETS_BEFORE,
    DRAWS
};

/* The pipelines for a view; NULL: nothing to draw. */
static void choose_draws(const glass_prepared *seen, const virga_effect_target *found, bool refraction,
                         const virga_pipeline *used[DRAWS])
{
    const uint32_t depth = seen->draw & VIRGA_GLASS_DRAW_DEPTH;
    const uint32_t plate = seen->plate ? GLASS_DRAW_OF_PLATE : 0;
    const bool paper = seen->style == VIRGA_GLASS_STYLE_PAPER;
    const bool opaque = (seen->draw & VIRGA_GLASS_DRAW_SIDE) == VIRGA_GLASS_DRAW_OPAQUE;
    const uint32_t solid = opaque ? GLASS_DRAW_OF_SOLID : 0;
    const uint32_t shapes = refraction ? GLASS_DRAW_REFRACTION + depth + (paper ? GLASS_DRAW_OF_PAPER : 0)
                            : paper    ? GLASS_DRAW_PAPER + depth + plate
                                       : GLASS_DRAW_PHYSICAL + seen->draw;
    const uint32_t textured = (refraction ? GLASS_DRAW_TEXTURED_REFRACTION : GLASS_DRAW_TEXTURED) + depth;
    used[DRAW_MIST] = refraction ? NULL : found->draws[GLASS_DRAW_MIST + solid + plate + depth];
    used[DRAW_SHAPES] = seen->shapes ? found->draws[shapes] : NULL;
    used[DRAW_TEXTURED] = seen->textures ? found->draws[textured] : NULL;
    used[DRAW_FOG_BEHIND] = used[DRAW_FOG_BEFORE] = NULL;
    used[DRAW_DROPLETS_BEHIND] = used[DRAW_DROPLETS_BEFORE] = NULL;
    if (seen->fog && !refraction) {
        const uint32_t fog = (opaque ? GLASS_DRAW_SOLID_FOG : GLASS_DRAW_FOG) + depth;
        used[seen->fog_before ? DRAW_FOG_BEFORE : DRAW_FOG_BEHIND] = found->draws[fog];
        used[seen->fog_before ? DRAW_DROPLETS_BEFORE : DRAW_DROPLETS_BEHIND] =
            found->draws[fog + GLASS_DRAW_OF_DROPLETS];
    }
    if (seen->front) {
        /* What film and mist do to a lens is not drawn, and no pixel of a disc out of focus looks up one other. */
        used[DRAW_MIST] = NULL;
        used[DRAW_TEXTURED] =
            refraction ? NULL : found->draws[GLASS_DRAW_FRONT + (seen->draw & VIRGA_GLASS_DRAW_LAMPS ? 1 : 0)];
    }
}

static virga_result draws_ready(const virga_pipeline *const used[DRAWS])
{
    virga_result result = VIRGA_OK;
    for (int i = 0; i < DRAWS && !result; i++)
        result = used[i] ? virga_pipelines_ready(&used[i], 1) : VIRGA_OK;
    return result;
}

static virga_result draw(virga_glass *glass, VkCommandBuffer cmd, const virga_target *target, virga_prepared prepared,
                         bool refraction, const char *call)
{
    virga_context *context = glass->base.context;
    const virga_effect_target *found;
    virga_result result = virga_effect_check_draw(&glass->base, call, cmd, target, prepared, glass->ticks, &found);
    if (result)
        return result;
    const virga_pipeline *used[DRAWS];
    choose_draws(&glass->picture.prepared[glass->base.slot], found, refraction, used);
    result = draws_ready(used);
    if (result)
        return result;
    const size_t fog = offsetof(virga_glass_work_gpu, fog), droplets = fog + sizeof(virga_glass_corners_gpu);
    const size_t arguments[DRAWS] = {fog,
                                     droplets,
                                     offsetof(virga_glass_work_gpu, mist),
                                     offsetof(virga_glass_work_gpu, drops),
                                     offsetof(virga_glass_work_gpu, quads),
                                     fog,
                                     droplets};
    const virga_pass_scope scope = virga_draw_begin(context, cmd, refraction ? "glass.refraction" : "glass.draw");
    begin_draw(glass, cmd);
    for (int i = 0; i < DRAWS; i++)
        if (used[i])
            record_draw(glass, cmd, used[i], arguments[i]);
    virga_pass_end(context, cmd, scope);
    return VIRGA_OK;
}

virga_result glass_draw(virga_glass *glass, VkCommandBuffer cmd, const virga_target *target, virga_prepared prepared,
                        const char *call)
{
    return draw(glass, cmd, target, prepared, false, call);
}

virga_result virga_glass_draw_refraction(virga_glass *glass, VkCommandBuffer cmd, const virga_target *target)
{
    return glass ? draw(glass, cmd, target, virga_effect_newest(&glass->base), true, "virga_glass_draw_refraction")
                 : VIRGA_ERROR_INVALID;
}

virga_result virga_glass_draw_refraction_view(virga_glass *glass, VkCommandBuffer cmd, const virga_target *target,
                                              virga_prepared prepared)
{
    return glass ? draw(glass, cmd, target, prepared, true, "virga_glass_draw_refraction_view") : VIRGA_ERROR_INVALID;
}
