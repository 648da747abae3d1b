/* ground/ground_step.c - one step: the window follows the camera, drops land, water flows, maps are written. */
#include "ground/ground_internal.h"

#include "core/settings.h"
#include "gpu/checks.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <virga/drops.h>
#include <virga/shared/exchange.h>

#include <math.h>
#include <string.h>

#define COPY        (VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT)
#define NEVER_SEEN  0x80000000u /* as in shaders/ground/tile_load.comp */
#define FLOW_PASSES 4           /* in a round: one for each of the four sides of a cell, see flow.comp */
#define TILE_GROUPS (VIRGA_GROUND_TILE_CELLS / VIRGA_GROUND_GROUP)

/* ---- statistics */

static uint64_t count_of(const ground_readback *read, uint32_t index)
{
    return (uint64_t)read->counts[index].high << 32 | read->counts[index].low;
}

void ground_read_statistics(void *object, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data)
{
    (void)ring_slot;
    (void)parts;
    virga_ground *ground = object;
    ground_readback read;
    memcpy(&read, data, sizeof read);
    virga_ground_stats *stats = &ground->stats;
    stats->frame_index = frame;
    stats->flown_nl = count_of(&read, VIRGA_GROUND_FLOWN);
    stats->returned_nl = count_of(&read, VIRGA_GROUND_RETURNED);
    stats->spray_nl = count_of(&read, VIRGA_GROUND_SPRAY);
    stats->spray_off_ground_nl = count_of(&read, VIRGA_GROUND_SPRAY_OFF);
    stats->touched_nl = count_of(&read, VIRGA_GROUND_TOUCHED);
    stats->taken_nl = count_of(&read, VIRGA_GROUND_TAKEN);
    stats->given_nl = count_of(&read, VIRGA_GROUND_GIVEN);
    stats->given_off_ground_nl = count_of(&read, VIRGA_GROUND_GIVEN_OFF);
    stats->thrown_nl = count_of(&read, VIRGA_GROUND_THROWN);
    stats->start_nl = count_of(&read, VIRGA_GROUND_STARTED);
    stats->landed_nl = count_of(&read, VIRGA_GROUND_LANDED);
    stats->off_ground_nl = count_of(&read, VIRGA_GROUND_OFF_GROUND);
    stats->infiltrated_nl = count_of(&read, VIRGA_GROUND_INFILTRATED);
    stats->run_off_nl = count_of(&read, VIRGA_GROUND_RUN_OFF);
    stats->evaporated_nl = count_of(&read, VIRGA_GROUND_EVAPORATED);
    stats->evicted_nl = count_of(&read, VIRGA_GROUND_EVICTED);
    stats->film_nl = count_of(&read, VIRGA_GROUND_FILM);
    stats->puddles_nl = count_of(&read, VIRGA_GROUND_PUDDLES);
    stats->held_nl = count_of(&read, VIRGA_GROUND_HELD);
    stats->cached_nl = count_of(&read, VIRGA_GROUND_CACHED);
    for (uint32_t i = 0; i < VIRGA_GROUND_STATES; i++)
        stats->cells[i] = read.counts[VIRGA_GROUND_CELLS + i].low;
}

/* The tiles are where they were before a lost move. If the window has moved again since then, the cells of both moves
 * are mixed up: all tiles start anew. */
void ground_lost(void *object, uint64_t frame, uint32_t did)
{
    virga_ground *ground = object;
    if (did & GROUND_DID_MOVE && ground->move_frame == frame)
        ground_window_undo(&ground->window);
    else if (did & GROUND_DID_MOVE)
        ground_window_forget(&ground->window);
    else if (did & GROUND_DID_HEIGHTS)
        ground->redraw_heights = true;
    if (did & GROUND_DID_BLOCKS)
        ground->list_blocks = true;
    if (did & GROUND_DID_FAR_HEIGHTS)
        ground->far.is_placed = false;
    if (did & GROUND_DID_FAR_MAP)
        ground->far.drawn = false;
    ground->stats.tiles_cached = ground->window.cached_count;
}

/* The undo of a move is for the state before the load. A list of blocks that was loaded is not trusted. */
void ground_state_loaded(void *object)
{
    virga_ground *ground = object;
    ground->move_frame = 0;
    ground->list_blocks = true;
    ground->far.can_repeat = false; /* the map was drawn by a tick that the state does not have */
    ground_wakes_live(ground);
    ground->stats.tiles_cached = ground->window.cached_count;
}

/* ---- constants of a tick */

