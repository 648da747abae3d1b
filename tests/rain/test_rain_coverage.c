/* test_rain_coverage.c - what streaks and haze cover of the picture, and what the scene's depth leaves of them. */
#include "rain_expected_streak.h"

/* ---- coverage */

enum { THIN_STREAKS = 6, GAIN = 4 /* so that single drops are dense enough farther away */ };

/* One drop each, well inside the picture, thinner than a pixel and still dense enough not to fade at half the size. */
static uint32_t choose_thin(const shot *s, uint32_t *ids)
{
    const uint32_t wide = ((const virga_prepared_gpu *)s->prepared.mapped)->wide_quads.index_count / 6;
    uint32_t found = 0;
    for (uint32_t i = wide; i < streak_count(s) && found < THIN_STREAKS; i++) {
        const virga_streak_gpu *streak = &streak_list(s)[i];
        expected e;
        if (!streak->width_alpha || !expect_streak(s, slot_of(streak), &e))
            continue;
        const bool shown =
            fmax(fabs(e.head[0]), fabs(e.tail[0])) < 0.95 && fmax(fabs(e.head[1]), fabs(e.tail[1])) < 0.95;
        const double at_half = GAIN * e.weight * e.body_px / fmax(e.way_px, e.body_px) * 0.5 * e.width_px;
        if (shown && e.width_px < 0.98 && at_half > 2.02 / 800 && e.weight < 1.001 && e.way_px > 20 * e.body_px)
            ids[found++] = streak->id;
    }
    return found;
}

static int slot_of_id(const shot *s, uint32_t id)
{
    for (uint32_t i = 0; i < streak_count(s); i++)
        if (streak_list(s)[i].id == id)
            return (int)i;
    fail_msg("a streak is gone");
    return 0;
}

/* Many drops of about 2 mm, so that there are single ones where they are a pixel wide. */
static void rain_of_big_drops(shot *s)
{
    static const double diameters[2] = {0.0018, 0.0026}, numbers[2] = {1, 1};
    s->f.settings.sizes = (virga_sizes){VIRGA_SIZES_TABLE, diameters, numbers, 2};
    s->f.settings.oscillation = 0;
}

/* Over the shutter time a drop passes; at each moment it covers its own disc. So all that its streak covers is the
 * disc's area in pixels, whatever the length of the streak. */
static void a_thin_streak_covers_its_disc_at_any_resolution(void **state)
{
    (void)state;
    shot s;
    uint32_t ids[THIN_STREAKS], count = 0;
    double shares[2][THIN_STREAKS];
    open_shot(&s, 1);
    rain_of_big_drops(&s);
    s.f.settings.streak_gain = GAIN;
    apply_settings(&s);
    for (int run = 0; run < 2; run++) {
        add_picture(&s, run ? 160 : 320, run ? 120 : 240);
        aim_level(&s);
        s.only = EVERY_STREAK;
        draw_frame(&s, run ? 0 : 0.2);
        count = run ? count : choose_thin(&s, ids);
        for (uint32_t i = 0; i < count; i++) {
            expected e;
            s.only = slot_of_id(&s, ids[i]);
            const double sum = sum_of(&s, draw_frame(&s, 0), 3);
            assert_true(expect_streak(&s, ids[i] & ((1u << VIRGA_RAIN_ID_SLOT_BITS) - 1), &e));
            const double disc = GAIN * 0.785398 * e.width_px * e.body_px * e.weight;
            assert_true(fabs(sum / disc - 1) < 0.02);

            shares[run][i] = sum / (s.picture.width * s.picture.height);
        }
        remove_picture(&s);
    }
    printf("%u streaks\n", count);
    assert_true(count >= 3);
    for (uint32_t i = 0; i < count; i++)
        assert_true(fabs(shares[1][i] / shares[0][i] - 1) < 0.02);
    close_shot(&s);
}

static double max_of(const shot *s, const float *pixels)
{
    double max = 0;
    for (size_t i = 0; i < (size_t)s->picture.width * s->picture.height; i++)
        max = fmax(max, (double)pixels[i * 4 + 3]);
    return max;
}

