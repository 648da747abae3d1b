/* test_scene_unwritten.c - steps that read lists of effects which never wrote them: they never stepped, or only in a
 * frame that the host threw away. Such lists are empty. Software Vulkan runs for ever if it finds the number of
 * workgroups in memory that nobody wrote (LVP_POISON_MEMORY). */
#include "../gpu/gpu_fixture.h"
#include "host_parts.h"

#include <virga/shared/particle.h>

enum { TICKS = 2, SIDE = 5, PARTICLES = SIDE * SIDE * SIDE, EMPTY_BYTES = 65536 };

/* What became of the steps of the effects that write lists, before those that read them take one. */
typedef enum before { NEVER_STEPPED, DROPPED, LOST_UNTOLD } before;

typedef struct effects {
    virga_rain *rain;
    virga_ground *ground;
    virga_splash *splash;
    virga_glass *glass;
    virga_water *water;
    virga_fluid *fluid;
} effects;

typedef struct lists {
    virga_rain_buffer impacts, hits;
    virga_splash_buffer returned, handed;
    virga_fluid_exchange exchange;
    virga_fluid_buffer particles;
    uint32_t particle_count;
    virga_water_leavers leavers;
    VkBuffer spawns;
    VkDeviceSize spawns_size;
    virga_ground_cells cells;
} lists;

typedef struct host {
    gpu_fixture *f;
    virga_context *context;
    effects writers, readers;
    host_buffer empty, block; /* zeros; particles */
    host_buffer vertices, indices;
    uint32_t step; /* number of the step of all effects that are stepped */
    VkCommandBuffer cmd;
} host;

static void make_water(host *h, effects *of)
{
    virga_water_def def = virga_default_water_def();
    virga_fluid_def fluid = virga_default_fluid_def();
    virga_fluid_settings settings = virga_default_fluid_settings();
    const virga_fluid_block block = {.high_m = {0.3f, 0.2f, 0.3f}};
    def.max_particles = 1024;
    def.max_cells = 4096;
    def.max_blocks = 2048;
    def.max_surfels = 8192;
    def.max_spray = 64;
    def.max_width = def.max_height = 16;
    fluid.max_particles = 1024;
    fluid.max_cells = 8192;
    fluid.max_exchanged = 256;
    settings.spacing_m = 0.05f;
    for (int axis = 0; axis < 3; axis++) {
        settings.low_m[axis] = 0;
        settings.high_m[axis] = 0.8f;
    }
    REQUIRE(virga_water_create(h->context, &def, &of->water) == VIRGA_OK);
    REQUIRE(virga_fluid_create(h->context, &fluid, &of->fluid) == VIRGA_OK);
    REQUIRE(virga_fluid_set(of->fluid, &settings) == VIRGA_OK);
    REQUIRE(virga_fluid_add(of->fluid, &block) == VIRGA_OK);
}

static void make(host *h, effects *of)
{
    virga_rain_def rain = small_rain_def();
    const virga_ground_def ground = small_ground_def();
    const virga_glass_def glass = small_glass_def();
    virga_splash_def splash = small_splash_def();
    virga_rain_settings heavy = virga_default_rain_settings();
    heavy.rate_mm_h = 150;
    heavy.transition_s = 0;
    rain.max_ticks_per_step = 8;
    splash.max_handed = 64;
    REQUIRE(virga_rain_create(h->context, &rain, &of->rain) == VIRGA_OK);
    REQUIRE(virga_rain_set(of->rain, &heavy) == VIRGA_OK);
    REQUIRE(virga_ground_create(h->context, &ground, &of->ground) == VIRGA_OK);
    REQUIRE(virga_splash_create(h->context, &splash, &of->splash) == VIRGA_OK);
    REQUIRE(virga_glass_create(h->context, &glass, &of->glass) == VIRGA_OK);
    make_water(h, of);
}

static void destroy(effects *of)
{
    virga_rain_destroy(&of->rain);
    virga_ground_destroy(&of->ground);
    virga_splash_destroy(&of->splash);
    virga_glass_destroy(&of->glass);
    virga_water_destroy(&of->water);
    virga_fluid_destroy(&of->fluid);
}