/* Without a material map, the offset is outside of all cells. */
static void fill_material_map(const virga_ground *ground, virga_ground_tick_gpu *out)
{
    const virga_ground_material_map *map = &ground->info.materials;
    const double cell = (double)ground->def.cell_m;
    for (int axis = 0; axis < 2; axis++) {
        const double size = map->high_m[axis] - map->low_m[axis];
        const double corner = ground->window.low[axis] * (double)VIRGA_GROUND_TILE * cell;
        const bool given = map->image.view && size > 0;
        out->material_scale[axis] = given ? (float)(cell / size) : 0;
        out->material_offset[axis] = given ? (float)((corner - map->low_m[axis]) / size) : -1;
    }
}

/* All rain is represented by drops of one diameter. */
static void fill_rain(const virga_ground *ground, virga_ground_tick_gpu *out)
{
    const double diameter = (double)ground->info.open_drop_m;
    out->rain_drop_m = (float)diameter;
    if (diameter > 0)
        out->rain_per_m2_s = (float)((double)ground->info.open_rain_mm_h / 3.6e6 / virga_drop_volume(diameter));
}

/* From the low corner of the window, at the height base_m. */
static void fill_offset(const virga_ground *ground, const double origin_m[3], float offset[3])
{
    const double tile_m = VIRGA_GROUND_TILE * (double)ground->def.cell_m;
    offset[0] = (float)(origin_m[0] - ground->window.low[0] * tile_m);
    offset[1] = (float)(origin_m[1] - ground->base_m);
    offset[2] = (float)(origin_m[2] - ground->window.low[1] * tile_m);
}

/* The cells that are wholly in the region, and in the window. A millionth of a cell does not count. */
static void fill_exchange(const virga_ground *ground, virga_ground_tick_gpu *out)
{
    const virga_ground_exchange *exchange = &ground->info.exchange;
    const double cell = (double)ground->def.cell_m;
    if (!exchange->buffer)
        return;
    fill_offset(ground, exchange->origin_m, out->exchange_offset);
    for (int axis = 0; axis < 2; axis++) {
        const double low = ground->window.low[axis] * (double)VIRGA_GROUND_TILE;
        const double first = ceil(exchange->low_m[axis] / cell - 1e-6),
                     end = floor(exchange->high_m[axis] / cell + 1e-6);
        out->region_low[axis] = (int32_t)fmin(fmax(first, low), low + ground->def.cells);
        out->region_high[axis] = (int32_t)fmin(fmax(end, low), low + ground->def.cells);
    }
}

/* Particles of simulated water touch the ground from a spacing above it on. */
static void fill_water(const virga_ground *ground, virga_ground_tick_gpu *out)
{
    const virga_ground_step_info *info = &ground->info;
    if (!info->water)
        return;
    out->water_count = info->water_count;
    out->water_reach_m = info->water_spacing_m;
    fill_offset(ground, info->water_origin_m, out->water_offset);
}

static void fill_tick(const virga_ground *ground, uint32_t tick, virga_ground_tick_gpu *out)
{
    const double cell = (double)ground->def.cell_m, area = cell * cell;
    memset(out, 0, sizeof *out);
    out->tiles = ground->window.tiles;
    out->tick = tick;
    for (int axis = 0; axis < 2; axis++) {
        out->low_tile[axis] = ground->window.low[axis];
        const double corner = ground->window.low[axis] * (double)VIRGA_GROUND_TILE * cell;
        out->window_high[axis * 2] = (float)corner;
        out->window_low[axis * 2] = (float)(corner - (double)(float)corner);
    }
    out->cell_m = (float)cell;
    out->inv_cell_m = (float)(1 / cell);
    out->nl_per_um = (int)ground_nl_per_um(ground);
    out->m_per_nl = (float)(1e-12 / area);
    out->seed = ground->def.seed;
    out->flow_s = (float)(ground->def.tick_s * ground->def.flow_ticks);
    out->evaporation_nl_s = (float)((double)ground->settings.evaporation_mm_h / 3600 * area * 1e9);
    out->height_map_top_m = (float)GROUND_HEIGHT_MAP_TOP_M;
    out->height_map_depth_m = (float)GROUND_HEIGHT_MAP_DEPTH_M;
    out->base_m = (float)ground->base_m;
    const double side_m = ground->def.ripple_texels * (double)ground->def.ripple_texel_m;
    for (int axis = 0; axis < 2; axis++)
        out->ripple_low_m[axis] =
            (float)(ground->ripple_low_m[axis] - ground->window.low[axis] * (double)VIRGA_GROUND_TILE * cell);
    out->ripple_side_m = (float)side_m;
    out->tick_s = (float)ground->def.tick_s;
    out->wake_waves = ground->settings.wake_waves;
    out->last_tick = tick ? tick : ground->last_tick;
    out->max_spawns = ground->info.splash_rules ? ground->def.max_spawns : 0;
    out->max_impacts = ground->def.max_impacts;
    out->max_returned_droplets = ground->def.max_returned_droplets;
    out->tick_in_step = ground->tick_in_step;
    for (int axis = 0; axis < 3; axis++)
        out->camera[axis] = (float)ground->info.camera_m[axis];
    fill_material_map(ground, out);
    fill_water(ground, out);
    fill_exchange(ground, out);
    ground_contacts_fill(ground, out);
    ground_streams_fill(ground, out);
    ground_fill_soils(&ground->settings, cell, out->soils);
    ground_standing_fill(ground->standing, out->soils, out->standing);
    ground_far_fill(ground, out);
    fill_rain(ground, out);
}

