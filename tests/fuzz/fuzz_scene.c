/* fuzz_scene.c - bytes become settings, motions and frames of a small scene of all effects on the software device;
 * after each frame its state is read back, and must be finite, in range and full of counted water. Anything else
 * aborts.
 *
 * An input is read from the front, two bytes a number; where it ends, numbers are 0. The same input gives the same
 * frames, whatever ran before: each has a scene of its own. */
#include <stdlib.h>

#include "../gpu/watch.h"

#include "../gpu/small_scene.h"
#include "../gpu/small_state.h"

#include "fuzz.h"

#define MUST(condition)                                                           \
    do {                                                                          \
        if (!(condition)) {                                                       \
            fprintf(stderr, "not so: %s; the last line: %s\n", #condition, said); \
            abort();                                                              \
        }                                                                         \
    } while (0)

enum { FUZZ_MAX_FRAMES = 6 };

static host_instance instance;
static host_device device;
static host_buffer vertices, indices;
static char error[512], said[512];

static void keep_line(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)user;
    (void)level;
    snprintf(said, sizeof said, "%s: %s", virga_log_name(id), text);
}

/* Once for a process; what it makes lives as long. */
static void open_device(void)
{
    host_device_info infos[HOST_MAX_DEVICES];
    uint32_t index = 0;
    if (device.device)
        return;
    setenv("VIRGA_TEST_DEVICE", "cpu", 0);
    if (!host_instance_create(&instance, false, error, sizeof error) ||
        !host_device_pick(infos, host_devices_list(&instance, infos, HOST_MAX_DEVICES), "cpu", &index, error,
                          sizeof error) ||
        !host_device_create(&device, &instance, &infos[index], error, sizeof error)) {
        printf("skipped: %s\n", error);
        exit(77);
    }
    watch.keep_pipelines = true;
    MUST(host_buffer_create_with(&device, small_square, sizeof small_square, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                                 "square", &vertices, error, sizeof error));
    MUST(host_buffer_create_with(&device, small_square_indices, sizeof small_square_indices,
                                 VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "corners", &indices, error, sizeof error));
}

void fuzz_close(void)
{
    kept_forget();
    host_buffer_destroy(&device, &vertices);
    host_buffer_destroy(&device, &indices);
    if (host_device_destroy(&device) || watch_sum(watch.live))
        abort();
    host_instance_destroy(&instance);
}

/* ---- numbers out of bytes */

typedef struct bytes {
    const uint8_t *at, *end;
} bytes;

static uint32_t read_uint(bytes *b)
{
    uint32_t value = 0;
    for (int i = 0; i < 2 && b->at < b->end; i++)
        value |= (uint32_t)*b->at++ << 8 * i;
    return value;
}

/* Mostly inside a range, sometimes a little or wildly outside of it, or no number at all. */
static double read_number(bytes *b, double low, double high)
{
    static const double wild[] = {
        (double)NAN, (double)INFINITY, -(double)INFINITY, 1e30, -1e30, 1e-40, 0, -1, 1e9, -1e9, 1e300, 3.4e38};
    const uint32_t value = read_uint(b);
    if (value >= 0xff00)
        return wild[value % (sizeof wild / sizeof wild[0])];
    return low + (high - low) * ((value / 65279.0) * 1.02 - 0.01);
}

static float read_float(bytes *b, double low, double high)
{
    return (float)read_number(b, low, high);
}

static void read_floats(bytes *b, float *values, uint32_t count, double low, double high)
{
    for (uint32_t i = 0; i < count; i++)
        values[i] = read_float(b, low, high);
}

static void read_lights(bytes *b, virga_lighting *lighting)
{
    lighting->light_count = read_uint(b) % 3;
    for (uint32_t i = 0; i < lighting->light_count; i++) {
        virga_light *light = &lighting->lights[i];
        for (int axis = 0; axis < 3; axis++)
            light->position_m[axis] = read_number(b, -10, 10);
        read_floats(b, light->intensity, 3, 0, 1000);
        read_floats(b, light->direction, 3, -1, 1);
        light->range_m = read_float(b, 0, 50);
        light->cos_inner = read_float(b, -1, 1);
        light->cos_outer = read_float(b, -1, 1);
    }
}

/* ---- settings: whatever comes of them, the scene goes on */