static lists lists_of(const effects *of)
{
    lists found = {0};
    virga_rain_impacts(of->rain, &found.impacts);
    virga_splash_returned_droplets(of->splash, &found.returned);
    virga_splash_handed(of->splash, &found.handed);
    virga_fluid_exchange_get(of->fluid, &found.exchange);
    virga_fluid_particles(of->fluid, &found.particles, &found.particle_count);
    virga_water_leavers_get(of->water, &found.leavers);
    virga_ground_spawns(of->ground, &found.spawns, &found.spawns_size);
    virga_ground_cells_get(of->ground, &found.cells);
    return found;
}

/* Lists of the host, without entries. */
static lists no_entries(const host *h)
{
    return (lists){.impacts = {h->empty.buffer, 0, EMPTY_BYTES},
                   .spawns = h->empty.buffer,
                   .spawns_size = EMPTY_BYTES,
                   .particles = {.buffer = h->block.buffer},
                   .particle_count = PARTICLES};
}

static void step_ground(const host *h, const effects *of, const lists *from)
{
    const virga_occluder square = small_occluder(h->vertices.buffer, h->indices.buffer);
    const virga_ground_step_info info = {
        .first_tick = 1 + TICKS * h->step,
        .ticks = TICKS,
        .camera_m = {0, 1, 0},
        .meshes = &square,
        .mesh_count = 1,
        .impacts = from->impacts.buffer,
        .impacts_size = from->impacts.size,
        .returned_droplets = from->returned.buffer,
        .returned_droplets_size = from->returned.size,
        .water = from->particles.buffer,
        .water_count = from->particle_count,
        .water_spacing_m = 0.05f,
        .exchange = {.buffer = from->exchange.buffer, .size = from->exchange.size, .high_m = {0.5f, 0.5f}}};
    assert_int_equal(virga_ground_step(of->ground, h->cmd, &info), VIRGA_OK);
}

static void step_splash(const host *h, const effects *of, const lists *from)
{
    const virga_splash_pane pane = {
        .corner_m = {0, 1, -1}, .along_u = {1, 0, 0}, .along_v = {0, 1, 0}, .width_m = 1, .height_m = 1};
    const virga_splash_step_info info = {.camera_m = {0, 1, 0},
                                         .spawns = from->spawns,
                                         .spawns_size = from->spawns_size,
                                         .first_tick = 1 + TICKS * h->step,
                                         .ticks = TICKS,
                                         .leavers = from->leavers.leavers,
                                         .leaver_table = from->leavers.table,
                                         .floors = {.floors = from->cells.floors,
                                                    .tiles = from->cells.tiles,
                                                    .cell_m = virga_default_ground_def().cell_m},
                                         .panes = &pane,
                                         .pane_count = 1};
    assert_int_equal(virga_splash_step(of->splash, h->cmd, &info), VIRGA_OK);
    if (from->hits.buffer)
        assert_int_equal(virga_splash_give_hits(of->splash, h->cmd, 0, from->hits.buffer, 0, from->hits.size),
                         VIRGA_OK);
}

static void step_others(const host *h, const effects *of, const lists *from)
{
    const virga_glass_step_info glass = {
        .first_tick = 1 + TICKS * h->step, .ticks = TICKS, .impacts = from->hits.buffer};
    const virga_water_step_info water = {.particles = from->particles.buffer,
                                         .count = from->particle_count,
                                         .time_s = h->step / 60.0,
                                         .handed = from->handed.buffer,
                                         .handed_size = from->handed.size};
    const virga_fluid_step_info fluid = {
        .dt_s = 1.0f / 60, .leavers = from->leavers.leavers, .leavers_size = from->leavers.size};
    assert_int_equal(virga_glass_step(of->glass, h->cmd, &glass), VIRGA_OK);
    assert_int_equal(virga_water_step(of->water, h->cmd, &water), VIRGA_OK);
    assert_int_equal(virga_fluid_step(of->fluid, h->cmd, &fluid), VIRGA_OK);
}