static void push_tick(virga_ground *ground, uint32_t tick)
{
    virga_ground_tick_gpu block;
    fill_tick(ground, tick, &block);
    ground->far.tick = block;
    ground->tick_offset = virga_ring_push(ground->base.context, &ground->tick_ring, &block, sizeof block);
}

static void bind_source(virga_ground *ground, VkCommandBuffer cmd, uint32_t source)
{
    const uint32_t offsets[2] = {ground->tick_offset, ground->list_offset};
    virga_bind(ground->base.context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, ground->bindings, ground->sets[source], 2,
               offsets);
}

static void bind(virga_ground *ground, VkCommandBuffer cmd)
{
    bind_source(ground, cmd, GROUND_DROPS);
}

/* A 2D dispatch over whole tiles, see group_index() in shaders/ground/cells.glsl. */
static void dispatch_cells(virga_ground *ground, VkCommandBuffer cmd, const virga_pipeline *pipeline, uint32_t groups)
{
    virga_dispatch_2d(ground->base.context, cmd, pipeline, groups / TILE_GROUPS, TILE_GROUPS);
}

/* The same over the blocks that have ground: see shaders/ground/blocks.glsl. */
static void dispatch_blocks(virga_ground *ground, VkCommandBuffer cmd, const virga_pipeline *pipeline, size_t groups)
{
    const VkDeviceSize head = (VkDeviceSize)ground->def.cells * ground->def.cells * sizeof(virga_floor_gpu);
    virga_dispatch_indirect(ground->base.context, cmd, pipeline, ground->floors->buffer, head + groups);
}

/* ---- the window follows the camera */

static void copy_tiles(virga_ground *ground, VkCommandBuffer cmd, const virga_buffer *from, const virga_buffer *to,
                       const uint32_t *from_slots, const uint32_t *to_slots, uint32_t count)
{
    /* The spots of a tile have the same size. */
    const VkDeviceSize bytes = VIRGA_GROUND_TILE_CELLS * sizeof(virga_cell_gpu);
    uint32_t copies = 0;
    for (uint32_t i = 0; i < count; i++)
        if (from_slots[i] != GROUND_NEW)
            ground->copies[copies++] = (VkBufferCopy){from_slots[i] * bytes, to_slots[i] * bytes, bytes};
    if (copies)
        ground->base.context->vk.CmdCopyBuffer(cmd, from->buffer, to->buffer, copies, ground->copies);
}

static void clear_tiles(virga_ground *ground, VkCommandBuffer cmd, const virga_buffer *buffer)
{
    const ground_move *move = &ground->move;
    const VkDeviceSize bytes = VIRGA_GROUND_TILE_CELLS * sizeof(virga_cell_gpu);
    for (uint32_t i = 0; i < move->entering_count; i++)
        if (move->entering_from[i] == GROUND_NEW)
            ground->base.context->vk.CmdFillBuffer(cmd, buffer->buffer, move->entering[i] * bytes, bytes, 0);
}

/* Clears the cache slots of restored tiles, so that their water is not counted twice. */
static void clear_restored(virga_ground *ground, VkCommandBuffer cmd)
{
    const ground_move *move = &ground->move;
    const VkDeviceSize bytes = VIRGA_GROUND_TILE_CELLS * sizeof(virga_cell_gpu);
    for (uint32_t i = 0; i < move->entering_count; i++)
        if (move->entering_from[i] != GROUND_NEW)
            ground->base.context->vk.CmdFillBuffer(cmd, ground->cached_cells->buffer, move->entering_from[i] * bytes,
                                                   bytes, 0);
}

static void transfer_barrier(virga_ground *ground, VkCommandBuffer cmd)
{
    virga_wait(ground->base.context, cmd, VIRGA_PASSES | VIRGA_COPIES, VIRGA_PASSES | VIRGA_COPIES);
}

