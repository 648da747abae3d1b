/* bench.c - `virga bench water`: a pool with waves and spray, from particles to the picture, pass by pass. */
#include "bench/bench.h"
#include "bench/model/counting.h"
#include "options.h"
#include "progress.h"
#include "water/bench_water.h"

#include <virga/shared/random.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PICTURE 1  /* of bench_sizes: 1280 x 720 */
#define SETTLE  4  /* frames in which spray and foam come up */
#define SPRAY   32 /* one particle of so many is spray */
#define FRAME_S (1.0 / 60)

/* Particles along x and z, and along y. The pool is 1 m wide. */
static const struct row {
    uint32_t side, height;
} rows[] = {{27, 10}, {40, 15}, {75, 37}, {125, 64}};

/* What a pass is compared with: a bare kernel over the particles, or a fill of the picture. `sum`: what it is part of.
 */
enum { SURFACE, SPRAY_AND_FOAM, DRAWN, BY_SURFELS, SUMS };
static const struct pass {
    const char *name;
    int sum;
} passes[] = {{"water.grid", SURFACE},         {"water.density", SURFACE},
              {"water.blocks", SURFACE},       {"water.kernels", SURFACE},
              {"water.field", SURFACE},        {"water.surfels", SURFACE},
              {"water.spray", SPRAY_AND_FOAM}, {"water.spray_surfels", SPRAY_AND_FOAM},
              {"water.foam", SPRAY_AND_FOAM},  {"water.thickness", DRAWN},
              {"water.visible", DRAWN},        {"water.splats", DRAWN},
              {"water.tiles", DRAWN},          {"water.foam_light", DRAWN},
              {"water.divide", BY_SURFELS},    {"water.parts", BY_SURFELS}};
static const char *const sums[SUMS] = {"density, surface, normals", "spray and foam", "the picture from them",
                                       "light by surfels, added"};

enum { PASSES = sizeof passes / sizeof passes[0] };

/* Frames with and without the draws, by their fences: on software Vulkan, timestamps inside a render pass do not see
 * the work of its pixels. And the passes of the surface with anisotropic kernels. */
enum { UNDRAWN = PASSES, WHOLE, SURFELS, ELLIPSOIDS, TIMES };

typedef struct pool {
    const struct row *row;
    uint32_t count, frame;
    virga_water *water;
    virga_water_settings settings;
    virga_target *layer;
    host_buffer particles;
    host_image color, depth; /* of the scene around it */
    virga_water_stats stats;
} pool;

/* ---- the pool */

static void place(const struct row *row, uint32_t index, virga_particle_gpu *particle)
{
    const uint32_t x = index % row->side, y = index / row->side % row->height, z = index / row->side / row->height;
    const double d = 1.0 / row->side, u = d * (x + 0.5) - 0.5, v = d * (z + 0.5) - 0.5, up = d * (y + 0.5);
    const double phase = 9 * u + 3 * v, wave = 0.06 * sin(phase) + 0.03 * sin(20 * v - 11 * u + 1);
    const uint32_t hash = virga_hash1(index);
    *particle = (virga_particle_gpu){.position = {(float)u, (float)(up * (1 + wave)), (float)v},
                                     .share = 1,
                                     .velocity = {(float)cos(phase), (float)(2 * up * cos(phase)), 0},
                                     .id = index};
    if (y + 1 < row->height || hash % SPRAY)
        return;
    particle->position[1] += 0.05f + 0.4f * virga_unit(virga_hash1(hash));
    particle->velocity[1] = 2;
}

static bool upload_particles(bench *b, pool *p)
{
    virga_particle_gpu *particles = malloc(p->count * sizeof *particles);
    if (!particles)
        return options_complain("bench", "out of memory");
    for (uint32_t i = 0; i < p->count; i++)
        place(p->row, i, &particles[i]);
    const bool good =
        host_buffer_create_with(&b->device, particles, p->count * sizeof *particles, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                "particles", &p->particles, b->error, sizeof b->error);
    free(particles);
    return good || bench_fail(b, "particles");
}

static uint32_t at_most(double wanted, uint32_t most)
{
    return (uint32_t)fmin(fmax(wanted, 4096), most);
}

