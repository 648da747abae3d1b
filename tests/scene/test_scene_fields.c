/* test_scene_fields.c - every field of settings, steps, views and panes of a running scene, one at a time, with valid
 * and with invalid numbers: its state stays finite, and its water adds up. */
#include "../gpu/fields.h"
#include "../gpu/small_state.h"
#include "host_parts.h"

typedef struct fields_test {
    gpu_fixture *f;
    virga_context *context;
    virga_scene *scene;
    gpu_picture picture;
    host_buffer vertices, indices;
    small_state state;
    virga_scene_frame frame; /* what is recorded in each frame, unless a field says otherwise */
    virga_scene_pane panes[SMALL_PANES];
    virga_view view;
    virga_occluder mesh;
    uint32_t frames;
} fields_test;

#define SIZE(table) (sizeof(table) / sizeof(table)[0])

static void open_test(fields_test *t, void **state)
{
    virga_glass_def panes[SMALL_PANES];
    const virga_scene_def def = small_scene_def(panes);
    memset(t, 0, sizeof *t);
    t->f = *state;
    t->context = gpu_context(t->f);
    gpu_picture_open(t->f, t->context, &t->picture);
    host_parts_square(&t->f->gpu, &t->vertices, &t->indices);
    t->mesh = small_occluder(t->vertices.buffer, t->indices.buffer);
    REQUIRE(virga_scene_create(t->context, &def, &t->scene) == VIRGA_OK);
    REQUIRE(small_shapes_set(t->scene) == VIRGA_OK && small_weather_set(t->scene) == VIRGA_OK);
    REQUIRE(small_state_open(&t->state, &t->f->gpu.device, t->scene, t->f->gpu.error, sizeof t->f->gpu.error));
    small_panes_lay(t->panes);
    t->view = gpu_view(&t->picture);
    t->frame = (virga_scene_frame){.dt_s = 1.0 / 60,
                                   .camera_m = {0, 1.7, 0},
                                   .occluders = &t->mesh,
                                   .occluder_count = 1,
                                   .view = &t->view,
                                   .panes = t->panes};
}

static void close_test(fields_test *t)
{
    small_state_close(&t->state, &t->f->gpu.device);
    virga_scene_destroy(&t->scene);
    gpu_picture_close(t->f, &t->picture);
    host_buffer_destroy(&t->f->gpu.device, &t->vertices);
    host_buffer_destroy(&t->f->gpu.device, &t->indices);
    virga_context_destroy(&t->context);
}

/* One frame of the scene; checks the state where it was stepped. */
static virga_result record_frame(fields_test *t, const virga_scene_frame *frame)
{
    VkCommandBuffer cmd = gpu_begin_frame(t->f, t->context);
    const virga_result result = virga_scene_record(t->scene, cmd, frame);
    if (result >= 0)
        small_state_record(&t->state, cmd, t->scene);
    gpu_submit(t->f);
    gpu_wait(t->f);
    REQUIRE(virga_frame_completed(t->context, t->f->gpu.device.completed) == VIRGA_OK);
    if (result >= 0 && !small_state_check(&t->state, &t->f->gpu.device, t->scene))
        fail_msg("frame %u: %s", t->frames, t->state.wrong);
    t->frames++;
    return result;
}

static void try_fields(fields_test *t, const char *name, const void *good, size_t size, const field *fields,
                       uint32_t count, virga_result (*call)(void *, const void *), void (*read)(void *, void *))
{
    const field_table table = {name, good, size, fields, count, call, read, t};
    fields_try(t->f, &table);
    REQUIRE(record_frame(t, &t->frame) >= 0);
}

/* ---- settings */

#define SETTINGS(effect, of)                                                    \
    static virga_result set_##effect(void *user, const void *changed)           \
    {                                                                           \
        return virga_##effect##_set(of(((fields_test *)user)->scene), changed); \
    }                                                                           \
    static void get_##effect(void *user, void *in_force)                        \
    {                                                                           \
        virga_##effect##_get(of(((fields_test *)user)->scene), in_force);       \
    }
#define FIRST_PANE(scene) virga_scene_glass(scene, 0)
SETTINGS(rain, virga_scene_rain)
SETTINGS(splash, virga_scene_splash)
SETTINGS(glass, FIRST_PANE)

