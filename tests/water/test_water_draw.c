/* Which pixels water covers, and where it is in them: without holes, at its silhouette and behind the scene. */
#include "water_sheet.h"

#define BALL_M    0.2
#define SPACING_M (BALL_M / 12)

static shot s;
static double ball_radius; /* of its surface */

static const double origin[3] = {0, 0, 0};

static double empty_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of, (void)eye, (void)direction;
    rgb[0] = rgb[1] = rgb[2] = 0.5;
    return INFINITY;
}

static void open_ball(uint32_t side)
{
    shot_open(&s, side, side);
    s.scene = empty_scene;
    s.f.settings.spacing_m = (float)SPACING_M;
    water_fixture_shells(&s.f, origin, BALL_M, SPACING_M);
    ball_radius = water_reference_radius(&s.f, origin, 1.2 * BALL_M);
}

static void from_direction(int index, double distance, double at[3])
{
    const double angle = index * M_PI / 4 + 0.2, up = 0.35 * sin(2.3 * index);
    at[0] = distance * sin(angle) * cos(up);
    at[1] = distance * sin(up);
    at[2] = distance * cos(angle) * cos(up);
}

/* Radius in pixels of the silhouette of a ball of radius r, in the middle of the picture. */
static double silhouette_px(double r, double distance)
{
    return r / sqrt(distance * distance - r * r) / tan(FOV_DEG * M_PI / 360) * 0.5 * s.height;
}

static void check_ball(int direction, double distance)
{
    double at[3];
    from_direction(direction, distance, at);
    shot_aim(&s, at, origin);
    shot_draw(&s);
    const double radius = silhouette_px(ball_radius, distance), area = M_PI * radius * radius;
    const double covered = shot_covered(&s), middle = 0.5 * s.width;
    printf("from %d at %g m: covers %.4f of its disc of %.0f px\n", direction, distance, covered / area, area);
    if (fabs(covered / area - 1) > 0.01)
        fail_msg("from %d at %g m: %g pixels are covered, expected %g", direction, distance, covered, area);
    for (uint32_t y = 0; y < s.height; y++)
        for (uint32_t x = 0; x < s.width; x++)
            if (hypot(x + 0.5 - middle, y + 0.5 - middle) < 0.95 * radius && !(shot_pixel(&s, x, y)[3] > 0.98f))
                fail_msg("from %d at %g m: a hole of %g at %u, %u", direction, distance,
                         (double)shot_pixel(&s, x, y)[3], x, y);
}

/* Part of a pixel that a disc around the middle of the picture covers, by 32 x 32 samples. */
static double disc_coverage(double x, double y, double radius)
{
    enum { SAMPLES = 32 };
    int inside = 0;
    for (int i = 0; i < SAMPLES * SAMPLES; i++)
        inside += hypot(x + (i % SAMPLES + 0.5) / SAMPLES - 0.5 * s.width,
                        y + (i / SAMPLES + 0.5) / SAMPLES - 0.5 * s.height) < radius;
    return (double)inside / (SAMPLES * SAMPLES);
}

static void pack_normal(const double n[3], virga_surfel_gpu *surfel)
{
    const double length = fabs(n[0]) + fabs(n[1]) + fabs(n[2]);
    double e[2] = {n[0] / length, n[1] / length};
    if (n[2] < 0) {
        const double x = e[0];
        e[0] = (1 - fabs(e[1])) * (x >= 0 ? 1 : -1);
        e[1] = (1 - fabs(x)) * (e[1] >= 0 ? 1 : -1);
    }
    surfel->normal = ((uint32_t)lround(e[1] * 32767) & 0xffff) << 16 | ((uint32_t)lround(e[0] * 32767) & 0xffff);
}

/* For shot.after_step: surfels where the edges of a grid cross a sphere, in place of those of the step, whose surface
 * is as rough as its particles lie. */