/* All but rain, which reads nothing. */
static void step_all(const host *h, const effects *of, const lists *from)
{
    step_ground(h, of, from);
    step_splash(h, of, from);
    step_others(h, of, from);
}

/* Up to the ticks of the other effects. */
static virga_rain_buffer step_rain(const host *h, virga_rain *rain)
{
    const double dt_s = (1 + h->step) * TICKS / 60.0 - virga_rain_time(rain);
    const virga_rain_step_info step = {.dt_s = dt_s, .camera_m = {0, 1, 0}};
    const virga_rain_pane pane = {.corner_m = {0, 1, -1},
                                  .along_u = {1, 0, 0},
                                  .along_v = {0, 0.8f, 0.6f},
                                  .width_m = 2,
                                  .height_m = 2,
                                  .velocity_m_s = {0, 0, -20}};
    const virga_occluder square = small_occluder(h->vertices.buffer, h->indices.buffer);
    virga_rain_buffer hits;
    assert_int_equal(virga_rain_draw_occlusion(rain, h->cmd, step.camera_m, &square, 1), VIRGA_OK);
    assert_int_equal(virga_rain_step(rain, h->cmd, &step), VIRGA_OK);
    assert_int_equal(virga_rain_find_hits(rain, h->cmd, &pane, &hits), VIRGA_OK);
    return hits;
}

static void open_host(host *h, gpu_fixture *f)
{
    static virga_particle_gpu block[PARTICLES];
    static const char zeros[EMPTY_BYTES];
    memset(h, 0, sizeof *h);
    h->f = f;
    h->context = gpu_context(f);
    for (int i = 0; i < PARTICLES; i++)
        block[i] = (virga_particle_gpu){
            .position = {0.05f * (float)(i % SIDE), 0.05f * (float)(i / SIDE % SIDE), 0.05f * (float)(i / SIDE / SIDE)},
            .share = 1,
            .id = (uint32_t)i};
    host_parts_square(&f->gpu, &h->vertices, &h->indices);
    host_parts_buffer(&f->gpu, block, sizeof block, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &h->block);
    host_parts_buffer(&f->gpu, zeros, sizeof zeros,
                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, &h->empty);
    make(h, &h->writers);
    make(h, &h->readers);
    gpu_forget_log(f);
}

static void close_host(host *h)
{
    destroy(&h->writers);
    destroy(&h->readers);
    virga_context_destroy(&h->context);
    host_buffer *buffers[] = {&h->empty, &h->block, &h->vertices, &h->indices};
    for (int i = 0; i < 4; i++)
        host_buffer_destroy(&h->f->gpu.device, buffers[i]);
}

/* Nothing came out of the lists: no water, no splash, no drop, no particle. */
static void check_nothing_came(const host *h)
{
    virga_ground_stats ground;
    virga_splash_stats splash;
    virga_glass_stats glass;
    virga_fluid_stats fluid;
    virga_ground_stats_get(h->readers.ground, &ground);
    virga_splash_stats_get(h->readers.splash, &splash);
    virga_glass_stats_get(h->readers.glass, &glass);
    virga_fluid_stats_get(h->readers.fluid, &fluid);
    assert_int_equal(ground.landed_nl + ground.off_ground_nl + ground.returned_nl + ground.given_nl + ground.taken_nl,
                     0);
    assert_int_equal(splash.splashes_alive + splash.droplets_alive, 0);
    assert_int_equal(glass.landed_nl, 0);
    assert_int_equal(fluid.sprayed_nl, 0);
}

