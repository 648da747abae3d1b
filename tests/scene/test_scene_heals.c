/* test_scene_heals.c - each effect alone, in a host that throws frames away: the first one, any later one, several in a
 * row, reported or not. When the frames in flight are over, its picture is there again. */
#include "../gpu/gpu_fixture.h"
#include "host_parts.h"
#include "layered_pass.h"

#include <virga/shared/particle.h>
#include <virga/shared/random.h>
#include <virga/shared/spawn.h>

#include <math.h>

enum { SIDE = 32, FRAMES = 8, FLOATS = SIDE * SIDE * 4, BALL = 6, SPAWNS = 24, SLOT = 4096, TICKS = 2 };

typedef struct healed {
    gpu_fixture *f;
    virga_context *context;
    layered_pass pass;
    virga_target *target;
    host_image depth, color;
    host_buffer vertices, indices, particles, spawns; /* `spawns`: a slot for each frame */
    virga_view view;
    /* One of them. */
    virga_rain *rain;
    virga_ground *ground;
    virga_splash *splash;
    virga_glass *glass;
    virga_water *water;
    virga_fluid *fluid;
    virga_lens *lens;
    virga_environment *environment;
    uint32_t number; /* of the frame */
    VkCommandBuffer cmd;
    float found[FLOATS]; /* what is compared at the end */
} healed;

/* ---- the effects */

static void make_rain(healed *h)
{
    const virga_rain_def def = small_rain_def();
    virga_rain_settings settings = virga_default_rain_settings();
    settings.rate_mm_h = 150;
    settings.transition_s = 0;
    settings.streak_gain = 8;
    REQUIRE(virga_rain_create(h->context, &def, &h->rain) == VIRGA_OK);
    REQUIRE(virga_rain_set(h->rain, &settings) == VIRGA_OK);
    REQUIRE(virga_rain_attach(h->rain, h->target) == VIRGA_OK);
}

static void record_rain(healed *h)
{
    const virga_occluder square = small_occluder(h->vertices.buffer, h->indices.buffer);
    const virga_rain_step_info step = {.dt_s = 1.0 / 60, .camera_m = {0, 1, 0}};
    assert_int_equal(virga_rain_draw_occlusion(h->rain, h->cmd, step.camera_m, &square, 1), VIRGA_OK);
    assert_int_equal(virga_rain_step(h->rain, h->cmd, &step), VIRGA_OK);
    assert_int_equal(virga_rain_prepare(h->rain, h->cmd, &h->view, virga_rain_time(h->rain)), VIRGA_OK);
}

static void draw_rain(healed *h)
{
    assert_int_equal(virga_rain_draw(h->rain, h->cmd, h->target), VIRGA_OK);
}

static void make_ground(healed *h)
{
    const virga_ground_def def = small_ground_def();
    virga_ground_settings settings = virga_default_ground_settings();
    settings.start_wetness = 1;
    settings.start_water_mm = 3;
    REQUIRE(virga_ground_create(h->context, &def, &h->ground) == VIRGA_OK);
    REQUIRE(virga_ground_set(h->ground, &settings) == VIRGA_OK);
    REQUIRE(virga_ground_attach(h->ground, h->target) == VIRGA_OK);
}

static void record_ground(healed *h)
{
    const virga_occluder square = small_occluder(h->vertices.buffer, h->indices.buffer);
    const virga_ground_step_info step = {.first_tick = 1 + TICKS * (h->number - 1),
                                         .ticks = TICKS,
                                         .camera_m = {0, 1, 0},
                                         .meshes = &square,
                                         .mesh_count = 1,
                                         .impacts = h->spawns.buffer, /* zeros: no impacts */
                                         .impacts_size = SLOT};
    assert_int_equal(virga_ground_step(h->ground, h->cmd, &step), VIRGA_OK);
}