/* Where it lies in the list goes by how all of them are seen. */
static const float *draw_only(shot *s, uint32_t id)
{
    s->only = EVERY_STREAK;
    draw_frame(s, 0);
    s->only = slot_of_id(s, id);
    return draw_frame(s, 0);
}

static void open_big_drops(shot *s)
{
    open_shot(s, 40);
    rain_of_big_drops(s);
    add_picture(s, 320, 240);
}

/* A lens spreads a streak over what it blurs a point to, and none of its coverage is lost; what is as far away as the
 * lens is focused stays as it was. */
static void a_streak_out_of_focus_covers_as_much_over_more(void **state)
{
    (void)state;
    shot s;
    double distance = 0;
    open_big_drops(&s);
    s.f.settings.streak_gain = 100;
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    const uint32_t id = streak_list(&s)[choose_streak(&s, &distance)].id;
    const float *pixels = draw_only(&s, id);
    const double sharp = sum_of(&s, pixels, 3), max = max_of(&s, pixels);
    const double pixel = 2 / (fabs((double)s.camera.clip_from_view[5]) * 240);
    s.aperture_m = (float)(8 * pixel * distance); /* 8 pixels, in focus at infinity */
    pixels = draw_only(&s, id);
    printf("%.1f m away: %.3f in all, at most %.3f; blurred %.3f and %.3f\n", distance, sharp, max,
           sum_of(&s, pixels, 3), max_of(&s, pixels));
    assert_true(fabs(sum_of(&s, pixels, 3) / sharp - 1) < 0.03 && max_of(&s, pixels) < 0.4 * max);
    s.focus_m = (float)distance;
    pixels = draw_only(&s, id);
    assert_true(fabs(sum_of(&s, pixels, 3) / sharp - 1) < 0.01 && fabs(max_of(&s, pixels) / max - 1) < 0.02);
    close_shot(&s);
}

/* Half of the light of the drop's middle and half of that of its rim, as r^2 has the mean 1/2 over a disc. */
static void a_streak_has_the_same_mean_light_however_blurred(void **state)
{
    (void)state;
    shot s;
    double distance = 0;
    open_big_drops(&s);
    memset(s.f.settings.lighting.environment_sh, 0, sizeof s.f.settings.lighting.environment_sh);
    s.f.settings.lighting.environment_sh[0][1] = 1 / 0.282095f;
    s.f.settings.lighting.environment_sh[2][1] = 1; /* what is behind the camera is lighter */
    s.f.settings.streak_gain = 100;
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    const uint32_t id = streak_list(&s)[choose_streak(&s, &distance)].id;
    const double pixel = 2 / (fabs((double)s.camera.clip_from_view[5]) * 240);
    for (int blur = 1; blur <= 8; blur *= 2) {
        s.wide = blur > 1; /* by the shader of thin streaks, and by that of wide ones */
        s.aperture_m = (float)(blur * pixel * distance);
        const float *pixels = draw_only(&s, id);
        const virga_streak_gpu *streak = &streak_list(&s)[s.only];
        const double mean = sum_of(&s, pixels, 1) / sum_of(&s, pixels, 3);
        const double center = high_half(streak->light[0]), rim = low_half(streak->light[2]);
        printf("blurred over %d pixels: %.3f; %.3f in the middle, %.3f at the rim\n", blur, mean, center, rim);
        assert_true(rim > 1.2 * center && fabs(mean / (0.5 * (center + rim)) - 1) < 0.01);
    }
    close_shot(&s);
}

/* The mean over time and over a pixel of an ellipse that moves along the streak's path, times the streak's coverage. */
static double moving_ellipse(const shot *s, const virga_streak_gpu *streak, uint32_t pixel)
{
    enum { TIMES = 64, SIDE = 4 };
    const double half[2] = {0.5 * s->picture.width, 0.5 * s->picture.height};
    double tail[2], along[2];
    for (int i = 0; i < 2; i++) {
        tail[i] = half[i] * (1 + (double)streak->tail[i]);
        along[i] = half[i] * ((double)streak->head[i] - (double)streak->tail[i]);
    }
    const double path = hypot(along[0], along[1]);
    const double width = low_half(streak->width_alpha), body = low_half(streak->body_wave);
    uint32_t inside = 0;
    for (int i = 0; i < TIMES * SIDE * SIDE; i++) {
        const double x = pixel % s->picture.width + (i % SIDE + 0.5) / SIDE - tail[0];
        const double y = pixel / s->picture.width + (i / SIDE % SIDE + 0.5) / SIDE - tail[1];
        const double u = (y * along[0] - x * along[1]) / path;
        const double v = (x * along[0] + y * along[1]) / path - path * (i / SIDE / SIDE + 0.5) / TIMES;
        inside += 4 * (u * u / (width * width) + v * v / (body * body)) < 1;
    }
    return high_half(streak->width_alpha) / fmin(1, body / path) * inside / (TIMES * SIDE * SIDE);
}