static void move_tiles(virga_ground *ground, VkCommandBuffer cmd)
{
    const ground_move *move = &ground->move;
    const virga_buffer *cells = ground->cells;
    if (move->forgotten_count) {
        dispatch_cells(ground, cmd, ground->tile_discard, move->forgotten_count * TILE_GROUPS);
        transfer_barrier(ground, cmd);
    }
    copy_tiles(ground, cmd, cells, ground->cached_cells, move->leaving, move->leaving_to, move->leaving_count);
    copy_tiles(ground, cmd, ground->spots, ground->cached_spots, move->leaving, move->leaving_to, move->leaving_count);
    transfer_barrier(ground, cmd);
    copy_tiles(ground, cmd, ground->cached_cells, cells, move->entering_from, move->entering, move->entering_count);
    copy_tiles(ground, cmd, ground->cached_spots, ground->spots, move->entering_from, move->entering,
               move->entering_count);
    clear_tiles(ground, cmd, cells);
    clear_tiles(ground, cmd, ground->spots);
    transfer_barrier(ground, cmd);
    clear_restored(ground, cmd);
    transfer_barrier(ground, cmd);
}

static void draw_height_map(virga_ground *ground, VkCommandBuffer cmd, const virga_ground_step_info *info)
{
    const double side = ground->def.cells * (double)ground->def.cell_m;
    virga_map_view view = {.half_m = 0.5 * side, .height_m = GROUND_HEIGHT_MAP_DEPTH_M, .ground_only = true};
    for (int axis = 0; axis < 2; axis++)
        view.origin_m[axis * 2] =
            ground->window.low[axis] * (double)VIRGA_GROUND_TILE * (double)ground->def.cell_m + 0.5 * side;
    view.origin_m[1] = ground->base_m;
    view.top_m = GROUND_HEIGHT_MAP_TOP_M;
    virga_mesh_map_draw(ground->base.context, cmd, ground->height_map, 0, &view, info->meshes, info->mesh_count);
    dispatch_cells(ground, cmd, ground->tile_load, ground->move.entering_count * TILE_GROUPS);
    virga_compute_barrier(ground->base.context, cmd);
}

/* Passes over ground run on blocks that have some. Until the first contents of floors are sure to be there, the list is
 * made in each step: what they are filled with is no list. */
static void list_blocks(virga_ground *ground, VkCommandBuffer cmd)
{
    virga_context *context = ground->base.context;
    const uint32_t blocks = ground->def.cells * ground->def.cells / VIRGA_GROUND_BLOCK;
    virga_dispatch(context, cmd, ground->block_mark, blocks);
    virga_compute_barrier(context, cmd);
    virga_dispatch(context, cmd, ground->block_list, 1);
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_PASSES | VIRGA_ARGUMENTS);
    ground->base.journal.doing |= GROUND_DID_BLOCKS;
    ground->list_blocks = false;
    ground->listed_blocks = true;
}

static void write_lists(virga_ground *ground)
{
    ground_lists lists = {0};
    for (uint32_t i = 0; i < ground->move.entering_count; i++)
        lists.entering[i] = ground->move.entering[i] | (ground->move.entering_from[i] == GROUND_NEW ? NEVER_SEEN : 0);
    memcpy(lists.forgotten, ground->move.forgotten, ground->move.forgotten_count * sizeof lists.forgotten[0]);
    ground->list_offset = virga_ring_write(ground->base.context, &ground->list_ring, 0, &lists, sizeof lists);
}

/* Marks all tiles of the window as entering, so that their heights are drawn again. */
static void enter_all(ground_move *move, uint32_t tiles)
{
    move->entering_count = tiles * tiles;
    for (uint32_t i = 0; i < move->entering_count; i++) {
        move->entering[i] = i;
        move->entering_from[i] = 0; /* their water is already in the window */
    }
}

static void follow(virga_ground *ground, VkCommandBuffer cmd, const virga_ground_step_info *info)
{
    const double tile_m = VIRGA_GROUND_TILE * (double)ground->def.cell_m;
    int32_t low[2];
    ground_window_wanted(&ground->window, info->camera_m, tile_m, low);
    ground_window_move(&ground->window, low, &ground->move);
    const bool moved = ground->move.entering_count > 0;
    const bool far = ground_far_follow(ground, info->camera_m) || (ground->redraw_heights && ground->def.far_cells);
    ground->list_blocks = ground->list_blocks || moved || ground->redraw_heights || ground->far.is_uncertain;
    ground->listed_blocks = false;
    if (!far && !ground->list_blocks)
        return;
    const virga_pass_scope scope = virga_pass_begin(ground->base.context, cmd, "ground.window");
    write_lists(ground);
    push_tick(ground, 0);
    bind(ground, cmd);
    if (far)
        ground_far_draw_heights(ground, cmd, info);
    if (moved) {
        move_tiles(ground, cmd);
        ground->move_frame = ground->base.context->frame_index;
        ground->base.journal.doing |= GROUND_DID_MOVE;
    }
    if (ground->redraw_heights && !moved) {
        enter_all(&ground->move, ground->window.tiles);
        write_lists(ground);
    }
    if (moved || ground->redraw_heights) {
        draw_height_map(ground, cmd, info);
        ground->base.journal.doing |= GROUND_DID_HEIGHTS;
    }
    /* After a move only new tiles were drawn: the next step draws all. */
    ground->redraw_heights = ground->redraw_heights && moved;
    if (ground->list_blocks)
        list_blocks(ground, cmd);
    virga_pass_end(ground->base.context, cmd, scope);
}