static void record_sphere(shot *of, VkCommandBuffer cmd)
{
    const double step = 2 * SPACING_M / VIRGA_WATER_SIDE;
    const int most = (int)(BALL_M / step);
    virga_surfel_gpu *surfels = of->extra.mapped;
    uint32_t count = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int u = -most; u <= most; u++)
            for (int v = -most; v <= most; v++) {
                const double rest = BALL_M * BALL_M - step * step * (u * u + v * v);
                for (int side = -1; rest > 0 && side <= 1; side += 2) {
                    const double at[3] = {step * u, step * v, side * sqrt(rest)};
                    const double p[3] = {at[(3 - axis) % 3], at[(4 - axis) % 3], at[(5 - axis) % 3]};
                    virga_surfel_gpu *surfel = &surfels[count++];
                    *surfel = (virga_surfel_gpu){.position = {(float)p[0], (float)p[1], (float)p[2]},
                                                 .radius = water_whole_radius(step * VIRGA_WATER_SURFEL_STEPS)};
                    pack_normal(p, surfel);
                }
            }
    surfels_replace(of, cmd, count);
}

/* One sample in each pixel: the coverage of the silhouette's pixels, within 1.5 px, against that of the disc. Pixels
 * that are covered or not, without anything between, would be off by 0.07 to 0.1 on average. */
static void a_silhouette_is_as_smooth_as_a_disc(void **state)
{
    (void)state;
    static const double distances[] = {0.6, 1.1, 2, 4, 8};
    open_ball(192);
    s.after_step = record_sphere;
    for (int i = 0; i < 5; i++) {
        double at[3], sum = 0, worst = 0, steps = 0;
        uint32_t border = 0;
        from_direction(i, distances[i], at);
        shot_aim(&s, at, origin);
        shot_draw(&s);
        const double radius = silhouette_px(BALL_M, distances[i]);
        for (uint32_t y = 0; y < s.height; y++)
            for (uint32_t x = 0; x < s.width; x++) {
                if (fabs(hypot(x + 0.5 - 0.5 * s.width, y + 0.5 - 0.5 * s.height) - radius) > 1.5)
                    continue;
                const double exact = disc_coverage(x, y, radius), error = fabs((double)shot_pixel(&s, x, y)[3] - exact);
                border++;
                sum += error;
                worst = fmax(worst, error);
                steps += fabs((hypot(x + 0.5 - 0.5 * s.width, y + 0.5 - 0.5 * s.height) < radius) - exact);
            }
        printf("a disc of %.1f px: %u pixels at its border are off by %.3f on average, %.3f at most; steps by %.3f\n",
               radius, border, sum / border, worst, steps / border);
        shot_save(&s, (const char *[5]){"rim0", "rim1", "rim2", "rim3", "rim4"}[i]);
        REQUIRE(sum / border < 0.062 && worst < 0.52);
    }
    shot_close(&s);
}

static void a_ball_covers_its_disc_without_holes_from_all_sides(void **state)
{
    (void)state;
    open_ball(192);
    for (int i = 0; i < 8; i++)
        check_ball(i, 0.8);
    shot_close(&s);
}

static void a_ball_covers_its_disc_without_holes_from_near_to_far(void **state)
{
    (void)state;
    static const double distances[] = {0.6, 1.1, 2, 4, 8};
    open_ball(192);
    for (int i = 0; i < 5; i++)
        check_ball(i, distances[i]);
    shot_close(&s);
}

/* Larger than the effect's images: drawn at half the resolution. */
static void a_view_that_is_larger_than_the_images_shows_the_same_ball(void **state)
{
    (void)state;
    virga_water_def def = water_fixture_def();
    def.max_width = def.max_height = 96;
    shot_open_with(&s, &def, 192, 192, false);
    s.scene = empty_scene;
    s.f.settings.spacing_m = (float)SPACING_M;
    water_fixture_shells(&s.f, origin, BALL_M, SPACING_M);
    ball_radius = water_reference_radius(&s.f, origin, 1.2 * BALL_M);
    check_ball(0, 0.8);
    shot_close(&s);
}