static void draw_ground(healed *h)
{
    const virga_ground_wet wet = virga_default_ground_wet();
    assert_int_equal(virga_ground_draw_wet(h->ground, h->cmd, &h->view, &wet, h->target), VIRGA_OK);
}

/* Splashes in front of the camera, the same in each tick. */
static void fill_spawns(healed *h)
{
    const virga_splash_settings settings = virga_default_splash_settings();
    const uint32_t model = settings.rules[VIRGA_MATERIAL_ASPHALT][VIRGA_GROUND_STATES - 1].model;
    for (uint32_t frame = 1; frame <= FRAMES; frame++) {
        virga_spawns_gpu *head = (virga_spawns_gpu *)(void *)((char *)h->spawns.mapped + frame * SLOT);
        virga_spawn_gpu *all = (virga_spawn_gpu *)(head + 1);
        const uint32_t first = 1 + TICKS * (frame - 1);
        *head = (virga_spawns_gpu){.count = SPAWNS,
                                   .capacity = SPAWNS,
                                   .group_count = {1, 1, 1},
                                   .tick_s = 1.0f / 60,
                                   .first_tick = first,
                                   .ticks = TICKS};
        for (uint32_t i = 0; i < SPAWNS; i++)
            all[i] =
                (virga_spawn_gpu){.position = {0.05f * (float)(i % 6) - 0.125f, 0.9f, -0.3f - 0.05f * (float)(i / 6)},
                                  .velocity = {0, -6.5f, 0},
                                  .diameter_m = 3e-3f,
                                  .normal = {0, 1, 0},
                                  .depth_m = 20e-3f,
                                  .weight = 1,
                                  .drops = 1,
                                  .id = i,
                                  .tick = first + i * TICKS / SPAWNS,
                                  .water_nl = 400,
                                  .random = virga_hash2(frame, i),
                                  .kind = (VIRGA_GROUND_STATES - 1) | VIRGA_MATERIAL_ASPHALT << 8 | model << 16};
    }
}

static void make_splash(healed *h)
{
    const virga_splash_def def = small_splash_def();
    fill_spawns(h);
    REQUIRE(virga_splash_create(h->context, &def, &h->splash) == VIRGA_OK);
    REQUIRE(virga_splash_attach(h->splash, h->target) == VIRGA_OK);
}

static void record_splash(healed *h)
{
    const virga_splash_step_info step = {.camera_m = {0, 1, 0},
                                         .spawns = h->spawns.buffer,
                                         .spawns_offset = h->number * SLOT,
                                         .spawns_size = SLOT,
                                         .first_tick = 1 + TICKS * (h->number - 1),
                                         .ticks = TICKS};
    assert_int_equal(virga_splash_step(h->splash, h->cmd, &step), VIRGA_OK);
    assert_int_equal(virga_splash_prepare(h->splash, h->cmd, &h->view, virga_splash_time(h->splash)), VIRGA_OK);
}

static void draw_splash(healed *h)
{
    assert_int_equal(virga_splash_draw(h->splash, h->cmd, h->target), VIRGA_OK);
}

static void make_glass(healed *h)
{
    const virga_glass_def def = small_glass_def();
    REQUIRE(virga_glass_create(h->context, &def, &h->glass) == VIRGA_OK);
    REQUIRE(virga_glass_attach(h->glass, h->target) == VIRGA_OK);
}

static void record_glass(healed *h)
{
    const virga_glass_step_info step = {
        .velocity_m_s = {0, 0, 20}, .rate_mm_h = 150, .first_tick = 1 + TICKS * (h->number - 1), .ticks = TICKS};
    const virga_glass_pose pose = {.position_m = {-0.1, 0.95, -0.2}};
    assert_int_equal(virga_glass_step(h->glass, h->cmd, &step), VIRGA_OK);
    assert_int_equal(virga_glass_prepare(h->glass, h->cmd, &h->view, &pose, virga_glass_time(h->glass)), VIRGA_OK);
}