/* A drop that the lens blurs by more than its path is a disc, not a rectangle. */
static void a_streak_out_of_focus_has_round_ends(void **state)
{
    (void)state;
    shot s;
    double distance = 0, wrong = 0, sum = 0;
    open_shot(&s, 40);
    rain_of_big_drops(&s);
    add_picture(&s, 960, 720);
    s.f.settings.streak_gain = 100;
    apply_settings(&s);
    s.shutter_s = 1.0 / 2000; /* the path is shorter than the disc */
    aim_level(&s);
    draw_frame(&s, 0.2);
    const uint32_t id = streak_list(&s)[choose_streak(&s, &distance)].id;
    s.wide = true;
    s.aperture_m = (float)(10 * distance / (fabs((double)s.camera.clip_from_view[5]) * 360)); /* 10 pixels */
    const float *pixels = draw_only(&s, id);
    const virga_streak_gpu *streak = streak_list(&s);
    while (streak->id != id)
        streak++;
    for (uint32_t i = 0; i < s.picture.width * s.picture.height; i++) {
        const double expected = moving_ellipse(&s, streak, i);
        wrong += fabs((double)pixels[i * 4 + 3] - expected);
        sum += expected;
    }
    printf("%.1f px wide, %.3f in all, wrong by %.3f\n", low_half(streak->width_alpha), sum, wrong);
    assert_true(sum > 0.1 && wrong < 0.06 * sum);
    close_shot(&s);
}

static void an_even_environment_gives_its_radiance_times_the_coverage(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    memset(s.f.settings.lighting.environment_sh, 0, sizeof s.f.settings.lighting.environment_sh);
    for (int c = 0; c < 3; c++)
        s.f.settings.lighting.environment_sh[0][c] = (float)(c + 1) / 0.282095f;
    s.f.settings.oscillation = 0;
    apply_settings(&s);
    aim_level(&s);
    const float *pixels = draw_frame(&s, 0.2);
    uint32_t covered = 0;
    for (size_t i = 0; i < (size_t)s.picture.width * s.picture.height; i++) {
        covered += pixels[i * 4 + 3] > 0;
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(pixels[i * 4 + (size_t)c] - (float)(c + 1) * pixels[i * 4 + 3]) <
                        2e-3f * (float)(c + 1) * pixels[i * 4 + 3] + 1e-6f);
    }
    assert_true(covered > 5000);
    close_shot(&s);
}

/* ---- haze */

/* Half of the extinction is light that hits drops; the other half is diffracted, and not lost. */
static double haze_of(double rate_mm_h)
{
    return 0.5 * virga_rain_extinction(rate_mm_h);
}

/* All drops are below 2 mm, and none of these is drawn one by one. */
static void rain_of_haze(shot *s)
{
    static const double diameters[2] = {0.0005, 0.0015}, numbers[2] = {1, 1};
    s->f.settings.sizes = (virga_sizes){VIRGA_SIZES_TABLE, diameters, numbers, 2};
    s->f.settings.streak_min_mm = 2;
    s->f.settings.haze = 4;
    s->give_depth = true;
    for (int c = 0; c < 3; c++)
        s->f.settings.lighting.environment_sh[3][c] = 0.3f; /* another one on the right than on the left */
}