static void run(gpu_fixture *f, before way)
{
    static host h;
    open_host(&h, f);
    lists from = no_entries(&h);
    h.cmd = gpu_begin_frame(f, h.context);
    step_all(&h, &h.readers, &from); /* they are past their own first contents */
    gpu_submit(f);
    gpu_wait(f);
    virga_rain_buffer hits = {0};
    if (way != NEVER_STEPPED) {
        h.cmd = gpu_begin_frame(f, h.context);
        hits = step_rain(&h, h.writers.rain);
        step_all(&h, &h.writers, &from);
        host_parts_throw_away(&h.f->gpu.device, h.context, h.cmd, way == DROPPED);
        gpu_submit(f);
    }
    h.cmd = gpu_begin_frame(f, h.context);
    h.step++;
    from = lists_of(&h.writers);
    from.hits = hits;
    step_all(&h, &h.readers, &from);
    gpu_submit(f);
    gpu_wait(f);
    assert_int_equal(virga_frame_completed(h.context, f->gpu.device.completed), VIRGA_OK);
    check_nothing_came(&h);
    /* Once the writers step, what they write arrives. */
    for (int frame = 0; frame < 2; frame++) {
        h.cmd = gpu_begin_frame(f, h.context);
        h.step++;
        hits = step_rain(&h, h.writers.rain);
        from = lists_of(&h.writers);
        from.hits = hits;
        step_all(&h, &h.readers, &from);
        gpu_submit(f);
    }
    gpu_wait(f);
    assert_int_equal(virga_frame_completed(h.context, f->gpu.device.completed), VIRGA_OK);
    virga_ground_stats ground;
    virga_ground_stats_get(h.readers.ground, &ground);
    assert_true(ground.landed_nl > 0);
    assert_int_equal(f->errors, 0);
    close_host(&h);
}

static void lists_of_effects_that_never_stepped_are_empty(void **state)
{
    run(*state, NEVER_STEPPED);
}

static void lists_of_steps_in_dropped_frames_are_empty(void **state)
{
    run(*state, DROPPED);
}

static void lists_of_steps_in_frames_that_are_lost_untold_are_empty(void **state)
{
    run(*state, LOST_UNTOLD);
}

/* Prepares of effects whose only step is lost: there is nothing to see. */
static void run_prepares(gpu_fixture *f, bool tell)
{
    static host h;
    const gpu_picture size = {.images = {.width = 32, .height = 32}};
    const virga_glass_pose pose = {.position_m = {-0.1, 0.95, -0.2}};
    virga_view view = gpu_view(&size);
    virga_splash_stats splash;
    open_host(&h, f);
    view.position_m[1] = view.open_position_m[1] = 1;
    const lists from = no_entries(&h);
    h.cmd = gpu_begin_frame(f, h.context);
    step_all(&h, &h.writers, &from);
    host_parts_throw_away(&h.f->gpu.device, h.context, h.cmd, tell);
    gpu_submit(f);
    h.cmd = gpu_begin_frame(f, h.context);
    const virga_result glass = virga_glass_prepare(h.writers.glass, h.cmd, &view, &pose, 0);
    assert_int_equal(virga_splash_prepare(h.writers.splash, h.cmd, &view, 0), VIRGA_OK);
    assert_int_equal(virga_water_prepare(h.writers.water, h.cmd, &view), VIRGA_NOT_READY);
    assert_int_equal(glass, tell ? VIRGA_NOT_READY : VIRGA_OK);
    gpu_submit(f);
    gpu_wait(f);
    assert_int_equal(virga_frame_completed(h.context, f->gpu.device.completed), VIRGA_OK);
    virga_splash_stats_get(h.writers.splash, &splash);
    assert_int_equal(splash.sprites, 0);
    assert_int_equal(f->errors, 0);
    close_host(&h);
}

static void prepares_after_a_lost_step_see_nothing(void **state)
{
    run_prepares(*state, false);
    run_prepares(*state, true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(lists_of_effects_that_never_stepped_are_empty),
        gpu_kept_test(lists_of_steps_in_dropped_frames_are_empty),
        gpu_kept_test(lists_of_steps_in_frames_that_are_lost_untold_are_empty),
        gpu_kept_test(prepares_after_a_lost_step_see_nothing),
    };
    return effect_fixture_close(cmocka_run_group_tests_name("lists that nobody wrote", tests, NULL, NULL));
}