static void draw_glass(healed *h)
{
    assert_int_equal(virga_glass_draw(h->glass, h->cmd, h->target), VIRGA_OK);
}

static void make_water(healed *h)
{
    virga_water_def def = virga_default_water_def();
    virga_water_settings settings = virga_default_water_settings();
    def.max_particles = 1024;
    def.max_cells = 4096;
    def.max_blocks = 2048;
    def.max_surfels = 8192;
    def.max_width = def.max_height = SIDE;
    settings.spacing_m = 0.05f;
    REQUIRE(virga_water_create(h->context, &def, &h->water) == VIRGA_OK);
    REQUIRE(virga_water_set(h->water, &settings) == VIRGA_OK);
    REQUIRE(virga_water_attach(h->water, h->target) == VIRGA_OK);
}

static void record_water(healed *h)
{
    const virga_water_step_info step = {.particles = h->particles.buffer, .count = BALL * BALL * BALL};
    assert_int_equal(virga_water_step(h->water, h->cmd, &step), VIRGA_OK);
    assert_int_equal(virga_water_prepare(h->water, h->cmd, &h->view), VIRGA_OK);
}

static void draw_water(healed *h)
{
    assert_int_equal(virga_water_draw(h->water, h->cmd, h->target), VIRGA_OK);
}

static void make_fluid(healed *h)
{
    virga_fluid_def def = virga_default_fluid_def();
    virga_fluid_settings settings = virga_default_fluid_settings();
    const virga_fluid_block block = {.high_m = {0.4f, 0.2f, 0.4f}};
    def.max_particles = 2048;
    def.max_cells = 8192;
    settings.spacing_m = 0.05f;
    for (int axis = 0; axis < 3; axis++) {
        settings.low_m[axis] = 0;
        settings.high_m[axis] = 0.8f;
    }
    REQUIRE(virga_fluid_create(h->context, &def, &h->fluid) == VIRGA_OK);
    REQUIRE(virga_fluid_set(h->fluid, &settings) == VIRGA_OK);
    REQUIRE(virga_fluid_add(h->fluid, &block) == VIRGA_OK);
}

static void record_fluid(healed *h)
{
    const virga_fluid_step_info step = {.dt_s = 1.0f / 60};
    assert_int_equal(virga_fluid_step(h->fluid, h->cmd, &step), VIRGA_OK);
}

/* Its particles, which all are there and have moved. */
static void read_fluid(healed *h)
{
    virga_fluid_stats stats;
    virga_fluid_stats_get(h->fluid, &stats);
    h->found[0] = (float)stats.particles;
    h->found[1] = (float)stats.moved;
}

static void make_lens(healed *h)
{
    virga_lens_def def = virga_default_lens_def();
    def.max_width = def.max_height = SIDE;
    REQUIRE(virga_lens_create(h->context, &def, &h->lens) == VIRGA_OK);
    REQUIRE(virga_lens_attach(h->lens, h->target) == VIRGA_OK);
}

static void record_lens(healed *h)
{
    assert_int_equal(virga_lens_prepare(h->lens, h->cmd, &h->view, NULL, 0, h->number / 60.0), VIRGA_OK);
}

static void draw_lens(healed *h)
{
    assert_int_equal(virga_lens_draw(h->lens, h->cmd, h->target), VIRGA_OK);
}

static void make_environment(healed *h)
{
    const virga_environment_def def = virga_default_environment_def();
    REQUIRE(virga_environment_create(h->context, &def, &h->environment) == VIRGA_OK);
}

static void record_environment(healed *h)
{
    const virga_environment_info info = {
        .kind = VIRGA_ENVIRONMENT_PICTURE, .image = h->view.color, .width = SIDE, .height = SIDE, .view = &h->view};
    assert_int_equal(virga_environment_record(h->environment, h->cmd, &info), VIRGA_OK);
}