/* ---- ticks */

/* A pass over the impacts of the tick and, in the first tick of a step, over the droplets that splashes return. */
static void over_water(virga_ground *ground, VkCommandBuffer cmd, const virga_pipeline *pipeline)
{
    virga_context *context = ground->base.context;
    const virga_ground_step_info *info = &ground->info;
    const VkDeviceSize groups = offsetof(virga_impacts_gpu, group_count);
    bind_source(ground, cmd, GROUND_DROPS);
    virga_dispatch_indirect(context, cmd, pipeline, info->impacts, info->impacts_offset + groups);
    if (info->returned_droplets && ground->tick_in_step == 0) {
        bind_source(ground, cmd, GROUND_RETURNS);
        virga_dispatch_indirect(context, cmd, pipeline, info->returned_droplets,
                                info->returned_droplets_offset + groups);
    }
    virga_compute_barrier(context, cmd);
}

/* Assigns slots to new splashes, in the order of drops. */
static void find_spawns(virga_ground *ground, VkCommandBuffer cmd)
{
    const virga_pass_scope scope = virga_pass_begin(ground->base.context, cmd, "ground.spawn");
    over_water(ground, cmd, ground->spawn_mark);
    bind_source(ground, cmd, GROUND_DROPS);
    virga_dispatch(ground->base.context, cmd, ground->spawn_scan, 1);
    virga_compute_barrier(ground->base.context, cmd);
    if (ground->info.returned_droplets && ground->tick_in_step == 0) {
        bind_source(ground, cmd, GROUND_RETURNS);
        virga_dispatch(ground->base.context, cmd, ground->spawn_scan, 1);
        virga_compute_barrier(ground->base.context, cmd);
    }
    virga_pass_end(ground->base.context, cmd, scope);
}

/* Number of flow passes that are complete after `ticks` ticks. */
static uint64_t flow_passes(const virga_ground *ground, uint64_t ticks)
{
    return ticks * FLOW_PASSES / ground->def.flow_ticks;
}

/* Records this tick's flow passes. A round is spread evenly over its ticks, so that no tick runs all of it. */
static void flow(virga_ground *ground, VkCommandBuffer cmd)
{
    const uint64_t end = flow_passes(ground, ground->ticks + 1);
    for (uint64_t pass = flow_passes(ground, ground->ticks); pass < end; pass++) {
        const uint32_t pairs = (uint32_t)(pass % FLOW_PASSES);
        const virga_pass_scope scope = virga_pass_begin(ground->base.context, cmd, "ground.flow");
        ground->base.context->vk.CmdPushConstants(cmd, ground->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof pairs,
                                                  &pairs);
        dispatch_blocks(ground, cmd, ground->flow, offsetof(virga_ground_blocks_gpu, flow_groups));
        virga_compute_barrier(ground->base.context, cmd);
        virga_pass_end(ground->base.context, cmd, scope);
    }
}

/* Area of the spots x diameter of their drops / volume of the rain. A drop of diameter d leaves a spot of
 * pi (SPREAD d)^2 / 4 and has the volume pi d^3 / 6. */
#define SPOTS_OF_RAIN (1.5 * VIRGA_GROUND_SPREAD * VIRGA_GROUND_SPREAD)

/* Rain on the cells without simulated drops. */
static void stand_in_rain(virga_ground *ground)
{
    const double cell = (double)ground->def.cell_m, mm_nl = cell * cell * 1e9, hours = ground->def.tick_s / 3600;
    const double rain_mm = (double)ground->info.open_rain_mm_h * hours;
    const double drop_mm = (double)ground->info.open_drop_m * 1e3;
    const ground_weather weather = {.rain_nl = rain_mm * mm_nl,
                                    .spots = drop_mm > 0 ? SPOTS_OF_RAIN * rain_mm / drop_mm : 0,
                                    .evaporation_nl = (double)ground->settings.evaporation_mm_h * hours * mm_nl,
                                    .tick_s = ground->def.tick_s,
                                    .nl_per_um = ground_nl_per_um(ground)};
    virga_soil_gpu soils[VIRGA_GROUND_MATERIALS];
    ground_fill_soils(&ground->settings, cell, soils);
    ground_standing_tick(ground->standing, soils, &weather);
}

