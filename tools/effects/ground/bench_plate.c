/* bench_plate.c - `virga bench plate`: what wet ground and walls cost the program's own shading, part by part, in a
 * street of two walls with lamps; and the light of a place, which is drawn where the camera has moved on. */
#include "bench_plate.h"

#include "bench/bench.h"
#include "effect.h"
#include "progress.h"
#include "surroundings.h"

#include <stdio.h>
#include <string.h>

#define SIZE   1 /* of bench_sizes */
#define CELLS  64
#define CELL_M 1.0f
#define LAMPS  4
#define PLACES 5

/* Each part is added to those before it. Wet ground has the picture of what it mirrors. */
enum { DRY, WET_GROUND, CONTACT, MENISCUS, WALLS, PARTS };

static const char *const part_names[PARTS] = {"dry", "wet ground", "contact shade", "meniscus", "wet walls"};

typedef struct street {
    host_renderer *renderer;
    host_environment environment;
    host_mesh meshes[3]; /* the ground and two walls */
    host_image maps[3];
    host_surroundings surroundings;
} street;

static bool add_quad(bench *b, street *s, uint32_t index, const float corners[4][3], const float normal[3])
{
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    const host_material material = {.base_color = {0.4f, 0.35f, 0.3f, 1},
                                    .roughness = 0.8f,
                                    .base_texture = -1,
                                    .emissive_texture = -1,
                                    .two_sided = true};
    host_vertex v[4] = {{.uv = {0}}};
    host_mesh *mesh = &s->meshes[index];
    for (int i = 0; i < 4; i++) {
        memcpy(v[i].position, corners[i], sizeof v[i].position);
        memcpy(v[i].normal, normal, sizeof v[i].normal);
    }
    if (!host_mesh_create(&b->device, v, 4, indices, 6, &material, mesh, b->error, sizeof b->error))
        return false;
    mesh->primitives[0].ground = index == 0;
    return host_renderer_add(s->renderer, mesh, b->error, sizeof b->error);
}

static bool add_map(bench *b, VkFormat format, const uint32_t extent[2], const void *texels, uint32_t texel,
                    host_image *image)
{
    const host_image_def def = {.format = format,
                                .extent = {extent[0], extent[1], 1},
                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .name = "map of wet ground"};
    VkCommandBuffer cmd;
    if (!host_image_create(&b->device, &def, image, b->error, sizeof b->error) ||
        !host_image_upload(&b->device, image, texels, (VkDeviceSize)extent[0] * extent[1] * texel, texel, b->error,
                           sizeof b->error) ||
        !host_begin_frame(&b->device, &cmd, b->error, sizeof b->error))
        return false;
    host_image_barrier(cmd, image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    return host_submit(&b->device, b->error, sizeof b->error) && host_wait(&b->device, b->error, sizeof b->error);
}

/* 1 mm of water on full pores, without rings. */
static bool add_maps(bench *b, street *s)
{
    static uint16_t wet[CELLS * CELLS][4];
    static const uint32_t none[CELLS * CELLS * 2];
    static const uint32_t cells[2] = {CELLS, CELLS}, spots[2] = {2 * CELLS, CELLS}, ripples[2] = {16, 16};
    for (int i = 0; i < CELLS * CELLS; i++)
        wet[i][0] = wet[i][1] = 0x3c00; /* 1 */
    return add_map(b, VK_FORMAT_R16G16B16A16_SFLOAT, cells, wet, 8, &s->maps[0]) &&
           add_map(b, VK_FORMAT_R32_UINT, spots, none, 4, &s->maps[1]) &&
           add_map(b, VK_FORMAT_R16G16_SFLOAT, ripples, none, 4, &s->maps[2]);
}

static bool open_street(bench *b, street *s)
{
    static const float up[3] = {0, 1, 0}, right[3] = {1, 0, 0}, left[3] = {-1, 0, 0};
    static const float ground[4][3] = {{-6, 0, -40}, {6, 0, -40}, {6, 0, 10}, {-6, 0, 10}};
    static const float walls[2][4][3] = {{{-5, 0, -40}, {-5, 0, 10}, {-5, 8, 10}, {-5, 8, -40}},
                                         {{5, 0, -40}, {5, 0, 10}, {5, 8, 10}, {5, 8, -40}}};
    const host_environment_def sky = host_default_environment();
    char *error = b->error;
    const size_t size = sizeof b->error;
    virga_light lamps[LAMPS];
    for (int i = 0; i < LAMPS; i++)
        lamps[i] = (virga_light){.position_m = {i % 2 ? 3.5 : -3.5, 4, -2 - 8 * i}, .intensity = {7, 6, 4}};
    if (!host_renderer_create(&b->device, &s->renderer, error, size) || !add_quad(b, s, 0, ground, up) ||
        !add_quad(b, s, 1, walls[0], right) || !add_quad(b, s, 2, walls[1], left) || !add_maps(b, s) ||
        !host_environment_create(&b->device, &sky, &s->environment, error, size) ||
        !host_renderer_set_environment(s->renderer, &s->environment, error, size) ||
        !host_renderer_set_mirror(s->renderer, &b->targets[SIZE], 0, error, size) ||
        !host_surroundings_create(&b->device, &s->surroundings, error, size))
        return false;
    host_renderer_set_lights(s->renderer, lamps, LAMPS);
    return true;
}

static void close_street(bench *b, street *s)
{
    host_surroundings_destroy(&b->device, &s->surroundings);
    host_renderer_destroy(&s->renderer);
    host_environment_destroy(&b->device, &s->environment);
    for (int i = 0; i < 3; i++) {
        host_mesh_destroy(&b->device, &s->meshes[i]);
        host_image_destroy(&b->device, &s->maps[i]);
    }
}

/* Turns on the parts up to one, and the others off. */
static bool choose(bench *b, const street *s, int part)
{
    const virga_ground_maps maps = {.wetness = s->maps[0].view,
                                    .spots = s->maps[1].view,
                                    .ripples = s->maps[2].view,
                                    .ripple_texels = 16,
                                    .ripple_texel_m = 1,
                                    .cells = CELLS,
                                    .cell_m = CELL_M,
                                    .low_m = {-0.5 * CELLS, -0.5 * CELLS},
                                    .high_m = {0.5 * CELLS, 0.5 * CELLS}};
    virga_walls walls = {.slant = {0.3f, 0}, .spread = 0.1f};
    for (int row = 0; row < VIRGA_WALL_ROWS; row++)
        for (int i = 0; i < VIRGA_WALL_MATERIALS; i++)
            walls.rows[row][i] = (virga_wall_gpu){.wet = 0.8f, .film_mm = 0.03f, .run_mm_h = 1, .fall_mm_h = 10};
    host_renderer_set_ground(s->renderer, part >= WET_GROUND ? &maps : NULL);
    host_renderer_set_contact(s->renderer, part >= CONTACT);
    host_renderer_set_meniscus(s->renderer, part >= MENISCUS);
    return host_renderer_set_walls(s->renderer, part >= WALLS ? &walls : NULL, b->error, sizeof b->error);
}

static bool draw(bench *b, street *s, double *waited_ms, double *worked_ms)
{
    static const host_camera_key key = {.position_m = {0, 1.6, 6}, .look_at_m = {0, 1.6, 0}};
    static const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 50, .near_m = 0.1, .far_m = 200};
    host_camera camera;
    VkCommandBuffer cmd;
    host_camera_at(&path, 0, bench_sizes[SIZE][0], bench_sizes[SIZE][1], NULL, &camera);
    const double start = bench_worked_ms();
    if (!bench_begin(b, &cmd) ||
        !host_renderer_plate(s->renderer, cmd, &b->targets[SIZE], &camera, &camera, b->error, sizeof b->error) ||
        !bench_submit(b, waited_ms))
        return false;
    *worked_ms = bench_worked_ms() - start;
    return true;
}