static void check_haze(shot *s, double distance_m)
{
    s->scene_depth = stored_depth(s, distance_m);
    const float *pixels = draw_frame(s, 0.02);
    const double per_m = haze_of((double)s->f.settings.rate_mm_h) * (double)s->f.settings.haze;
    const float *p = s->camera.clip_from_view;
    assert_int_equal(streak_count(s), 0);
    for (size_t i = 0; i < (size_t)s->picture.width * s->picture.height; i += 7) {
        const double x = (((double)(i % s->picture.width) + 0.5) / s->picture.width * 2 - 1) / (double)p[0],
                     y = (((double)(i / s->picture.width) + 0.5) / s->picture.height * 2 - 1) / (double)p[5];
        const double length = sqrt(1 + x * x + y * y), alpha = 1 - exp(-per_m * distance_m * length);
        double radiance[3];
        environment_at(s, (const double[3]){x / length, y / length, -1 / length}, (const double[3]){1, 0.77, 0.54},
                       radiance);
        assert_true(fabs((double)pixels[i * 4 + 3] - alpha) < 2e-3 * alpha);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)pixels[i * 4 + (size_t)c] - radiance[c] * alpha) < 4e-3 * radiance[c] * alpha);
    }
}

static void haze_thickens_by_beers_law(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 100);
    add_picture(&s, 160, 120);
    rain_of_haze(&s);
    apply_settings(&s);
    aim_level(&s);
    check_haze(&s, 1.5); /* within the boxes */
    check_haze(&s, 6);
    check_haze(&s, 30); /* beyond them */
    close_shot(&s);
}

/* The haze of a class: all of it if it has no streaks, else what they lack of the drops that they stand for. Each
 * streak covers its whole path here, as one drop does. */
static double haze_beside_single_drops(const shot *s, double distance_m)
{
    const rain_classes *classes = s->f.rain->classes;
    const double per_m = haze_of((double)s->f.settings.rate_mm_h);
    double thickness = 0;
    for (uint32_t level = 0; level < classes->levels; level++) {
        double hazy = 0, all = 0;
        for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
            const double diameter = classes->classes[k].diameter_m, cover = classes->per_m3[k] * diameter * diameter;
            const bool drawn = diameter >= (double)s->f.settings.streak_min_mm * 1e-3 && classes->slot_count[level][k];
            const double drops = (double)classes->weights[level * VIRGA_RAIN_CLASSES + k].drops;
            all += cover;
            hazy += cover * (drawn ? 1 - 1 / drops : 1);
        }
        const double half = 0.5 * ldexp(classes->side_m, (int)level + 1 - (int)classes->levels);
        thickness += hazy / all * fmax(fmin(half, distance_m) - (level ? 0.5 * half : 0), 0);
    }
    return 1 - exp(-per_m * thickness);
}

/* What the streaks of slots that stand for many drops do not cover is not lost. */
static void what_streaks_of_many_drops_do_not_cover_is_haze(void **state)
{
    (void)state;
    const double distance = 4; /* here no drop is too faint to be drawn */
    shot s;
    open_shot(&s, 100);
    add_picture(&s, 160, 120);
    s.give_depth = true;
    s.f.settings.streak_group_mm = s.f.settings.streak_min_mm = 0.2f; /* no larger than the smallest drops */
    s.f.settings.streak_gain = 100;
    apply_settings(&s);
    s.shutter_s = 1.0 / 2000; /* at this gain drops cover all of so short a path */
    aim_level(&s);
    s.scene_depth = stored_depth(&s, distance);
    draw_frame(&s, 0.2);
    const VkCommandBuffer cmd = rain_fixture_begin_frame(&s.f);
    rain_fixture_record_step(&s.f, cmd, 0);
    record_scene_depth(&s, cmd);
    const virga_view view = view_of(&s);
    REQUIRE(virga_rain_prepare(s.f.rain, cmd, &view, virga_rain_time(s.f.rain)) == VIRGA_OK);
    host_target_begin_layer(&s.picture, cmd);
    REQUIRE(virga_rain_draw_parts(s.f.rain, cmd, s.layer, VIRGA_RAIN_HAZE) == VIRGA_OK);
    host_target_end_layer(&s.picture, cmd);
    host_target_copy_out(&s.picture, cmd, 1u << HOST_LAYER);
    rain_fixture_end_frame(&s.f);
    const float *pixels = host_target_floats(&s.f.gpu.device, &s.picture, HOST_LAYER);
    const double got = (double)pixels[4 * (60 * 160 + 80) + 3], expected = haze_beside_single_drops(&s, distance);
    const double all = 1 - exp(-haze_of(100) * distance);
    printf("haze covers %.5f, expected %.5f; without streaks %.5f\n", got, expected, all);
    assert_true(expected < 0.99 * all);
    assert_true(fabs(got / expected - 1) < 2e-3);
    close_shot(&s);
}