static bool make_water(bench *b, pool *p)
{
    virga_water_def def = virga_default_water_def();
    virga_target_def layer = virga_default_target_def();
    const double cells = 0.5 * p->row->side + 5; /* the kernel is two spacings wide */
    def.max_particles = p->count;
    def.max_cells = at_most(cells * cells * (cells + 1), 16777216);
    def.max_blocks = at_most(p->count, 262144);
    def.max_surfels = at_most(4.0 * p->count, 1048576); /* more have no room in a buffer with their parts */
    def.max_spray = at_most(p->count / 16.0, 65536);
    def.max_droplets = at_most(p->count, 1048576);
    def.max_parts = at_most(8.0 * p->count, 1048576);
    def.max_width = bench_sizes[PICTURE][0];
    def.max_height = bench_sizes[PICTURE][1];
    host_target_describe_layer(&b->targets[PICTURE], &layer);
    virga_water_settings *settings = &p->settings;
    *settings = virga_default_water_settings();
    settings->contact = VIRGA_WATER_CONTACT_PREPARE;
    settings->spacing_m = 1.0f / (float)p->row->side;
    /* Velocities of neighbours differ by as much as they are apart. */
    for (int i = 0; i < 2; i++)
        settings->foam_air_m_s[i] *= (float)rows[0].side / (float)p->row->side;
    settings->lighting.environment_sh[0][0] = settings->lighting.environment_sh[0][1] = 1;
    settings->lighting.environment_sh[0][2] = settings->lighting.environment_sh[1][2] = 1;
    if (virga_water_create(b->context, &def, &p->water) < 0 || virga_target_create(b->context, &layer, &p->layer) < 0 ||
        virga_water_attach(p->water, p->layer) < 0 || virga_water_set(p->water, settings) < 0)
        return options_complain("bench", "no water of %u particles could be made", p->count);
    return true;
}

static void aim(virga_view *view)
{
    static const host_camera_key key = {.position_m = {0.4, 0.95, 1.5}, .look_at_m = {0, 0.35, 0}};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 40, .near_m = 0.02, .far_m = 100};
    host_camera camera;
    host_camera_at(&path, 0, bench_sizes[PICTURE][0], bench_sizes[PICTURE][1], NULL, &camera);
    *view = virga_default_view();
    host_camera_view(&camera, &camera, 0, view);
}

/* A checkered floor below the pool and a grey sky: what is refracted. */
static bool upload_scene(bench *b, pool *p)
{
    const uint32_t width = bench_sizes[PICTURE][0], height = bench_sizes[PICTURE][1];
    const size_t count = (size_t)width * height;
    const double down = 0.45, near_m = 0.02, far_m = 100;
    float *color = malloc(count * 16), *depth = malloc(count * 4);
    bool good = (color && depth) || options_complain("bench", "out of memory");
    for (size_t i = 0; good && i < count; i++) {
        /* The camera looks down by about 20 degrees. */
        const double slope = 0.38 + 0.73 * ((double)(i / width) / height - 0.5);
        const double distance = slope > 0.02 ? fmin((down + 0.5) / slope, far_m) : far_m;
        const bool dark = (int)(i % width / 40 + i / width / 40) % 2;
        for (int c = 0; c < 4; c++)
            color[4 * i + (size_t)c] = c == 3 ? 1 : dark ? 0.1f : 0.4f;
        depth[i] = (float)(far_m / (far_m - near_m) * (1 - near_m / distance));
    }
    const host_image_def color_def = {VK_FORMAT_R32G32B32A32_SFLOAT, {width, height, 1}, 0, 0, 0, "scene"};
    const host_image_def depth_def = {VK_FORMAT_R32_SFLOAT, {width, height, 1}, 0, 0, 0, "scene depth"};
    good =
        good &&
        ((host_image_create_with(&b->device, &color_def, color, count * 16, 16, &p->color, b->error, sizeof b->error) &&
          host_image_create_with(&b->device, &depth_def, depth, count * 4, 4, &p->depth, b->error, sizeof b->error)) ||
         bench_fail(b, "scene"));
    free(color);
    free(depth);
    return good;
}

static bool open_pool(bench *b, pool *p)
{
    return upload_particles(b, p) && upload_scene(b, p) && make_water(b, p);
}

static void close_pool(bench *b, pool *p)
{
    virga_target_destroy(&p->layer);
    virga_water_destroy(&p->water);
    host_buffer_destroy(&b->device, &p->particles);
    if (p->color.image)
        host_image_destroy(&b->device, &p->color);
    if (p->depth.image)
        host_image_destroy(&b->device, &p->depth);
}