static virga_result set_ground(void *user, const void *changed)
{
    return virga_ground_set(virga_scene_ground(((fields_test *)user)->scene), changed);
}

#define FAR                    VIRGA_TESTS_FARTHEST_M
#define VIRGA_TESTS_FARTHEST_M 1e9
#define LARGEST                (double)FLT_MAX
#define LIGHTS(type)                                                           \
    FIELD(type, lighting.environment_sh[8], REFUSED, -LARGEST, LARGEST),       \
        FIELD(type, lighting.lights[0].position_m, REFUSED, -FAR, FAR),        \
        FIELD(type, lighting.lights[0].intensity, REFUSED, -LARGEST, LARGEST), \
        FIELD(type, lighting.lights[0].range_m, REFUSED, -LARGEST, LARGEST),   \
        FIELD(type, lighting.lights[0].direction, REFUSED, -LARGEST, LARGEST), \
        FIELD(type, lighting.lights[0].cos_inner, REFUSED, -LARGEST, LARGEST), \
        FIELD(type, lighting.lights[0].cos_outer, REFUSED, -LARGEST, LARGEST), \
        FIELD(type, lighting.light_count, CLAMPED, 0, VIRGA_MAX_LIGHTS)

#define F(member, low, high) FIELD(virga_rain_settings, member, CLAMPED, low, high)
static void rain_settings_fields(void **state)
{
    static const field fields[] = {
        F(rate_mm_h, 0, 200),
        F(air_density, 0.3, 2),
        F(transition_s, 0, 60),
        F(wind_m_s, -60, 60),
        F(gust_m_s, 0, 30),
        F(gust_time_s, 0.1, 600),
        F(streak_gain, 0, 100),
        F(light_gain, 0, 100),
        F(min_width_px, 0.5, 4),
        F(soft_m, 0, 1),
        F(near_fade_m, 0, 5),
        F(oscillation, 0, 4),
        F(haze, 0, 8),
        F(haze_sky_m, 0, 100000),
        F(glow, 0, 100),
        F(streak_min_mm, 0.2, 2),
        F(streak_group_mm, 0.2, 100),
        F(default_material, 0, 255),
        F(walls.share, 0, 2),
        F(walls.evaporation_mm_h, 0, 100),
        F(walls.start_h, 0, 240),
        FIELD(virga_rain_settings, wind_min_m, REFUSED, -FAR, FAR),
        FIELD(virga_rain_settings, wind_max_m, REFUSED, -FAR, FAR),
        LIGHTS(virga_rain_settings),
    };
    fields_test t;
    open_test(&t, state);
    virga_rain_settings good = virga_default_rain_settings();
    good.lighting.light_count = 1;
    try_fields(&t, "rain_settings", &good, sizeof good, fields, SIZE(fields), set_rain, get_rain);
    close_test(&t);
}
#undef F

#define F(member, low, high) FIELD(virga_ground_settings, member, CLAMPED, low, high)
static void ground_settings_fields(void **state)
{
    static const field fields[] = {
        F(evaporation_mm_h, 0, 100),
        F(start_wetness, 0, 1),
        F(start_water_mm, 0, 50),
        F(materials[3].capacity_mm, 0, 100),
        F(materials[3].retention_mm, 0, 50),
        F(materials[3].infiltration_mm_h, 0, 10000),
        F(materials[3].drying, 0, 10),
        F(materials[3].manning_n, 0.005, 1),
        F(materials[31].bump_height_mm, 0, 50),
        F(materials[31].bump_width_m, 0.2, 50),
    };
    fields_test t;
    open_test(&t, state);
    const virga_ground_settings good = virga_default_ground_settings();
    try_fields(&t, "ground_settings", &good, sizeof good, fields, SIZE(fields), set_ground, NULL);
    close_test(&t);
}
#undef F