static void there_is_haze_before_the_sky_by_default_and_none_without_depth(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 100);
    add_picture(&s, 160, 120);
    rain_of_haze(&s);
    const double metres[] = {(double)s.f.settings.haze_sky_m, 100, 0}; /* 0: a panorama of such rain */
    assert_true(metres[0] == 400);
    aim_level(&s);
    for (int i = 0; i < 3; i++) {
        s.f.settings.haze_sky_m = (float)metres[i];
        apply_settings(&s);
        const double before_it = sum_of(&s, draw_frame(&s, 0.02), 3) / (s.picture.width * s.picture.height);
        assert_true(fabs(before_it - (1 - exp(-4 * metres[i] * haze_of(100)))) < 1e-3);
        assert_true(metres[i] > 0 || before_it == 0);
    }
    s.scene_depth = stored_depth(&s, 20);
    assert_true(sum_of(&s, draw_frame(&s, 0.02), 3) > 0);
    s.give_depth = false;
    assert_true(sum_of(&s, draw_frame(&s, 0.02), 3) == 0);
    close_shot(&s);
}

/* As a mirror of water at height 0 shows it. */
static virga_view view_of_mirror(const shot *s)
{
    virga_view view = view_of(s);
    view.position_m[1] = view.open_position_m[1] = -view.position_m[1];
    for (int row = 0; row < 3; row++)
        view.view_from_world[4 + row] = view.open_view_from_world[4 + row] = -view.view_from_world[4 + row];
    return view;
}

static const double level_water[4] = {0, 1, 0, 0};

/* A frame of haze alone; with `prepared` also all of the rain after it, which is then all that is left. */
static const float *draw_haze_alone(shot *s, bool prepared)
{
    const VkCommandBuffer cmd = rain_fixture_begin_frame(&s->f);
    rain_fixture_record_step(&s->f, cmd, 0);
    record_scene_depth(s, cmd);
    const virga_view view = view_of(s), mirror = view_of_mirror(s);
    if (prepared)
        REQUIRE(virga_rain_prepare(s->f.rain, cmd, &view, virga_rain_time(s->f.rain)) == VIRGA_OK);
    host_target_begin_layer(&s->picture, cmd);
    REQUIRE(virga_rain_draw_haze(s->f.rain, cmd, &mirror, level_water, s->layer) == VIRGA_OK);
    host_target_end_layer(&s->picture, cmd);
    if (prepared)
        record_layer(s, cmd);
    host_target_copy_out(&s->picture, cmd, 1u << HOST_LAYER);
    rain_fixture_end_frame(&s->f);
    return host_target_floats(&s->f.gpu.device, &s->picture, HOST_LAYER);
}

/* All of the rain is haze there, also what has streaks elsewhere; and its light is that of where the ray goes to, up
 * from the water. Rays that do not come from the water have none. */