/* ---- frames */

static virga_image image_of(const host_image *image)
{
    return (virga_image){.image = image->image,
                         .view = image->view,
                         .format = image->format,
                         .extent = {bench_sizes[PICTURE][0], bench_sizes[PICTURE][1]},
                         .layers = 1,
                         .before = {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}};
}

static bool frame(bench *b, pool *p, bool draw, virga_water_shading shading, double *whole)
{
    VkCommandBuffer cmd;
    virga_view view;
    const virga_water_step_info info = {
        .particles = p->particles.buffer, .count = p->count, .time_s = FRAME_S * p->frame++};
    aim(&view);
    view.color = image_of(&p->color);
    view.depth = image_of(&p->depth);
    p->settings.shading = shading;
    if (virga_water_set(p->water, &p->settings) < 0 || !bench_begin(b, &cmd) ||
        virga_water_step(p->water, cmd, &info) < 0 || virga_water_prepare(p->water, cmd, &view) < 0)
        return options_complain("bench", "a step failed");
    host_target_begin_layer(&b->targets[PICTURE], cmd);
    const bool drawn = !draw || (virga_water_draw(p->water, cmd, p->layer) == VIRGA_OK &&
                                 virga_water_draw_foam(p->water, cmd, p->layer) == VIRGA_OK);
    host_target_end_layer(&b->targets[PICTURE], cmd);
    const bool good = (drawn || options_complain("bench", "a draw failed")) && bench_submit(b, whole);
    virga_water_stats_get(p->water, &p->stats);
    return good;
}

/* The passes of the newest frame, either those of light by surfels or all others. */
static void read_times(bench *b, bool by_surfels, int run, double times[TIMES][BENCH_RUNS])
{
    for (int j = 0; j < PASSES; j++)
        if ((passes[j].sum == BY_SURFELS) == by_surfels)
            times[j][run] = bench_pass_ms(b, passes[j].name);
}

static bool time_ellipsoids(bench *b, pool *p, double *sum_ms)
{
    double whole;
    p->settings.kernel = VIRGA_WATER_KERNEL_ANISOTROPIC;
    const bool good = frame(b, p, false, VIRGA_WATER_SHADING_PIXELS, &whole);
    p->settings.kernel = VIRGA_WATER_KERNEL_ISOTROPIC;
    *sum_ms = 0;
    for (int j = 0; j < PASSES; j++)
        *sum_ms += passes[j].sum == SURFACE ? bench_pass_ms(b, passes[j].name) : 0;
    return good;
}

static bool time_passes(bench *b, pool *p, double times[TIMES][BENCH_RUNS])
{
    bool good = true;
    for (int i = -SETTLE; good && i < BENCH_RUNS && !interrupt_requested(); i++) {
        const int run = i < 0 ? 0 : i;
        good = frame(b, p, false, VIRGA_WATER_SHADING_PIXELS, &times[UNDRAWN][run]) &&
               frame(b, p, true, VIRGA_WATER_SHADING_PIXELS, &times[WHOLE][run]);
        read_times(b, false, run, times);
        good = good && frame(b, p, true, VIRGA_WATER_SHADING_SURFELS, &times[SURFELS][run]);
        read_times(b, true, run, times);
        good = good && time_ellipsoids(b, p, &times[ELLIPSOIDS][run]);
    }
    return good && !interrupt_requested();
}

static void print_times(const pool *p, double times[TIMES][BENCH_RUNS], const bench_water_limits *machine)
{
    double sum_ms[SUMS] = {0};
    for (int j = 0; j < PASSES; j++) {
        const double ms = bench_median(times[j], BENCH_RUNS);
        sum_ms[passes[j].sum] += ms;
        if (passes[j].sum >= DRAWN)
            printf("  %-26s %9.3f ms  %6.1f x fill\n", passes[j].name, ms, ms / machine->fill_ms);
        else
            bench_water_print_pass(passes[j].name, ms, machine, p->count);
    }
    const double whole = bench_median(times[WHOLE], BENCH_RUNS);
    const double drawn = whole - bench_median(times[UNDRAWN], BENCH_RUNS);
    sum_ms[DRAWN] += drawn;
    printf("  %-26s %9.3f ms  %6.1f x fill\n", "draw, with foam", drawn, drawn / machine->fill_ms);
    for (int i = 0; i < SUMS; i++)
        printf("  %-26s %9.3f ms\n", sums[i], sum_ms[i]);
    printf("  %-26s %9.3f ms\n", "surface of ellipsoids", bench_median(times[ELLIPSOIDS], BENCH_RUNS));
    printf("  %-26s %9.3f ms, by its fence\n", "a whole frame", whole);
    printf("  %-26s %9.3f ms, by its fence\n", "the same, light by surfels", bench_median(times[SURFELS], BENCH_RUNS));
}