#define F(member, low, high) FIELD(virga_splash_settings, member, CLAMPED, low, high)
static void splash_settings_fields(void **state)
{
    static const field fields[] = {
        FIELD(virga_splash_settings, mode, REFUSED, 0, 1),
        FIELD(virga_splash_settings, style, REFUSED, 0, 1),
        F(rules[0][0].model, 0, VIRGA_SPLASH_DISK),
        F(rules[0][0].min_diameter_mm, 0, 10),
        F(rules[0][0].min_depth_mm, 0, 100),
        F(rules[0][0].share, 0, 1),
        F(rules[0][0].count, 0, 64),
        F(rules[0][0].angle_deg, 0, 90),
        F(rules[0][0].speed_m_s, 0, 10),
        F(rules[31][5].strength, 0, 4),
        F(rules[31][5].circle_radius, 0, 10),
        F(pile_max_s, 0.001, 0.2),
        F(pile_max_m, 0.001, 0.2),
        F(bounce, 0, 1),
        F(wind_share, 0, 2),
        F(droplet_range_m, 0, 1000),
        F(dot_min_mm, 0.05, 5),
        F(air_density, 0.3, 2),
        F(gain, 0, 100),
        F(light_gain, 0, 100),
        F(min_width_px, 0.5, 4),
        F(soft_m, 0, 1),
        F(near_fade_m, 0, 5),
        LIGHTS(virga_splash_settings),
    };
    fields_test t;
    open_test(&t, state);
    virga_splash_settings good = virga_default_splash_settings();
    good.lighting.light_count = 1;
    good.rules[0][0] =
        (virga_splash_rule){.share = {0, 1}, .count = {0, 64}, .angle_deg = {0, 90}, .speed_m_s = {0, 10}};
    try_fields(&t, "splash_settings", &good, sizeof good, fields, SIZE(fields), set_splash, get_splash);
    close_test(&t);
}
#undef F

#define F(member, low, high) FIELD(virga_glass_settings, member, CLAMPED, low, high)
static const field glass_fields[] = {
    F(advancing_deg, 5, 175),
    F(receding_deg, 1, 63),
    F(drag, 0.01, 100),
    F(kinetic_hold, 0, 1),
    F(affinity, 0, 2),
    F(meander, 0, 1),
    F(path_ease, 0, 1),
    F(path_dry_s, 0.1, 600),
    F(merge_distance, 0, 2),
    F(tail_spacing_m, 0.001, 1),
    F(tail_max_radius_mm, 0, 2),
    F(tail_lifetime_s, 0.1, 3600),
    F(film_um, 0, 100),
    F(film_break_s, 0, 60),
    F(evaporation_mm_h, 0, 100),
    F(mist_max_mm, 0, 1),
    F(air_share, 0, 2),
    F(particle_radius_mm, 0.2, 5),
    F(penalty, 0, 1),
    F(particle_band, 1, 16),
    F(hold_back_mm, 0, 20),
    F(hold_back_cells, 0, 8),
    F(compress_from, 0, 2),
    F(compress_step, 0, 1),
    F(compress_k, 0, 1),
    F(compress_steps, 0, 16),
    F(threshold, 0.05, 0.95),
    F(impact_s, 0, 2),
    F(paper_shift, 0, 4),
    F(thickness_mm, 0, 50),
    F(tint, 0, 1),
    F(gain, 0, 100),
    F(wiper_count, 0, 8),
    F(wipers[0].pivot_m, -20, 20),
    F(wipers[0].reach_m, 0.01, 10),
    F(wipers[0].blade_m, 0.01, 0.6),
    F(wipers[0].width_m, 0.001, 0.1),
    F(wipers[0].low_deg, -720, 720),
    F(wipers[0].high_deg, -720, 720),
    F(wipers[0].blade_deg, -180, 180),
    F(wipers[0].blade_hold_direction, 0, 1),
    F(wipers[0].sweep_s, 0.1, 60),
    F(wipers[0].pause_s, 0, 3600),
    F(wipers[0].phase_s, 0, 3600),
    F(wipers[0].host_deg, -7200, 7200),
    F(wipers[0].film_mm, 0, 0.5),
    F(wipers[0].wear, 0, 1),
    FIELD(virga_glass_settings, wipers[0].drive, REFUSED, 0, 3),
    FIELD(virga_glass_settings, density, REFUSED, 0, 4),
    FIELD(virga_glass_settings, blend, REFUSED, 0, 1),
    FIELD(virga_glass_settings, style, REFUSED, 0, 3),
    FIELD(virga_glass_settings, texture_shape, REFUSED, 0, 1),
    F(textured_px, 0, 64),
    F(textures_per_frame, 0, 1024),
    F(veil, 0, 1),
    F(starburst, 0, 1),
    F(starburst_rays, 1, 8),
    F(starburst_deg, -360, 360),
    F(opening_blades, 0, 16),
    F(opening_roundness, 0, 1),
    F(opening_deg, -360, 360),
    F(air_outward, 0, 2),
    F(pinning, 0, 1),
    LIGHTS(virga_glass_settings),
};