static void contact(virga_ground *ground, VkCommandBuffer cmd)
{
    if (!ground->info.wheel_count && !ground->info.foot_count)
        return;
    bind_source(ground, cmd, GROUND_CONTACTS);
    ground_contacts_record(ground, cmd);
}

/* A pass over what fell on cells: a GPU looks at all of them, see shaders/ground/cell_pairs.glsl. */
static void settle(virga_ground *ground, VkCommandBuffer cmd, const virga_pipeline *pipeline)
{
    if (ground->base.context->for_software) {
        over_water(ground, cmd, pipeline);
        return;
    }
    bind(ground, cmd);
    dispatch_blocks(ground, cmd, pipeline, offsetof(virga_ground_blocks_gpu, flow_groups));
    virga_compute_barrier(ground->base.context, cmd);
}

static void run_tick(virga_ground *ground, VkCommandBuffer cmd, uint32_t tick)
{
    stand_in_rain(ground);
    push_tick(ground, tick);
    if (ground->info.splash_rules && ground->def.max_spawns)
        find_spawns(ground, cmd);
    virga_pass_scope scope = virga_pass_begin(ground->base.context, cmd, "ground.land");
    over_water(ground, cmd, ground->land);
    bind(ground, cmd);
    virga_dispatch(ground->base.context, cmd, ground->ring, 1);
    settle(ground, cmd, ground->share);
    settle(ground, cmd, ground->soak);
    virga_pass_end(ground->base.context, cmd, scope);
    contact(ground, cmd);
    bind(ground, cmd);
    flow(ground, cmd);
    ground->ticks++;
}

/* Ground that simulated water touches becomes wet. */
static void touch(virga_ground *ground, VkCommandBuffer cmd)
{
    virga_context *context = ground->base.context;
    if (!ground->info.water || !ground->info.water_count)
        return;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "ground.touch");
    push_tick(ground, 0);
    bind(ground, cmd);
    virga_dispatch_and_barrier(context, cmd, ground->touch,
                               (ground->info.water_count + VIRGA_GROUND_GROUP - 1) / VIRGA_GROUND_GROUP);
    virga_pass_end(context, cmd, scope);
}

/* Water comes back from a simulation, then others of the cells give theirs to it. */
static void exchange(virga_ground *ground, VkCommandBuffer cmd)
{
    virga_context *context = ground->base.context;
    const virga_ground_exchange *with = &ground->info.exchange;
    if (!with->buffer)
        return;
    const VkDeviceSize groups = with->offset + offsetof(virga_exchange_gpu, given_groups);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "ground.exchange");
    push_tick(ground, 0);
    bind(ground, cmd);
    virga_dispatch_indirect_and_barrier(context, cmd, ground->receive, with->buffer, groups);
    virga_dispatch_indirect_and_barrier(context, cmd, ground->receive_soak, with->buffer, groups);
    virga_dispatch_and_barrier(context, cmd, ground->take, 1);
    virga_pass_end(context, cmd, scope);
}

static void measure(virga_ground *ground, VkCommandBuffer cmd)
{
    virga_context *context = ground->base.context;
    const VkDeviceSize first = VIRGA_GROUND_FIRST_MEASURED * sizeof(virga_ground_count_gpu);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "ground.measure");
    transfer_barrier(ground, cmd);
    context->vk.CmdFillBuffer(cmd, ground->counts->buffer, first, sizeof(ground_readback) - first, 0);
    transfer_barrier(ground, cmd);
    const uint32_t cached = ground_window_cache_end(&ground->window);
    virga_dispatch(context, cmd, ground->measure, ground->window.tiles * ground->window.tiles);
    if (cached)
        virga_dispatch(context, cmd, ground->measure_cached, cached);
    virga_pass_end(context, cmd, scope);
}

/* The corner of the ripple map is a multiple of its texels, so that waves do not crawl when the camera moves. */
static void place_ripples(virga_ground *ground, const double ripple_center_m[3])
{
    const double texel = (double)ground->def.ripple_texel_m;
    for (int axis = 0; axis < 2; axis++)
        ground->ripple_low_m[axis] = (floor(ripple_center_m[axis * 2] / texel) - ground->def.ripple_texels / 2) * texel;
}

/* Rings, wakes and running water are in lists, which each step brings up to date: the map can be left out where nobody
 * sees it. It is drawn as long as the device may not have executed its first draw, else it would be in no layout. */