static void print_counts(const pool *p)
{
    printf("%u particles, %u surfels, %u droplets of %u splash particles, %u particles of foam\n", p->count,
           p->stats.surfels, p->stats.droplets, p->stats.splashes, p->stats.foam);
}

/* What a frame would take on a card: of the surface of balls, with light by pixels, as is the default. */
static bool model(bench *b, const struct row *row)
{
    double ms;
    pool p = {.row = row, .count = row->side * row->side * row->height};
    bool good = open_pool(b, &p);
    for (int i = 0; i <= SETTLE && good && !interrupt_requested(); i++) {
        if (i == SETTLE) {
            counting_forget();
            counting_all_of_next();
        }
        good = frame(b, &p, true, VIRGA_WATER_SHADING_PIXELS, &ms);
    }
    if (good && !interrupt_requested()) {
        print_counts(&p);
        bench_print_model(b);
        fflush(stdout);
    }
    close_pool(b, &p);
    return good;
}

static bool measure(bench *b, const struct row *row)
{
    double times[TIMES][BENCH_RUNS];
    bench_water_limits machine;
    pool p = {.row = row, .count = row->side * row->side * row->height};
    const bool good = open_pool(b, &p) && time_passes(b, &p, times);
    if (good)
        print_counts(&p);
    close_pool(b, &p);
    if (!good || !bench_water_measure_limits(b, p.count, PICTURE, &machine))
        return interrupt_requested();
    print_times(&p, times, &machine);
    fflush(stdout);
    return true;
}

/* ---- what both benches share */

bool bench_water_measure_limits(bench *b, uint32_t particles, uint32_t size, bench_water_limits *out)
{
    limits *machine = NULL;
    const bool good = limits_create(&b->device, &b->targets[size], particles, &machine, b->error, sizeof b->error) ||
                      bench_fail(b, "limits");
    if (good) {
        out->bare_ms = limits_bare_ms(&b->device, machine);
        out->fill_ms = limits_fill_ms(&b->device, machine, &b->targets[size]);
        printf("  machine: copy of 16 bytes a particle %.3f ms, bare kernel over them %.3f ms, dispatch %.3f ms, fill "
               "of %u x %u %.2f ms\n",
               limits_copy_ms(&b->device, machine), out->bare_ms, limits_dispatch_ms(&b->device, machine),
               bench_sizes[size][0], bench_sizes[size][1], out->fill_ms);
    }
    limits_destroy(&b->device, &machine);
    return good;
}

void bench_water_print_pass(const char *name, double ms, const bench_water_limits *machine, uint32_t particles)
{
    printf("  %-26s %9.3f ms  %6.1f x bare kernel  %7.1f ns a particle\n", name, ms, ms / machine->bare_ms,
           ms * 1e6 / particles);
}

bool bench_water_read_particles(const options *parsed, uint32_t *most)
{
    *most = 1000000;
    return options_uint(parsed, "--particles", 7000, 1000000, most);
}

static const option_row option_rows[] = {
    {"--particles", 0, "N", "water, fluid: only the rows with up to so many particles. Default: 1000000", false},
};

static bool check_particles(const options *parsed)
{
    uint32_t most;
    return bench_water_read_particles(parsed, &most);
}

static bool run(bench *b, const options *parsed)
{
    uint32_t most;
    bool good = bench_water_read_particles(parsed, &most);
    for (size_t i = 0; good && !interrupt_requested() && i < sizeof rows / sizeof rows[0]; i++)
        if (rows[i].side * rows[i].side * rows[i].height <= most)
            good = b->model ? model(b, &rows[i]) : measure(b, &rows[i]);
    return good;
}

const tool_bench water_bench = {
    .next = &fluid_bench,
    .help = "surface, spray, foam and picture of water from 7290 to 1000000 particles\n",
    TOOL_BENCH(check_particles, run),
};
