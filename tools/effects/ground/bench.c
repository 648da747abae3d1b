/* bench.c - `virga bench ground`: a wet floor in heavy rain, at three sizes of window, and wheels and feet on it. */
#include "bench/bench.h"
#include "bench_plate.h"
#include "effect.h"
#include "options.h"
#include "progress.h"

#include <stdio.h>
#include <string.h>

/* The passes of every step. The last two run only when the window and the map beyond it move. */
static const char *const passes[] = {"ground.land",    "ground.flow",   "ground.rings", "ground.map",
                                     "ground.measure", "ground.window", "ground.far"};

enum { PASSES = sizeof passes / sizeof passes[0], STEADY_PASSES = PASSES - 2 };

#define SETTLE_STEPS 30 /* half a second, for rings to fill their buffer */
#define MOVE_M       64 /* there and back, on a floor of 200 m: farther than either may be off the camera */

static bool open_scene(bench *b, uint32_t cells, virga_scene **scene)
{
    virga_scene_def def = virga_default_scene_def();
    def.with_ground = true;
    def.ground.cells = cells;
    if (virga_scene_create(b->context, &def, scene) < 0)
        return options_complain("bench", "no ground of %u x %u cells could be made", cells, cells);
    virga_rain_settings rain = virga_default_rain_settings();
    virga_ground_settings ground = virga_default_ground_settings();
    rain.rate_mm_h = 50;
    ground.start_water_mm = 4;
    return virga_rain_set(virga_scene_rain(*scene), &rain) == VIRGA_OK &&
           virga_ground_set(virga_scene_ground(*scene), &ground) == VIRGA_OK;
}

static bool step(bench *b, virga_scene *scene, double camera_x_m)
{
    VkCommandBuffer cmd;
    double whole;
    const virga_scene_frame frame = {.dt_s = 1.0 / 60,
                                     .camera_m = {camera_x_m, 1.7, 0},
                                     .ripple_center_m = {camera_x_m, 0, 0},
                                     .occluders = &b->floor,
                                     .occluder_count = 1};
    return (bench_begin(b, &cmd) && virga_scene_record(scene, cmd, &frame) >= 0 && bench_submit(b, &whole)) ||
           options_complain("bench", "a step failed");
}

static bool measure_limits(bench *b, uint32_t cells, double *copy, double *bare)
{
    limits *machine = NULL;
    const bool good = limits_create(&b->device, &b->targets[0], cells * cells, &machine, b->error, sizeof b->error) ||
                      bench_fail(b, "limits");
    if (good) {
        *copy = limits_copy_ms(&b->device, machine);
        *bare = limits_bare_ms(&b->device, machine);
    }
    limits_destroy(&b->device, &machine);
    return good;
}

static bool time_passes(bench *b, virga_scene *scene, double times[PASSES][BENCH_RUNS])
{
    bool good = true;
    for (int i = -SETTLE_STEPS; good && i < BENCH_RUNS; i++) {
        good = step(b, scene, 0);
        for (int j = 0; j < STEADY_PASSES && good && i >= 0; j++)
            times[j][i] = bench_pass_ms(b, passes[j]);
    }
    for (int i = 0; good && i < BENCH_RUNS; i++) {
        good = step(b, scene, i % 2 ? 0 : MOVE_M);
        for (int j = STEADY_PASSES; j < PASSES && good; j++)
            times[j][i] = bench_pass_ms(b, passes[j]);
    }
    return good;
}

static void print_passes(uint32_t cells, double times[PASSES][BENCH_RUNS], double bare_ms)
{
    for (int j = 0; j < PASSES; j++) {
        const double ms = bench_median(times[j], BENCH_RUNS);
        if (j < STEADY_PASSES)
            printf("  %-16s %8.3f ms  %6.2f x bare kernel  %7.2f ns a cell\n", passes[j], ms, ms / bare_ms,
                   ms * 1e6 / ((double)cells * cells));
        else
            printf("  %-16s %8.3f ms  where the camera has gone %d m\n", passes[j], ms, MOVE_M);
    }
}

static bool measure(bench *b, uint32_t cells)
{
    double times[PASSES][BENCH_RUNS], copy = 0, bare = 0;
    virga_scene *scene = NULL;
    bool good = open_scene(b, cells, &scene) && time_passes(b, scene, times);
    virga_rain_stats rain = {0};
    if (good)
        virga_rain_stats_get(virga_scene_rain(scene), &rain);
    virga_scene_destroy(&scene);
    good = good && measure_limits(b, cells, &copy, &bare);
    if (!good)
        return false;
    printf("%u x %u cells, %u impacts a tick\n", cells, cells, rain.impacts);
    printf("  machine          copy of 16 bytes a cell %.3f ms, bare kernel over them %.3f ms\n", copy, bare);
    print_passes(cells, times, bare);
    fflush(stdout);
    bench_print_model(b);
    return true;
}

/* ---- wheels and feet */

#define SPEED_M_S (60 / 3.6)