static void write_ripples(virga_ground *ground, VkCommandBuffer cmd)
{
    if (ground->info.is_unseen && !ground->far.is_uncertain)
        return;
    virga_context *context = ground->base.context;
    const uint32_t offsets[2] = {ground->tick_offset, ground->list_offset};
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "ground.rings");
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_VERTICES);
    virga_bind(context, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, ground->bindings, ground->sets[GROUND_DROPS], 2, offsets);
    ground_ripples_draw(ground, cmd);
    virga_pass_end(context, cmd, scope);
}

/* The distant map is drawn anew in some ticks only. As long as the frame with its first transition may be lost, it is
 * drawn again as it was, else later frames would read an image in no layout. */
static void write_far_map(virga_ground *ground, VkCommandBuffer cmd)
{
    ground_far *far = &ground->far;
    const bool due = ground_far_is_due(ground);
    if (!due && !(far->is_uncertain && far->can_repeat))
        return;
    if (due) {
        far->drawn_by = far->tick;
        far->can_repeat = true;
    } else {
        ground->tick_offset =
            virga_ring_push(ground->base.context, &ground->tick_ring, &far->drawn_by, sizeof far->drawn_by);
        bind(ground, cmd);
    }
    ground_far_draw(ground, cmd, due);
}

/* Blocks without ground are written where the list is new. It is, as long as the device may not have executed the maps'
 * first transition. */
static void write_near_map(virga_ground *ground, VkCommandBuffer cmd)
{
    virga_context *context = ground->base.context;
    const uint32_t listed = !ground->listed_blocks;
    context->vk.CmdPushConstants(cmd, ground->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof listed, &listed);
    if (listed)
        dispatch_blocks(ground, cmd, ground->map, offsetof(virga_ground_blocks_gpu, map_groups));
    else
        dispatch_cells(ground, cmd, ground->map, ground->def.cells * ground->def.cells / VIRGA_GROUND_GROUP);
}

static void write_maps(virga_ground *ground, VkCommandBuffer cmd)
{
    const virga_pass_scope scope = virga_pass_begin(ground->base.context, cmd, "ground.map");
    write_near_map(ground, cmd);
    write_far_map(ground, cmd);
    virga_wait(ground->base.context, cmd, VIRGA_PASSES,
               VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_VERTICES | VIRGA_FRAGMENTS);
    virga_pass_end(ground->base.context, cmd, scope);
}

/* ---- a step */

static void first_contents(virga_ground *ground, VkCommandBuffer cmd)
{
    virga_context *context = ground->base.context;
    if (!ground->has_base) /* rounded to float, as shaders and hosts receive it */
        ground->base_m = (double)(float)floor(ground->info.camera_m[1]);
    ground->has_base = true;
    const bool first = virga_effect_first_contents(&ground->base, cmd);
    virga_effect_reads(&ground->base, cmd, ground->info.impacts);
    virga_effect_reads(&ground->base, cmd, ground->info.returned_droplets);
    virga_effect_reads(&ground->base, cmd, ground->info.exchange.buffer);
    virga_effect_reads(&ground->base, cmd, ground->info.handed);
    virga_effect_reads(&ground->base, cmd, ground->info.water_count ? ground->info.water : VK_NULL_HANDLE);
    ground->far.is_uncertain = first;
    if (!first)
        return;
    virga_mesh_map_first_layouts(context, cmd, ground->height_map);
    virga_mesh_map_first_layouts(context, cmd, ground->far.height_map);
    if (ground->ripples.upload) {
        ground_ripples_upload(context, cmd, &ground->ripples);
        virga_effect_uploaded(&ground->base, &ground->ripples.upload);
    }
    if (ground->streams.upload) {
        ground_streams_upload(context, cmd, &ground->streams);
        virga_effect_uploaded(&ground->base, &ground->streams.upload);
    }
    transfer_barrier(ground, cmd);
}