static void glass_settings_fields(void **state)
{
    fields_test t;
    open_test(&t, state);
    virga_glass_settings good = virga_default_glass_settings();
    good.wiper_count = good.lighting.light_count = 1;
    /* What bounds another field is tried where the other fits under all of its range. */
    const field *rest = glass_fields + 1;
    try_fields(&t, "glass_settings", &good, sizeof good, rest, 33, set_glass, get_glass);
    try_fields(&t, "glass_settings", &good, sizeof good, glass_fields + 35, SIZE(glass_fields) - 35, set_glass,
               get_glass);
    good.receding_deg = 1;
    good.wipers[0].blade_m = 0.01f;
    try_fields(&t, "glass_settings", &good, sizeof good, glass_fields, 1, set_glass, get_glass);
    try_fields(&t, "glass_settings", &good, sizeof good, glass_fields + 34, 1, set_glass, get_glass);
    close_test(&t);
}
#undef F

/* ---- frames */

static virga_result frame_with(void *user, const void *changed)
{
    return record_frame(user, changed);
}

static virga_result frame_with_view(void *user, const void *changed)
{
    const fields_test *t = user;
    virga_scene_frame frame = t->frame;
    frame.view = changed;
    return record_frame(user, &frame);
}

static virga_result frame_with_panes(void *user, const void *changed)
{
    const fields_test *t = user;
    virga_scene_frame frame = t->frame;
    frame.panes = changed;
    return record_frame(user, &frame);
}

static virga_result frame_with_mesh(void *user, const void *changed)
{
    const fields_test *t = user;
    virga_scene_frame frame = t->frame;
    frame.occluders = changed;
    return record_frame(user, &frame);
}

#define F(member, rule, low, high) FIELD(virga_scene_frame, member, rule, low, high)
static void scene_frame_fields(void **state)
{
    static const field fields[] = {
        F(camera_m, REFUSED, -FAR, FAR),
        F(ripple_center_m, REFUSED, -FAR, FAR),
        F(materials.low_m, REFUSED, -FAR, FAR),
        F(materials.high_m, REFUSED, -FAR, FAR),
    };
    static const double dts[][2] = {{NAN, VIRGA_ERROR_INVALID},
                                    {INFINITY, VIRGA_ERROR_INVALID},
                                    {-1, VIRGA_ERROR_INVALID},
                                    {-1e-300, VIRGA_ERROR_INVALID},
                                    {10.01, VIRGA_ERROR_INVALID},
                                    {1e300, VIRGA_ERROR_INVALID},
                                    {0, VIRGA_OK},
                                    {1e-310, VIRGA_OK},
                                    {10, VIRGA_DEGRADED}}; /* all of it but max_ticks_per_step is dropped */
    fields_test t;
    open_test(&t, state);
    try_fields(&t, "scene_frame", &t.frame, sizeof t.frame, fields, SIZE(fields), frame_with, NULL);
    for (size_t i = 0; i < SIZE(dts); i++) {
        virga_scene_frame frame = t.frame;
        frame.dt_s = dts[i][0];
        gpu_forget_log(t.f);
        assert_int_equal(record_frame(&t, &frame), (int)dts[i][1]);
        assert_int_equal(field_lines(t.f), dts[i][1] != VIRGA_OK);
    }
    close_test(&t);
}
#undef F

