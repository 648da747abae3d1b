/* model_frame.c - see model_frame.h. */
#include "bench/model_frame.h"

#include "options.h"
#include "progress.h"

#include <stdio.h>

#define WARM_UP 90 /* frames until rings, splashes and drops are in a steady state */

/* A game's frame: a street around the camera, a windshield before it. */
typedef struct frame_case {
    const char *what;
    uint32_t drops, splashes, cells, ring_texels, pane_texels, metaballs;
    double rate_mm_h;
} frame_case;

static const frame_case frame_cases[] = {
    {"a game's ordinary frame: 100,000 slots of rain, a map of occlusion, 512 x 512 cells, a windshield", 100000, 16384,
     512, 512, 1024, 4096, 100},
};

static bool make_scene(bench *b, const frame_case *c, virga_scene **scene)
{
    virga_glass_def pane = virga_default_glass_def();
    virga_scene_def def = virga_default_scene_def();
    virga_target_def target = virga_default_target_def();
    pane.max_texels = c->pane_texels;
    pane.max_drops = c->metaballs;
    def.rain.max_drops = c->drops;
    def.rain.max_panes = 1;
    def.ground.cells = c->cells;
    def.ground.ripple_texels = c->ring_texels;
    def.splash.max_splashes = c->splashes;
    def.splash.max_droplets = 8 * c->splashes;
    def.with_ground = def.with_splash = true;
    def.panes = &pane;
    def.pane_count = 1;
    host_target_describe_layer(&b->targets[1], &target);
    return (virga_scene_create(b->context, &def, scene) >= 0 &&
            virga_target_create(b->context, &target, &b->layer) == VIRGA_OK &&
            virga_scene_attach(*scene, b->layer) == VIRGA_OK) ||
           options_complain("bench", "no scene could be made");
}

static bool set_rain(virga_scene *scene, const frame_case *c)
{
    virga_rain_settings rain = virga_default_rain_settings();
    virga_ground_settings ground = virga_default_ground_settings();
    rain.rate_mm_h = (float)c->rate_mm_h;
    rain.transition_s = 0;
    rain.wind_m_s[2] = -8;       /* onto the pane */
    rain.occlusion_interval = 4; /* one of the four maps in each frame */
    ground.start_wetness = 1;
    ground.start_water_mm = 2;
    return virga_rain_set(virga_scene_rain(scene), &rain) == VIRGA_OK &&
           virga_ground_set(virga_scene_ground(scene), &ground) == VIRGA_OK;
}

static bool run_frame(bench *b, virga_scene *scene, const virga_view *view, bool is_last)
{
    VkCommandBuffer cmd;
    double ms;
    const virga_scene_pane pane = {.pose = {.position_m = {0, 1.7f, -1}}};
    const virga_scene_frame frame = {.dt_s = 1.0 / 60,
                                     .camera_m = {0, 1.7, 0},
                                     .occluders = &b->floor,
                                     .occluder_count = 1,
                                     .view = view,
                                     .panes = &pane};
    if (!bench_begin(b, &cmd))
        return false;
    if (is_last)
        counting_all_of_next();
    if (virga_scene_record(scene, cmd, &frame) < 0)
        return options_complain("bench", "a frame failed");
    if (b->model == &model_here)
        counting_begin_draws(cmd, "draws");
    host_target_begin_layer(&b->targets[1], cmd);
    const bool drawn = virga_scene_draw(scene, cmd, b->layer) >= 0;
    host_target_end_layer(&b->targets[1], cmd);
    if (b->model == &model_here)
        counting_end_draws(cmd);
    return bench_submit(b, &ms) && (drawn || options_complain("bench", "a draw failed"));
}

static void print_case(virga_scene *scene, const frame_case *c)
{
    virga_splash_stats splash;
    virga_splash_stats_get(virga_scene_splash(scene), &splash);
    printf("%s; %u x %u pixels, rain of %g mm/h: %u splashes\n", c->what, bench_sizes[1][0], bench_sizes[1][1],
           c->rate_mm_h, splash.splashes_alive);
}

static bool run_case(bench *b, const frame_case *c)
{
    virga_scene *scene = NULL;
    virga_view view;
    bench_view(&view, 1);
    b->floor.ground = true;
    b->floor.material = VIRGA_MATERIAL_ASPHALT;
    bool good = make_scene(b, c, &scene) && set_rain(scene, c);
    for (int i = 0; i < WARM_UP && good && !interrupt_requested(); i++)
        good = run_frame(b, scene, &view, false);
    if (b->model != &model_here) /* the times of the frames before are kept */
        counting_forget();
    good = good && run_frame(b, scene, &view, true);
    if (good && !interrupt_requested()) {
        print_case(scene, c);
        bench_print_model(b);
    }
    virga_target_destroy(&b->layer);
    virga_scene_destroy(&scene);
    return good;
}

bool bench_model_frames(bench *b)
{
    bool good = true;
    for (size_t i = 0; i < sizeof frame_cases / sizeof frame_cases[0] && good && !interrupt_requested(); i++)
        good = run_case(b, &frame_cases[i]);
    return good;
}