static void read_environment(healed *h)
{
    float sh[9][3] = {{0}};
    assert_int_equal(virga_environment_harmonics(h->environment, sh), h->f->gpu.device.frame);
    memcpy(h->found, sh, sizeof sh);
}

/* How much of the picture without losses must be there. */
typedef enum likeness {
    SAME,  /* what is drawn depends on the frame alone, but for water that dries */
    ALIVE, /* it has gone on from where it was: half of its pixels are enough */
} likeness;

static const struct kind {
    const char *name;
    void (*make)(healed *h);
    void (*record)(healed *h);
    void (*draw)(healed *h); /* NULL: it draws nothing */
    void (*read)(healed *h); /* instead of the picture */
    likeness likeness;
} kinds[] = {
    {"rain", make_rain, record_rain, draw_rain, NULL, SAME},
    {"ground", make_ground, record_ground, draw_ground, NULL, SAME},
    {"splash", make_splash, record_splash, draw_splash, NULL, ALIVE},
    {"glass", make_glass, record_glass, draw_glass, NULL, ALIVE},
    {"water", make_water, record_water, draw_water, NULL, SAME},
    {"fluid", make_fluid, record_fluid, NULL, read_fluid, SAME},
    {"lens", make_lens, record_lens, draw_lens, NULL, SAME},
    {"environment", make_environment, record_environment, NULL, read_environment, SAME},
};

/* ---- a host */

/* The ground, a metre below the camera, and a sky over it; each pixel has a color of its own. */
static void aim(healed *h)
{
    static float depth[SIDE * SIDE];
    static uint8_t color[SIDE][SIDE][4];
    const gpu_picture size = {.images = {.width = SIDE, .height = SIDE}};
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            memcpy(color[y][x], (uint8_t[4]){(uint8_t)(7 * x), (uint8_t)(7 * y), 90, 255}, 4);
    host_parts_depth(SIDE, depth);
    h->view = gpu_view(&size);
    h->view.position_m[1] = h->view.open_position_m[1] = 1;
    h->view.depth = host_parts_picture(&h->f->gpu, VK_FORMAT_R32_SFLOAT, SIDE, depth, &h->depth);
    h->view.color = host_parts_picture(&h->f->gpu, VK_FORMAT_R8G8B8A8_UNORM, SIDE, color, &h->color);
}

static void make_buffers(healed *h)
{
    static virga_particle_gpu ball[BALL * BALL * BALL];
    fixture *gpu = &h->f->gpu;
    for (int i = 0; i < BALL * BALL * BALL; i++)
        ball[i] = (virga_particle_gpu){.position = {0.05f * (float)(i % BALL) - 0.15f,
                                                    0.9f + 0.05f * (float)(i / BALL % BALL),
                                                    -1 + 0.05f * (float)(i / BALL / BALL)},
                                       .share = 1,
                                       .id = (uint32_t)i};
    host_parts_square(gpu, &h->vertices, &h->indices);
    host_parts_buffer(gpu, ball, sizeof ball, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &h->particles);
    REQUIRE(host_buffer_create(&gpu->device, (FRAMES + 1) * SLOT,
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                               HOST_BUFFER_UPLOAD, "spawns", &h->spawns, gpu->error, sizeof gpu->error));
    memset(h->spawns.mapped, 0, (FRAMES + 1) * SLOT);
}

static void open_host(healed *h, gpu_fixture *f)
{
    virga_target_def def = virga_default_target_def();
    memset(h, 0, sizeof *h);
    h->f = f;
    h->context = gpu_context(f);
    layered_pass_open(&h->pass, &f->gpu, VK_FORMAT_R32G32B32A32_SFLOAT, 16, SIDE, SIDE, 1, 0);
    def.render_pass = h->pass.pass;
    def.depth_attached = false;
    REQUIRE(virga_target_create(h->context, &def, &h->target) == VIRGA_OK);
    aim(h);
    make_buffers(h);
    gpu_forget_log(f);
}