static void set_rain(bytes *b, virga_scene *scene)
{
    virga_rain_settings s = virga_default_rain_settings();
    double diameters[4], numbers[4];
    s.rate_mm_h = read_float(b, 0, 200);
    s.air_density = read_float(b, 0.3, 2);
    s.transition_s = read_float(b, 0, 0.2);
    read_floats(b, s.wind_m_s, 3, -60, 60);
    s.gust_m_s = read_float(b, 0, 30);
    s.gust_time_s = read_float(b, 0.1, 10);
    s.streak_gain = read_float(b, 0, 100);
    s.haze = read_float(b, 0, 8);
    s.oscillation = read_float(b, 0, 4);
    s.streak_min_mm = read_float(b, 0.2, 2);
    s.streak_group_mm = read_float(b, 0.2, 100);
    s.occlusion_interval = read_uint(b) % 20;
    s.walls.on = s.occlusion_interval % 2;
    s.walls.start_h = s.streak_group_mm;
    s.walls.materials[s.occlusion_interval].film_mm = s.oscillation;
    s.sizes.kind = (virga_sizes_kind)(read_uint(b) % 4);
    s.sizes.table_diameter_m = diameters;
    s.sizes.table_number = numbers;
    s.sizes.table_count = read_uint(b) % 5;
    for (int i = 0; i < 4; i++) {
        diameters[i] = read_number(b, 0, 0.008);
        numbers[i] = read_number(b, 0, 1000);
    }
    read_lights(b, &s.lighting);
    virga_rain_set(virga_scene_rain(scene), &s);
}

static void set_ground(bytes *b, virga_scene *scene)
{
    virga_ground_settings s = virga_default_ground_settings();
    virga_ground_material *m = &s.materials[VIRGA_MATERIAL_ASPHALT];
    m->capacity_mm = read_float(b, 0, 100);
    m->retention_mm = read_float(b, 0, 50);
    m->infiltration_mm_h = read_float(b, 0, 10000);
    m->drying = read_float(b, 0, 10);
    m->manning_n = read_float(b, 0.005, 1);
    m->bump_height_mm = read_float(b, 0, 50);
    m->bump_width_m = read_float(b, 0.2, 50);
    m->drain = read_uint(b) % 8 == 7;
    s.evaporation_mm_h = read_float(b, 0, 100);
    s.start_wetness = read_float(b, 0, 1);
    s.start_water_mm = read_float(b, 0, 50);
    virga_ground_set(virga_scene_ground(scene), &s);
}

static void set_splash(bytes *b, virga_scene *scene)
{
    virga_splash_settings s = virga_default_splash_settings();
    s.mode = (virga_splash_mode)(read_uint(b) % 3);
    s.style = (virga_splash_style)(read_uint(b) % 3);
    for (uint32_t state = 0; state < VIRGA_GROUND_STATES; state++) {
        virga_splash_rule *row = &s.rules[VIRGA_MATERIAL_ASPHALT][state];
        row->model = read_uint(b) % 5;
        row->min_diameter_mm = read_float(b, 0, 1);
        row->min_depth_mm = read_float(b, 0, 2);
        read_floats(b, row->share, 2, 0, 1);
        read_floats(b, row->count, 2, 0, 64);
        read_floats(b, row->angle_deg, 2, 0, 90);
        read_floats(b, row->speed_m_s, 2, 0, 10);
        row->strength = read_float(b, 0, 4);
        row->circle_radius = read_float(b, 0, 10);
    }
    s.pile_max_s = read_float(b, 0.001, 0.2);
    s.pile_max_m = read_float(b, 0.001, 0.2);
    s.bounce = read_float(b, 0, 1);
    s.wind_share = read_float(b, 0, 2);
    s.droplet_range_m = read_float(b, 0, 10);
    s.dot_min_mm = read_float(b, 0.05, 5);
    s.air_density = read_float(b, 0.3, 2);
    virga_splash_set(virga_scene_splash(scene), &s);
}

static void read_wiper(bytes *b, virga_glass_wiper *w)
{
    read_floats(b, w->pivot_m, 2, -0.1, 0.3);
    w->reach_m = read_float(b, 0.01, 0.3);
    w->blade_m = read_float(b, 0.01, 0.3);
    w->width_m = read_float(b, 0.001, 0.1);
    w->low_deg = read_float(b, -720, 720);
    w->high_deg = read_float(b, -720, 720);
    w->blade_deg = read_float(b, -180, 180);
    w->blade_hold_direction = read_float(b, 0, 1);
    w->drive = (virga_glass_drive)(read_uint(b) % 5);
    w->sweep_s = read_float(b, 0.1, 2);
    w->pause_s = read_float(b, 0, 1);
    w->phase_s = read_float(b, 0, 3600);
    w->host_deg = read_float(b, -7200, 7200);
    w->film_mm = read_float(b, 0, 0.5);
    w->wear = read_float(b, 0, 1);
}