static void haze_alone_begins_at_its_plane(void **state)
{
    (void)state;
    const double distance = 30;
    shot s;
    open_shot(&s, 100);
    add_picture(&s, 160, 120);
    s.give_depth = true;
    for (int c = 0; c < 3; c++)
        s.f.settings.lighting.environment_sh[1][c] = 0.3f; /* another one above than below */
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    assert_true(streak_count(&s) > 100);
    s.scene_depth = stored_depth(&s, distance);
    const float *pixels = draw_haze_alone(&s, false), *p = s.camera.clip_from_view;
    const double per_m = haze_of(100);
    uint32_t hazed = 0;
    for (size_t i = 0; i < (size_t)s.picture.width * s.picture.height; i += 7) {
        const double x = (((double)(i % s.picture.width) + 0.5) / s.picture.width * 2 - 1) / (double)p[0],
                     up = -(((double)(i / s.picture.width) + 0.5) / s.picture.height * 2 - 1) / (double)p[5];
        const double length = sqrt(1 + x * x + up * up);
        const double way = up > 0 ? fmax(distance - s.f.camera[1] / up, 0) * length : 0;
        const double alpha = 1 - exp(-per_m * way);
        double radiance[3];
        environment_at(&s, (const double[3]){x / length, up / length, -1 / length}, (const double[3]){1, 0.77, 0.54},
                       radiance);
        assert_true(fabs((double)pixels[i * 4 + 3] - alpha) < 2e-3 * alpha + 1e-6);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)pixels[i * 4 + (size_t)c] - radiance[c] * alpha) <
                        4e-3 * radiance[c] * alpha + 1e-6);
        hazed += alpha > 0.01;
    }
    assert_true(hazed > 500);
    close_shot(&s);
}

/* What was prepared is drawn as if nothing had been between. */
static void haze_alone_leaves_what_was_prepared(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 100);
    add_picture(&s, 160, 120);
    s.give_depth = true;
    s.f.settings.haze_sky_m = 100;
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    float *before = draw_copy(&s, 0);
    const float *after = draw_haze_alone(&s, true);
    assert_memory_equal(before, after, (size_t)s.picture.width * s.picture.height * 4 * sizeof(float));
    free(before);
    close_shot(&s);
}

static void haze_alone_needs_depth_and_a_begun_frame(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 100);
    add_picture(&s, 160, 120);
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.02);
    const double nowhere[4] = {0, NAN, 0, 0};
    const VkCommandBuffer cmd = rain_fixture_begin_frame(&s.f);
    virga_view view = view_of(&s);
    assert_int_equal(virga_rain_draw_haze(s.f.rain, cmd, &view, NULL, s.layer), VIRGA_ERROR_INVALID);
    s.give_depth = true;
    view = view_of(&s);
    assert_int_equal(virga_rain_draw_haze(s.f.rain, cmd, &view, nowhere, s.layer), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_rain_draw_haze(s.f.rain, cmd, &view, NULL, s.layer), VIRGA_NOT_READY);
    rain_fixture_end_frame(&s.f);
    close_shot(&s);
}

/* ---- the scene's depth */

static void streaks_end_at_the_scene_over_soft_m(void **state)
{
    (void)state;
    static const double in_front[] = {-0.5, -0.01, 0.05, 0.1, 0.15, 0.2, 1};
    shot s;
    double distance = 0;
    open_shot(&s, 80);
    add_picture(&s, 160, 120);
    s.f.settings.soft_m = 0.2f;
    s.f.settings.haze = 0;
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    s.only = choose_streak(&s, &distance);
    s.give_depth = true;
    float *whole = draw_copy(&s, 0);
    assert_true(sum_of(&s, whole, 3) > 0.01);
    for (size_t i = 0; i < sizeof in_front / sizeof in_front[0]; i++) {
        s.scene_depth = stored_depth(&s, distance + in_front[i]);
        const float *pixels = draw_frame(&s, 0);
        const double share = clamp01(in_front[i] / 0.2);
        assert_true(fabs(sum_of(&s, pixels, 3) / sum_of(&s, whole, 3) - share) < 2e-3);
        for (size_t j = 0; j < (size_t)s.picture.width * s.picture.height * 4; j++)
            assert_true(fabs((double)pixels[j] - share * (double)whole[j]) < 3e-3 * (double)whole[j] + 1e-7);
    }
    free(whole);
    close_shot(&s);
}

/* The top of a wall at 0.7 of a drop's distance is 6 px below the drop, whose disc has a radius of 5 px and is drawn
 * 7 px long. `ratio`: the wall's circle of confusion over the drop's. Fills the picture without and with the wall. */