/* By turns, so that what else runs on the machine is in all of them. The first of each part has what is drawn once: it
 * is not counted. */
static bool measure_parts(bench *b, street *s, double fill_ms)
{
    double waited[PARTS][BENCH_RUNS], worked[PARTS][BENCH_RUNS], whole[PARTS], used[PARTS], once;
    bool good = true;
    for (int run = -1; good && run < BENCH_RUNS; run++)
        for (int part = DRY; good && part < PARTS; part++) {
            double *waited_ms = run < 0 ? &once : &waited[part][run];
            good = choose(b, s, part) && draw(b, s, waited_ms, run < 0 ? &once : &worked[part][run]);
        }
    for (int part = DRY; good && part < PARTS; part++) {
        whole[part] = bench_median(waited[part], BENCH_RUNS);
        used[part] = bench_median(worked[part], BENCH_RUNS);
        const double before = part ? whole[part - 1] : 0, used_before = part ? used[part - 1] : 0;
        printf("  %s%-16s %10.3f ms %8.2f x a fill, processors %10.3f ms\n", part ? "+ " : "  ", part_names[part],
               whole[part] - before, (whole[part] - before) / fill_ms, used[part] - used_before);
    }
    return good;
}

static bool measure_place(bench *b, street *s)
{
    double waited[PLACES], worked[PLACES];
    float sh[9][3];
    for (int i = -1; i < PLACES; i++) {
        const double position_m[3] = {0, 1.6, 2.0 * i}, start_ms = 1e3 * progress_now(), start = bench_worked_ms();
        if (!host_surroundings_light(&s->surroundings, s->renderer, position_m, sh, b->error, sizeof b->error))
            return false;
        if (i < 0)
            continue;
        waited[i] = 1e3 * progress_now() - start_ms;
        worked[i] = bench_worked_ms() - start;
    }
    printf("light of a place, once where the camera has moved on:\n    %-16s %10.3f ms, processors %10.3f ms\n", "",
           bench_median(waited, PLACES), bench_median(worked, PLACES));
    return true;
}

static bool run(bench *b, const options *parsed)
{
    (void)parsed;
    street s = {.renderer = NULL};
    limits *l;
    if (!limits_create(&b->device, &b->targets[SIZE], 1024, &l, b->error, sizeof b->error))
        return bench_fail(b, "fill");
    limits_fill_ms(&b->device, l, &b->targets[SIZE]); /* the first compiles */
    const double fill_ms = limits_fill_ms(&b->device, l, &b->targets[SIZE]);
    limits_destroy(&b->device, &l);
    printf("the program's plate of a street, %u x %u, each part added to those before; median of %d\n",
           bench_sizes[SIZE][0], bench_sizes[SIZE][1], BENCH_RUNS);
    const bool good = open_street(b, &s) && measure_parts(b, &s, fill_ms) && measure_place(b, &s);
    const bool waited = host_wait(&b->device, b->error, sizeof b->error);
    close_street(b, &s);
    return (good && waited) || bench_fail(b, "plate");
}

const tool_bench plate_bench = {
    .name = "plate",
    .help = "the program's own shading of wet ground and walls, part by part; the light of a place\n",
    .run = run,
};