static virga_result check_exchange(const virga_ground *ground, const virga_ground_exchange *exchange)
{
    const virga_context *context = ground->base.context;
    const virga_log *log = &context->log;
    if (virga_settings_check_positions(log, "step_info.exchange.origin_m", exchange->origin_m, 3) ||
        virga_settings_check_positions(log, "step_info.exchange.low_m", exchange->low_m, 2) ||
        virga_settings_check_positions(log, "step_info.exchange.high_m", exchange->high_m, 2))
        return VIRGA_ERROR_INVALID;
    if (exchange->buffer && virga_host_list_check(context, "step_info.exchange", exchange->buffer, exchange->offset,
                                                  exchange->size, sizeof(virga_exchange_gpu)))
        return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

static virga_result check_buffers(const virga_ground *ground, const virga_ground_step_info *info)
{
    const virga_context *context = ground->base.context;
    const VkDeviceSize rules_alignment = context->properties.limits.minUniformBufferOffsetAlignment;
    if (virga_host_list_check(context, "step_info.impacts", info->impacts, info->impacts_offset, info->impacts_size,
                              sizeof(virga_impacts_gpu)) ||
        (info->returned_droplets && virga_host_list_check(context, "step_info.returned_droplets",
                                                          info->returned_droplets, info->returned_droplets_offset,
                                                          info->returned_droplets_size, sizeof(virga_impacts_gpu))))
        return VIRGA_ERROR_INVALID;
    if (virga_host_buffer_check(context, "step_info.water", info->water))
        return VIRGA_ERROR_INVALID;
    if (info->water && (info->water_offset % context->properties.limits.minStorageBufferOffsetAlignment ||
                        !(info->water_spacing_m >= 0 && info->water_spacing_m <= 10) ||
                        info->water_count > context->properties.limits.maxStorageBufferRange / 32))
        return virga_wrong_argument(&context->log,
                                    "step_info.water: expected an aligned offset, a spacing of 0 to 10 m, "
                                    "and particles that fit into a storage buffer");
    if (check_exchange(ground, &info->exchange))
        return VIRGA_ERROR_INVALID;
    if (info->splash_rules && info->splash_rules_offset % rules_alignment)
        return virga_wrong_argument(
            &context->log, "step_info.splash_rules_offset: expected a multiple of %llu on this device, got %llu",
            (unsigned long long)rules_alignment, (unsigned long long)info->splash_rules_offset);
    return VIRGA_OK;
}

static virga_result check_step(const virga_ground *ground, VkCommandBuffer cmd, const virga_ground_step_info *info)
{
    if (!ground)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &ground->base.context->log;
    const bool given = info && info->impacts && (!info->mesh_count || info->meshes);
    const virga_result result =
        virga_effect_check_one_step(&ground->base, "virga_ground_step", cmd, given ? info : NULL);
    if (result)
        return result;
    const virga_tick_range ticks = {info->first_tick, info->ticks, ground->def.max_ticks_per_step};
    if (virga_effect_check_ticks(&ground->base, &ticks, ground->ticks ? &ground->last_tick : NULL) ||
        virga_settings_check_positions(log, "step_info.camera_m", info->camera_m, 3) ||
        virga_settings_check_positions(log, "step_info.ripple_center_m", info->ripple_center_m, 3) ||
        virga_settings_check_positions(log, "step_info.water_origin_m", info->water_origin_m, 3) ||
        virga_settings_check_finite(log, "step_info.open_rain_mm_h", &info->open_rain_mm_h, 1) ||
        virga_settings_check_finite(log, "step_info.open_drop_m", &info->open_drop_m, 1) ||
        virga_settings_check_finite(log, "step_info.impacts_reach_m", &info->impacts_reach_m, 1) ||
        virga_settings_check_positions(log, "step_info.materials.low_m", info->materials.low_m, 2) ||
        virga_settings_check_positions(log, "step_info.materials.high_m", info->materials.high_m, 2) ||
        check_buffers(ground, info) || ground_contacts_check(ground, info))
        return VIRGA_ERROR_INVALID;
    if (virga_mesh_map_check(ground->base.context, ground->height_map, info->meshes, info->mesh_count))
        return VIRGA_ERROR_INVALID;
    return virga_effect_ready(&ground->base);
}

virga_result virga_ground_step(virga_ground *ground, VkCommandBuffer cmd, const virga_ground_step_info *info)
{
    const virga_result result = check_step(ground, cmd, info);
    if (result)
        return result;
    virga_context *context = ground->base.context;
    virga_effect_begin_step(&ground->base, cmd);
    ground->info = *info;
    ground->info.open_rain_mm_h = fminf(fmaxf(info->open_rain_mm_h, 0), 1000);
    ground->info.open_drop_m = fminf(fmaxf(info->open_drop_m, 0), 0.01f);
    ground->tick_in_step = 0;
    ground_write_sets(ground);
    first_contents(ground, cmd);
    place_ripples(ground, info->ripple_center_m);
    follow(ground, cmd, info);
    ground->stats.tiles_cached = ground->window.cached_count;
    touch(ground, cmd);
    exchange(ground, cmd);
    if (!info->ticks) {
        push_tick(ground, 0);
        bind(ground, cmd);
    }
    for (; ground->tick_in_step < info->ticks; ground->tick_in_step++)
        run_tick(ground, cmd, info->first_tick + ground->tick_in_step);
    if (info->ticks)
        ground->last_tick = info->first_tick + info->ticks - 1;
    ground_streams_step(ground, cmd);
    write_ripples(ground, cmd);
    if (ground->settings.measure)
        measure(ground, cmd);
    write_maps(ground, cmd);
    virga_effect_copy_statistics(&ground->base, cmd, 0, ground->counts, 0, 0, sizeof(ground_readback));
    return virga_recording_result(context);
}