/* They come back every two seconds, in rows of four: a row every 10 m. */
static void place_wheels(uint32_t count, uint32_t step, virga_wheel *wheels)
{
    for (uint32_t i = 0; i < count; i++) {
        wheels[i] = virga_default_wheel();
        wheels[i].id = i;
        wheels[i].contact_m[0] = (step % 120 / 60.0 - 1) * SPEED_M_S + 1.5 * (i / 2 % 2);
        wheels[i].contact_m[2] = 1.5 * (i % 2) + 3 * (i / 4 - 8.0);
        wheels[i].velocity_m_s[0] = (float)SPEED_M_S;
        wheels[i].axle[0] = 0;
        wheels[i].axle[2] = 1;
    }
}

#define STRIDE_STEPS 60 /* a foot treads once in a second, at 0.7 m/s */
#define STAND_STEPS  36
#define TREAD_STEPS  6
#define TREAD_M_S    0.7
#define LIFT_M       (TREAD_STEPS * TREAD_M_S / 60)

/* Eight in a row, each at a time of its own, so that frames are alike. */
static void place_feet(uint32_t count, uint32_t step, virga_foot *feet)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t time = (step + 37 * i) % STRIDE_STEPS, left = STRIDE_STEPS - time;
        const bool treads = left <= TREAD_STEPS;
        feet[i] = virga_default_foot();
        feet[i].id = i;
        feet[i].sole_m[0] = 1.4 * ((step + 37 * i) / STRIDE_STEPS % 4) + 6 * (i / 8 - 4.0);
        feet[i].sole_m[1] = time < STAND_STEPS ? 0 : treads ? left * TREAD_M_S / 60 : LIFT_M;
        feet[i].sole_m[2] = 0.5 * (i % 8);
        feet[i].velocity_m_s[1] = treads || time == 0 ? (float)-TREAD_M_S : 0;
    }
}

static bool step_contacts(bench *b, virga_scene *scene, bool walks, uint32_t count, uint32_t number)
{
    VkCommandBuffer cmd;
    double whole;
    virga_wheel wheels[VIRGA_GROUND_MAX_CONTACTS];
    virga_foot feet[VIRGA_GROUND_MAX_CONTACTS];
    place_wheels(count, number, wheels);
    place_feet(count, number, feet);
    const virga_scene_frame frame = {.dt_s = 1.0 / 60,
                                     .camera_m = {0, 1.7, 0},
                                     .occluders = &b->floor,
                                     .occluder_count = 1,
                                     .wheels = wheels,
                                     .wheel_count = walks ? 0 : count,
                                     .feet = feet,
                                     .foot_count = walks ? count : 0};
    return (bench_begin(b, &cmd) && virga_scene_record(scene, cmd, &frame) >= 0 && bench_submit(b, &whole)) ||
           options_complain("bench", "a step failed");
}

/* Wheels of a car, and of sixteen; feet of two people, and of 32. Without any the pass is not recorded. */
static bool measure_contacts(bench *b, bool walks, uint32_t count)
{
    double contact[BENCH_RUNS], flight[BENCH_RUNS];
    virga_scene_def def = virga_default_scene_def();
    virga_scene *scene = NULL;
    virga_ground_settings ground = virga_default_ground_settings();
    virga_rain_settings rain = virga_default_rain_settings();
    def.with_ground = def.with_splash = def.with_contacts = true;
    if (virga_scene_create(b->context, &def, &scene) < 0)
        return options_complain("bench", "no ground with wheels and feet could be made");
    ground.start_water_mm = 4;
    rain.rate_mm_h = 0;
    bool good = virga_ground_set(virga_scene_ground(scene), &ground) == VIRGA_OK &&
                virga_rain_set(virga_scene_rain(scene), &rain) == VIRGA_OK;
    for (int i = -SETTLE_STEPS; good && i < BENCH_RUNS; i++) {
        good = step_contacts(b, scene, walks, count, (uint32_t)(i + SETTLE_STEPS));
        if (i < 0)
            continue;
        contact[i] = bench_pass_ms(b, "ground.contact");
        flight[i] = bench_pass_ms(b, "splash.step");
    }
    virga_splash_stats splash;
    virga_splash_stats_get(virga_scene_splash(scene), &splash);
    virga_scene_destroy(&scene);
    if (good)
        printf("%u %s on wet ground, %u droplets in the air\n  ground.contact   %8.3f ms\n"
               "  splash.step      %8.3f ms\n",
               count, walks ? "feet that walk" : "wheels at 60 km/h", splash.droplets_alive,
               bench_median(contact, BENCH_RUNS), bench_median(flight, BENCH_RUNS));
    return good;
}

static bool run(bench *b, const options *parsed)
{
    (void)parsed;
    static const uint32_t sides[] = {256, 1024, 2048};
    bool good = true;
    b->floor.ground = true;
    b->floor.material = VIRGA_MATERIAL_ASPHALT;
    for (size_t i = 0; good && !interrupt_requested() && i < sizeof sides / sizeof sides[0]; i++)
        good = measure(b, sides[i]);
    for (int i = 0; good && !interrupt_requested() && i < 4; i++)
        good = measure_contacts(b, i > 1, i % 2 ? 64 : 4);
    return good;
}

const tool_bench ground_bench = {
    .next = &plate_bench,
    .help = "landing, flow, ripples, maps and sums at 256^2 to 2048^2 cells in heavy rain;\n"
            "wheels at 60 km/h, and feet that walk\n",
    .run = run,
};