static void set_glass(bytes *b, virga_glass *glass)
{
    virga_glass_settings s = virga_default_glass_settings();
    s.advancing_deg = read_float(b, 5, 175);
    s.receding_deg = read_float(b, 1, 175);
    s.drag = read_float(b, 0.01, 100);
    s.kinetic_hold = read_float(b, 0, 1);
    s.affinity = read_float(b, 0, 2);
    s.meander = read_float(b, 0, 1);
    s.path_ease = read_float(b, 0, 1);
    s.path_dry_s = read_float(b, 0.1, 600);
    s.merge_distance = read_float(b, 0, 2);
    s.tail_spacing_m = read_float(b, 0.001, 1);
    s.tail_max_radius_mm = read_float(b, 0, 2);
    s.tail_lifetime_s = read_float(b, 0.1, 3600);
    s.film_um = read_float(b, 0, 100);
    s.film_break_s = read_float(b, 0, 60);
    s.evaporation_mm_h = read_float(b, 0, 100);
    s.mist_max_mm = read_float(b, 0, 1);
    s.air_share = read_float(b, 0, 2);
    s.particle_radius_mm = read_float(b, 0.2, 5);
    s.penalty = read_float(b, 0, 1);
    s.particle_band = read_float(b, 1, 16);
    s.hold_back_mm = read_float(b, 0, 20);
    s.hold_back_cells = read_uint(b) % 10;
    s.density = (virga_glass_density)(read_uint(b) % 6);
    s.blend = (virga_glass_blend)(read_uint(b) % 3);
    s.style = (virga_glass_style)(read_uint(b) % 3);
    s.wiper_count = read_uint(b) % 4;
    for (uint32_t i = 0; i < s.wiper_count; i++)
        read_wiper(b, &s.wipers[i]);
    s.pinning = read_float(b, 0, 1);
    virga_glass_set(glass, &s);
}

/* ---- frames */

static void read_pane(bytes *b, virga_scene_pane *pane)
{
    const uint32_t kind = read_uint(b) % 8;
    for (int axis = 0; axis < 3; axis++)
        pane->pose.position_m[axis] = read_number(b, -2, 2);
    if (kind == 6)
        read_floats(b, pane->pose.world_from_pane, 9, -1, 1);
    if (kind == 7)
        memset(pane->pose.world_from_pane, 0, sizeof pane->pose.world_from_pane);
    read_floats(b, pane->velocity_m_s, 3, -50, 50);
    read_floats(b, pane->acceleration_m_s2, 3, -30, 30);
    read_floats(b, pane->angular_velocity_rad_s, 3, -3, 3);
    pane->shelter = kind & 1 ? read_float(b, 0, 1) : 0;
}