static uint32_t draw_before_wall(shot *s, double ratio, float **open, float **walled)
{
    double distance = 0;
    open_shot(s, 40);
    rain_of_big_drops(s);
    add_picture(s, 960, 720);
    s->f.settings.streak_gain = 100;
    s->f.settings.soft_m = 0;
    s->f.settings.haze = 0;
    apply_settings(s);
    s->shutter_s = 1.0 / 2000;
    aim_level(s);
    draw_frame(s, 0.2);
    const uint32_t id = streak_list(s)[choose_streak(s, &distance)].id;
    s->wide = s->give_depth = true;
    /* (1/f - 1/0.7z) = ratio (1/f - 1/z) */
    const double inverse_focus = (1 / 0.7 - ratio) / (1 - ratio) / distance;
    s->focus_m = (float)(1 / inverse_focus);
    s->aperture_m = (float)(10 / (inverse_focus - 1 / distance) / (fabs((double)s->camera.clip_from_view[5]) * 360));
    const size_t bytes = (size_t)s->picture.width * s->picture.height * 4 * sizeof(float);
    *open = memcpy(malloc(bytes), draw_only(s, id), bytes);
    const virga_streak_gpu *streak = streak_list(s);
    while (streak->id != id)
        streak++;
    const double middle = 360 * (1 + 0.5 * ((double)streak->head[1] + (double)streak->tail[1]));
    s->wall_top = (uint32_t)lround(middle + 6);
    s->wall_depth = stored_depth(s, 0.7 * distance);
    *walled = memcpy(malloc(bytes), draw_only(s, id), bytes);
    return s->wall_top;
}

/* Behind a wall in focus a disc ends at the wall. Behind one that is as far out of focus as the drop, it does not: the
 * drop itself is not hidden. */
static void a_disc_out_of_focus_ends_at_what_is_in_focus_only(void **state)
{
    (void)state;
    for (int blurred = 0; blurred < 2; blurred++) {
        shot s;
        float *open, *walled;
        double below = 0;
        const uint32_t top = draw_before_wall(&s, blurred ? 0.75 : 0, &open, &walled);
        for (uint32_t i = 0; i < s.picture.width * s.picture.height; i++) {
            const bool hidden = !blurred && i / s.picture.width >= top;
            below += i / s.picture.width >= top ? (double)open[4 * i + 3] : 0;
            assert_true(fabs((double)walled[4 * i + 3] - (hidden ? 0 : (double)open[4 * i + 3])) < 1e-6);
        }
        assert_true(below > 0.01 * sum_of(&s, open, 3));
        free(open);
        free(walled);
        close_shot(&s);
    }
}

/* With soft_m 0 it is a step. */
static void without_softness_the_scene_cuts(void **state)
{
    (void)state;
    shot s;
    double distance = 0;
    open_shot(&s, 80);
    add_picture(&s, 160, 120);
    s.f.settings.soft_m = 0;
    s.f.settings.haze = 0;
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    s.only = choose_streak(&s, &distance);
    s.give_depth = true;
    const double whole = sum_of(&s, draw_frame(&s, 0), 3);
    s.scene_depth = stored_depth(&s, distance + 0.001);
    assert_true(sum_of(&s, draw_frame(&s, 0), 3) == whole);
    s.scene_depth = stored_depth(&s, distance - 0.001);
    assert_true(sum_of(&s, draw_frame(&s, 0), 3) == 0);
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_thin_streak_covers_its_disc_at_any_resolution),
        cmocka_unit_test(a_streak_out_of_focus_covers_as_much_over_more),
        cmocka_unit_test(a_streak_has_the_same_mean_light_however_blurred),
        cmocka_unit_test(a_streak_out_of_focus_has_round_ends),
        cmocka_unit_test(an_even_environment_gives_its_radiance_times_the_coverage),
        cmocka_unit_test(haze_thickens_by_beers_law),
        cmocka_unit_test(what_streaks_of_many_drops_do_not_cover_is_haze),
        cmocka_unit_test(there_is_haze_before_the_sky_by_default_and_none_without_depth),
        cmocka_unit_test(haze_alone_begins_at_its_plane),
        cmocka_unit_test(haze_alone_leaves_what_was_prepared),
        cmocka_unit_test(haze_alone_needs_depth_and_a_begun_frame),
        cmocka_unit_test(streaks_end_at_the_scene_over_soft_m),
        cmocka_unit_test(without_softness_the_scene_cuts),
        cmocka_unit_test(a_disc_out_of_focus_ends_at_what_is_in_focus_only),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