#define F(member, rule, low, high) FIELD(virga_view, member, rule, low, high)
static void view_fields(void **state)
{
    const gpu_fixture *f = *state;
    VkPhysicalDeviceProperties device;
    vkGetPhysicalDeviceProperties(f->gpu.device.physical, &device);
    const VkPhysicalDeviceLimits *limits = &device.limits;
    const field fields[] = {
        F(position_m, REFUSED, -FAR, FAR),
        F(open_position_m, REFUSED, -FAR, FAR),
        F(shutter_s, REFUSED, 0, 1),
        F(sub_frames, REFUSED, 1, 65536),
        F(jitter_px[0], REFUSED, -16, 16),
        F(open_camera_s, REFUSED, 0, 1e9),
        F(aperture_m, REFUSED, 0, 1),
        F(focus_m, REFUSED, 0, 1e6),
        F(viewport[0], REFUSED, (double)limits->viewportBoundsRange[0], (double)limits->viewportBoundsRange[1] - 16),
        F(viewport[2], EMPTY, 1, limits->maxViewportDimensions[0]),
        F(clip_from_view[0], REFUSED, 1e-4, 1e7),
        F(view_from_world[0], REFUSED, 0.98, 1.0198),
        F(open_view_from_world[5], REFUSED, 0.98, 1.0198),
        F(view_from_world[1], REFUSED, -0.04, 0.04),
        F(clip_from_view[11], REFUSED, -1, -1),
        F(open_clip_from_view[11], REFUSED, -1, -1),
        F(clip_from_view[8], REFUSED, -1e7, 1e7),
    };
    fields_test t;
    open_test(&t, state);
    try_fields(&t, "view", &t.view, sizeof t.view, fields, 7, frame_with_view, NULL);
    /* Signs do not matter to what follows, so these are tried with what is wrong alone. */
    for (size_t i = 7; i < SIZE(fields); i++) {
        static const double wrong[] = {NAN, INFINITY, -INFINITY, 3e38, -3e38};
        for (size_t k = 0; k < SIZE(wrong); k++)
            field_try(t.f, &(field_table){"view", &t.view, sizeof t.view, fields, 0, frame_with_view, NULL, &t},
                      &fields[i], 0, wrong[k]);
    }
    const virga_view zero = {.size = t.view.size, .cookie = t.view.cookie, .viewport = {0, 0, 16, 16}};
    gpu_forget_log(t.f);
    assert_int_equal(frame_with_view(&t, &zero), VIRGA_ERROR_INVALID); /* all matrices zero */
    assert_int_equal(field_lines(t.f), 1);
    close_test(&t);
}
#undef F

#define F(member, rule, low, high) FIELD(virga_scene_pane, member, rule, low, high)
static void scene_pane_fields(void **state)
{
    static const field fields[] = {
        F(pose.position_m, REFUSED, -FAR, FAR),
        F(velocity_m_s, CLAMPED, -1000, 1000),
        F(acceleration_m_s2, CLAMPED, -1000, 1000),
        F(angular_velocity_rad_s, CLAMPED, -100, 100),
        F(shelter, REFUSED, 0, 1),
    };
    fields_test t;
    open_test(&t, state);
    try_fields(&t, "scene_pane", t.panes, sizeof t.panes, fields, SIZE(fields), frame_with_panes, NULL);
    virga_scene_pane bent[SMALL_PANES];
    memcpy(bent, t.panes, sizeof bent);
    bent[1].pose.world_from_pane[0] = 3;
    gpu_forget_log(t.f);
    assert_int_equal(frame_with_panes(&t, bent), VIRGA_ERROR_INVALID);
    assert_int_equal(field_lines(t.f), 1);
    close_test(&t);
}
#undef F

#define F(member, rule, low, high) FIELD(virga_occluder, member, rule, low, high)
static void mesh_fields(void **state)
{
    static const field fields[] = {
        F(vertex_stride, REFUSED, 12, 12), F(index_type, REFUSED, 0, 1),           F(material, REFUSED, 0, 255),
        F(cover, REFUSED, 0, 1),           F(world_from_mesh, REFUSED, -FAR, FAR),
    };
    fields_test t;
    open_test(&t, state);
    try_fields(&t, "occluder", &t.mesh, sizeof t.mesh, fields, 4, frame_with_mesh, NULL);
    try_fields(&t, "occluder", &t.mesh, sizeof t.mesh, fields + 4, 1, frame_with_mesh, NULL);
    virga_occluder empty = t.mesh;
    empty.index_count = 0;
    assert_int_equal(frame_with_mesh(&t, &empty), VIRGA_OK);
    close_test(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(rain_settings_fields),   gpu_kept_test(ground_settings_fields),
        gpu_kept_test(splash_settings_fields), gpu_kept_test(glass_settings_fields),
        gpu_kept_test(scene_frame_fields),     gpu_kept_test(view_fields),
        gpu_kept_test(scene_pane_fields),      gpu_kept_test(mesh_fields),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