static void close_host(healed *h)
{
    host_device *device = &h->f->gpu.device;
    host_buffer *buffers[] = {&h->vertices, &h->indices, &h->particles, &h->spawns};
    virga_rain_destroy(&h->rain);
    virga_ground_destroy(&h->ground);
    virga_splash_destroy(&h->splash);
    virga_glass_destroy(&h->glass);
    virga_water_destroy(&h->water);
    virga_fluid_destroy(&h->fluid);
    virga_lens_destroy(&h->lens);
    virga_environment_destroy(&h->environment);
    virga_target_destroy(&h->target);
    virga_context_destroy(&h->context);
    layered_pass_close(&h->pass);
    host_image_destroy(device, &h->depth);
    host_image_destroy(device, &h->color);
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        host_buffer_destroy(device, buffers[i]);
}

/* `lost` has a bit for each frame that is thrown away. */
static void run(healed *h, gpu_fixture *f, const struct kind *kind, uint32_t lost, bool tell)
{
    open_host(h, f);
    kind->make(h);
    for (h->number = 1; h->number <= FRAMES; h->number++) {
        h->cmd = gpu_begin_frame(f, h->context);
        kind->record(h);
        if (kind->draw) {
            layered_pass_begin(&h->pass, h->cmd, 0);
            kind->draw(h);
            layered_pass_end(&h->pass, h->cmd);
        }
        if (lost & 1u << h->number)
            host_parts_throw_away(&f->gpu.device, h->context, h->cmd, tell);
        gpu_submit(f);
    }
    gpu_wait(f);
    assert_int_equal(virga_frame_completed(h->context, f->gpu.device.completed), VIRGA_OK);
    assert_int_equal(virga_frames_lost(h->context), __builtin_popcount(lost));
    assert_int_equal(f->lines[VIRGA_LOG_FRAME_LOST], lost && !tell);
    assert_int_equal(f->errors, 0);
    if (kind->read)
        kind->read(h);
    else
        memcpy(h->found, layered_pass_pixels(&h->pass), sizeof h->found);
    close_host(h);
}

static uint32_t count_lit(const float *found)
{
    uint32_t lit = 0;
    for (uint32_t i = 0; i < FLOATS; i += 4)
        lit += found[i] != 0 || found[i + 1] != 0 || found[i + 2] != 0;
    return lit;
}

static double most_off(const float *a, const float *b)
{
    double most = 0;
    for (uint32_t i = 0; i < FLOATS; i++)
        most = fmax(most, fabs((double)a[i] - (double)b[i]));
    return most;
}

static void each_effect_alone_is_complete_again(void **state)
{
    static const struct {
        uint32_t lost;
        bool tell;
    } hosts[] = {{1 << 1, true}, {1 << 1, false}, {1 << 1 | 1 << 2 | 1 << 3, false}, {1 << 4, true}, {1 << 3, false}};
    static healed whole, h;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        run(&whole, *state, &kinds[k], 0, false);
        const uint32_t lit = count_lit(whole.found);
        printf("%s: %u pixels\n", kinds[k].name, lit);
        assert_true(lit > 0);
        for (size_t i = 0; i < sizeof hosts / sizeof hosts[0]; i++) {
            run(&h, *state, &kinds[k], hosts[i].lost, hosts[i].tell);
            const double off = most_off(h.found, whole.found);
            const uint32_t left = count_lit(h.found);
            if (kinds[k].likeness == SAME ? off > 1e-3 : 2 * left < lit)
                fail_msg("%s, frames 0x%x lost: %u pixels of %u, off by %g", kinds[k].name, hosts[i].lost, left, lit,
                         off);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {gpu_kept_test(each_effect_alone_is_complete_again)};
    return effect_fixture_close(cmocka_run_group_tests_name("effects heal", tests, NULL, NULL));
}