static void the_same_water_has_the_same_bits(void **state)
{
    (void)state;
    open_ball(96);
    const double at[3] = {0.3, 0.2, 0.6};
    shot_aim(&s, at, origin);
    shot_draw(&s);
    const size_t size = (size_t)s.width * s.height * 16;
    float *first = malloc(size);
    REQUIRE(first);
    memcpy(first, s.pixels, size);
    for (int i = 0; i < 3; i++)
        assert_memory_equal(first, shot_draw(&s), size);
    free(first);
    shot_close(&s);
}

/* The scene is at one distance. */
static double wall_distance;
static double wall_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)eye;
    const float *m = of->camera.view_from_world;
    rgb[0] = rgb[1] = rgb[2] = 0.5;
    return wall_distance / -((double)m[2] * direction[0] + (double)m[6] * direction[1] + (double)m[10] * direction[2]);
}

static void water_behind_the_scene_is_hidden(void **state)
{
    (void)state;
    const double at[3] = {0, 0, 0.8};
    open_ball(96);
    s.scene = wall_scene;
    for (int reversed = 0; reversed < 2; reversed++) {
        s.reversed = reversed;
        wall_distance = 0.8 - BALL_M - 0.02;
        shot_aim(&s, at, origin);
        shot_draw(&s);
        assert_true(shot_covered(&s) == 0);
        wall_distance = 0.8;
        shot_aim(&s, at, origin);
        shot_draw(&s);
        const double radius = silhouette_px(ball_radius, 0.8);
        assert_float_equal(shot_covered(&s) / (M_PI * radius * radius), 1, 0.03);
    }
    shot_close(&s);
}

static void no_water_draws_nothing(void **state)
{
    (void)state;
    const double at[3] = {0, 0, 0.8};
    shot_open(&s, 64, 64);
    shot_aim(&s, at, origin);
    shot_draw(&s);
    assert_true(shot_covered(&s) == 0);
    shot_close(&s);
}

static void without_a_size_it_is_not_drawn_and_allocates_nothing_for_it(void **state)
{
    (void)state;
    virga_water_def def = water_fixture_def(), whole = def;
    whole.max_width = def.max_width = 1920;
    whole.max_height = 1080;
    REQUIRE(virga_water_estimate(&def) + 1920 * 1080 * 24 < virga_water_estimate(&whole));
    water_fixture_open_with(&s.f, &def, false);
    const VkCommandBuffer cmd = effect_fixture_begin(&s.f.gpu, s.f.context);
    const virga_water_step_info info = {.count = 0};
    const virga_view view = virga_default_view();
    REQUIRE(virga_water_step(s.f.water, cmd, &info) == VIRGA_OK);
    virga_view seen = view;
    seen.viewport[2] = seen.viewport[3] = 64;
    seen.clip_from_view[11] = seen.open_clip_from_view[11] = -1;
    seen.clip_from_view[15] = seen.open_clip_from_view[15] = 0;
    assert_int_equal(virga_water_prepare(s.f.water, cmd, &seen), VIRGA_NOT_READY);
    effect_fixture_complete(&s.f.gpu, s.f.context);
    water_fixture_close(&s.f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_covers_its_disc_without_holes_from_all_sides),
        cmocka_unit_test(a_ball_covers_its_disc_without_holes_from_near_to_far),
        cmocka_unit_test(a_silhouette_is_as_smooth_as_a_disc),
        cmocka_unit_test(a_view_that_is_larger_than_the_images_shows_the_same_ball),
        cmocka_unit_test(the_same_water_has_the_same_bits),
        cmocka_unit_test(water_behind_the_scene_is_hidden),
        cmocka_unit_test(no_water_draws_nothing),
        cmocka_unit_test(without_a_size_it_is_not_drawn_and_allocates_nothing_for_it),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