static void read_view(bytes *b, virga_view *view)
{
    static const float level[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    *view = virga_default_view();
    const float lens[16] = {
        read_float(b, 0.1, 10), 0, 0, 0, 0, -read_float(b, 0.1, 10), 0, 0, 0, 0, -1.001f, -1, 0, 0, -0.1001f, 0};
    memcpy(view->view_from_world, level, sizeof level);
    memcpy(view->open_view_from_world, level, sizeof level);
    memcpy(view->clip_from_view, lens, sizeof lens);
    memcpy(view->open_clip_from_view, lens, sizeof lens);
    for (int axis = 0; axis < 3; axis++) {
        view->position_m[axis] = read_number(b, -2, 2);
        view->open_position_m[axis] = read_number(b, -2, 2);
    }
    view->shutter_s = read_number(b, 0, 0.1);
    view->viewport[2] = read_float(b, 0, 64);
    view->viewport[3] = read_float(b, 0, 64);
}

/* Mostly a step or two, and a jump now and then. */
static void read_camera(bytes *b, double camera_m[3])
{
    const uint32_t kind = read_uint(b) % 16;
    const double far = kind == 15 ? 1.2e9 : kind == 14 ? 1e4 : kind > 10 ? 20 : 1;
    for (int axis = 0; axis < 3; axis++)
        camera_m[axis] += read_number(b, -far, far);
}

static void run_frame(bytes *b, virga_context *context, virga_scene *scene, small_state *state, double camera_m[3])
{
    virga_scene_pane panes[SMALL_PANES];
    virga_view view;
    const virga_occluder mesh = small_occluder(vertices.buffer, indices.buffer);
    virga_scene_frame frame = {.dt_s = read_number(b, 0, 0.08), .view = &view, .panes = panes};
    double there[3] = {camera_m[0], camera_m[1], camera_m[2]};
    VkCommandBuffer cmd;
    small_panes_lay(panes);
    for (int i = 0; i < SMALL_PANES; i++)
        read_pane(b, &panes[i]);
    read_view(b, &view);
    read_camera(b, there);
    memcpy(frame.camera_m, there, sizeof there);
    memcpy(frame.ripple_center_m, there, sizeof there);
    if (read_uint(b) % 4) {
        frame.occluders = &mesh;
        frame.occluder_count = 1;
    }
    MUST(host_begin_frame(&device, &cmd, error, sizeof error));
    MUST(virga_frame_begin(context, device.frame, device.completed) == VIRGA_OK);
    const virga_result result = virga_scene_record(scene, cmd, &frame);
    MUST(result >= 0 || result == VIRGA_ERROR_INVALID);
    if (result >= 0)
        small_state_record(state, cmd, scene);
    if (result >= 0)
        memcpy(camera_m, there, sizeof there);
    MUST(host_submit(&device, error, sizeof error) && host_wait(&device, error, sizeof error));
    MUST(virga_frame_completed(context, device.completed) == VIRGA_OK);
    if (result >= 0 && !small_state_check(state, &device, scene)) {
        fprintf(stderr, "%s\n", state->wrong);
        abort();
    }
}

static virga_scene *make_scene(bytes *b, virga_context *context)
{
    virga_glass_def panes[SMALL_PANES];
    virga_scene_def def = small_scene_def(panes);
    virga_scene *scene = NULL;
    def.rain.seed = read_uint(b);
    def.rain.tick_s = read_number(b, 1.0 / 240, 1.0 / 20);
    panes[0].cell_m = read_float(b, 0.004, 0.01);
    panes[0].width_m = read_float(b, 0.01, 0.3);
    panes[0].height_m = read_float(b, 0.01, 0.3);
    if (virga_scene_create(context, &def, &scene) < 0)
        return NULL;
    MUST(small_shape_set(virga_scene_glass(scene, 1), 1) == VIRGA_OK);
    MUST(small_shape_set(virga_scene_glass(scene, 2), 2) == VIRGA_OK);
    MUST(small_weather_set(scene) == VIRGA_OK);
    return scene;
}

static void run_scene(bytes *b, virga_context *context, virga_scene *scene)
{
    small_state state;
    double camera_m[3] = {0, 1.7, 0};
    MUST(small_state_open(&state, &device, scene, error, sizeof error));
    const uint32_t frames = 1 + read_uint(b) % FUZZ_MAX_FRAMES;
    for (uint32_t i = 0; i < frames; i++) {
        const uint32_t sets = read_uint(b);
        if (sets & 1)
            set_rain(b, scene);
        if (sets & 2)
            set_ground(b, scene);
        if (sets & 4)
            set_splash(b, scene);
        for (uint32_t pane = 0; pane < SMALL_PANES; pane++)
            if (sets & 8 << pane)
                set_glass(b, virga_scene_glass(scene, pane));
        run_frame(b, context, scene, &state, camera_m);
    }
    small_state_close(&state, &device);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    bytes b = {data, data + size};
    virga_context *context = NULL;
    open_device();
    virga_context_def def = virga_default_context_def();
    def.instance = instance.instance;
    def.physical_device = device.physical;
    def.device = device.device;
    def.queue_family = device.queue_family;
    def.get_instance_proc_addr = watch_get_instance_proc_addr;
    def.memory_budget = (VkDeviceSize)256 << 20; /* keeps pages of device memory small */
    def.log = keep_line;
    MUST(virga_context_create(&def, &context) == VIRGA_OK);
    virga_scene *scene = make_scene(&b, context);
    if (scene)
        run_scene(&b, context, scene);
    virga_scene_destroy(&scene);
    virga_context_destroy(&context);
    MUST(watch_sum(watch.live) == 0);
    return 0;
}
