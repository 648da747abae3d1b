/* test_swept.c - bars that move while the shutter is open: what they cover of a wall behind them is, at each pixel, the
 * share of the time for which they hide it, however many sub-frames there are and whether they share shading. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "plate_fixture.h"
#include "swept.h"

enum { WIDTH = 240, HEIGHT = 180, PLACES = 5, MOST_SAMPLES = 16 };

#define WALL_Z    (-4.0)
#define BAR_WIDE  0.12 /* m */
#define BAR_INNER 0.3  /* from its axis */
#define BAR_OUTER 1.5
#define TURN_FROM 1.30 /* radians */
#define TURN_TO   1.55
#define PIXEL_M   (2 * 4.0 * 0.5773502691896257 / HEIGHT) /* 4 m away, through 60 degrees */

static const host_camera_key key = {.position_m = {0, 0, 4}, .look_at_m = {0, 0, 0}};
static const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 60, .near_m = 0.1, .far_m = 100};
static const double axis_m[2] = {-0.2, -0.6};

typedef struct scene {
    plate_scene plate;
    host_mesh wall, bar;
    float empty[WIDTH * HEIGHT * 4]; /* the picture without the bar */
    float color[WIDTH * HEIGHT * 4]; /* of another one */
    uint32_t order;                  /* of jitters: for so many that share */
} scene;

/* A bar in the plane z = 0 turns about an axis. */
static void place(double angle, host_swept_place places[PLACES])
{
    for (int i = 0; i < PLACES; i++) {
        const double r = BAR_INNER + (BAR_OUTER - BAR_INNER) * i / (PLACES - 1);
        places[i] = (host_swept_place){.middle = {axis_m[0] + r * cos(angle), axis_m[1] + r * sin(angle), 0},
                                       .across = {-sin(angle), cos(angle), 0},
                                       .normal = {0, 0, 1}};
    }
}

/* How a bar is seen in one of `samples` sub-frames. */
static void put_turning(uint32_t sample, uint32_t samples, uint32_t shares,
                        host_vertex vertices[HOST_SWEPT_VERTICES(PLACES)])
{
    const double step = (TURN_TO - TURN_FROM) / samples, open = TURN_FROM + sample * step;
    const host_swept_view view = {.eye_m = {0, 0, 4}, .margin_rad = shares > 1 ? 1.5 * PIXEL_M / 4 : 0};
    host_swept_place before[PLACES], from[PLACES], to[PLACES];
    place(open - (shares - 1) * step, before);
    place(open, from);
    place(open + step, to);
    const host_swept_bar bar = {
        .before = before, .open = from, .close = to, .count = PLACES, .half_width_m = 0.5 * BAR_WIDE};
    host_swept_put(&bar, &view, vertices);
}

static bool add_bar(scene *s)
{
    const host_material black = {
        .base_color = {0, 0, 0, 1}, .roughness = 1, .alpha = HOST_ALPHA_SWEPT, .two_sided = true};
    host_vertex vertices[HOST_SWEPT_VERTICES(PLACES)];
    uint32_t indices[HOST_SWEPT_INDICES(PLACES)];
    put_turning(0, 1, 1, vertices);
    s->bar.apart = true;
    const bool good = host_mesh_create(&s->plate.base.device, vertices, HOST_SWEPT_VERTICES(PLACES), indices,
                                       host_swept_indices(0, PLACES, indices), &black, &s->bar, s->plate.base.error,
                                       sizeof s->plate.base.error);
    s->bar.apart = true;
    return good && host_renderer_add(s->plate.renderer, &s->bar, s->plate.base.error, sizeof s->plate.base.error);
}

/* The wall ends in the middle of the picture: on the right the sky is behind the bar. */
static bool build(void *zeroed)
{
    scene *s = zeroed;
    const float z = (float)WALL_Z, corners[4][3] = {{-20, -20, z}, {0, -20, z}, {0, 20, z}, {-20, 20, z}};
    const host_material white = {.base_color = {1, 1, 1, 1}, .roughness = 1};
    host_environment_def sky = {.zenith = {1, 1, 1}, .horizon = {1, 1, 1}, .ground = {1, 1, 1}, .intensity = 1.0f};
    return plate_open(&s->plate, WIDTH, HEIGHT, &sky) &&
           host_renderer_set_reuse(s->plate.renderer, &s->plate.target, s->plate.base.error,
                                   sizeof s->plate.base.error) &&
           plate_add_quad(&s->plate, corners, (const float[3]){0, 0, 1}, &white, &s->wall) && add_bar(s);
}

static int set_up(void **state)
{
    return fixture_set_up(state, sizeof(scene), build);
}

static int tear_down(void **state)
{
    scene *s = *state;
    plate_close(&s->plate);
    host_mesh_destroy(&s->plate.base.device, &s->wall);
    host_mesh_destroy(&s->plate.base.device, &s->bar);
    return fixture_tear_down(&s->plate.base);
}

static void draw_one(scene *s, uint32_t sample, uint32_t samples, uint32_t shares, const host_vertex *vertices)
{
    fixture *f = &s->plate.base;
    VkCommandBuffer cmd;
    float jitter[2];
    host_camera camera;
    host_camera_jitter(host_camera_jitter_index(sample, s->order), samples, jitter);
    host_camera_at(&path, 0, WIDTH, HEIGHT, jitter, &camera);
    camera.samples = samples;
    camera.sample = sample;
    camera.shares = shares;
    camera.follows = sample % shares != 0;
    assert_true(host_begin_frame(&f->device, &cmd, f->error, sizeof f->error));
    host_mesh_move(cmd, &s->bar, vertices);
    assert_true(
        host_renderer_plate(s->plate.renderer, cmd, &s->plate.target, &camera, &camera, f->error, sizeof f->error));
    host_target_begin_layer(&s->plate.target, cmd);
    host_target_end_layer(&s->plate.target, cmd);
    assert_true(
        host_accumulator_add(&s->plate.sums, cmd, &s->plate.target, sample == samples / 2, f->error, sizeof f->error));
    if (sample + 1 == samples)
        host_accumulator_copy_out(&s->plate.sums, cmd, &s->plate.target);
    assert_true(host_submit(&f->device, f->error, sizeof f->error));
}

static void finish(scene *s)
{
    assert_true(host_wait(&s->plate.base.device, s->plate.base.error, sizeof s->plate.base.error));
    host_accumulator_finish(&s->plate.sums, &s->plate.target, &s->plate.picture);
}

static void draw(scene *s, uint32_t samples, uint32_t shares)
{
    host_vertex vertices[MOST_SAMPLES][HOST_SWEPT_VERTICES(PLACES)];
    host_accumulator_reset(&s->plate.sums);
    for (uint32_t i = 0; i < samples; i++) {
        put_turning(i, samples, shares, vertices[i]);
        draw_one(s, i, samples, shares, vertices[i]);
    }
    finish(s);
}

/* Keeps the picture without a bar. */
static void draw_empty(scene *s, uint32_t samples, uint32_t shares)
{
    static const host_vertex nothing[HOST_SWEPT_VERTICES(PLACES)];
    host_accumulator_reset(&s->plate.sums);
    for (uint32_t i = 0; i < samples; i++)
        draw_one(s, i, samples, shares, nothing);
    finish(s);
    memcpy(s->empty, s->plate.picture.color, sizeof s->empty);
}

/* The middle of a pixel in the plane z = 0. */
static void point_of(int x, int y, double point[2])
{
    point[0] = (x + 0.5 - 0.5 * WIDTH) * PIXEL_M;
    point[1] = (0.5 * HEIGHT - y - 0.5) * PIXEL_M;
}

/* The share of the time for which a bar that turns evenly is over a point: its middle is at the point's angle where it
 * is over it the longest, and an angle of asin(half / r) to either side it leaves it. */
static double turning_share(double r, double angle)
{
    const double reach = asin(0.5 * BAR_WIDE / r);
    const double inside = fmin(angle + reach, TURN_TO) - fmax(angle - reach, TURN_FROM);
    return fmax(inside, 0) / (TURN_TO - TURN_FROM);
}

static double covered(const scene *s, int x, int y)
{
    const int at = (y * WIDTH + x) * 4;
    return 1 - (double)s->plate.picture.color[at] / (double)s->empty[at];
}

/* What it hides of the wall where it stands still, as a share: of no albedo it still mirrors some of the white sky. */
static double hidden_by_bar(scene *s)
{
    host_vertex vertices[HOST_SWEPT_VERTICES(PLACES)];
    host_swept_place at[PLACES];
    const host_swept_view view = {.eye_m = {0, 0, 4}};
    s->order = 1;
    draw_empty(s, 1, 1);
    place(M_PI / 2, at);
    const host_swept_bar bar = {.before = at, .open = at, .close = at, .count = PLACES, .half_width_m = 3 * BAR_WIDE};
    host_swept_put(&bar, &view, vertices);
    host_accumulator_reset(&s->plate.sums);
    draw_one(s, 0, 1, 1, vertices);
    finish(s);
    return covered(s, WIDTH / 2 - 1 + (int)lround(axis_m[0] / PIXEL_M), HEIGHT / 2 - (int)lround(0.1 / PIXEL_M));
}

static void check_turning(scene *s, uint32_t samples, uint32_t shares, double black)
{
    double worst = 0, most = 0, sum = 0, wanted_sum = 0;
    s->order = shares;
    draw_empty(s, samples, shares);
    draw(s, samples, shares);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double point[2];
            point_of(x, y, point);
            const double dx = point[0] - axis_m[0], dy = point[1] - axis_m[1], r = hypot(dx, dy);
            if (r < BAR_INNER + 2 * PIXEL_M || r > BAR_OUTER - 2 * PIXEL_M || abs(x - WIDTH / 2) < 2)
                continue;
            const double wanted = turning_share(r, atan2(dy, dx)), got = covered(s, x, y) / black;
            most = fmax(most, wanted);
            worst = fmax(worst, fabs(got - wanted));
            sum += got;
            wanted_sum += wanted;
        }
    printf("%2u samples, %u share: at most %.4f off, most %.3f; sum %.2f, wanted %.2f\n", samples, shares, worst, most,
           sum, wanted_sum);
    assert_true(most > 0.5 && wanted_sum > 50);
    assert_float_equal(sum / wanted_sum, 1, 0.02); /* jitter moves some of it over the columns that are left out */
    assert_true(worst < (samples == 1 ? 0.01 : 0.13));
}

static void a_bar_hides_what_is_behind_it_for_its_share_of_the_time(void **state)
{
    scene *s = *state;
    const double black = hidden_by_bar(s);
    printf("it hides %.4f where it stands\n", black);
    assert_true(black > 0.8);
    check_turning(s, 1, 1, black);
    check_turning(s, 4, 1, black);
    check_turning(s, 16, 1, black);
}

/* Neither before the wall nor before the sky is anything left of the bar of the sub-frame before. */
static void sub_frames_that_share_shading_see_it_in_their_own_places(void **state)
{
    scene *s = *state;
    const double black = hidden_by_bar(s);
    double most = 0;
    check_turning(s, 4, 2, black);
    s->order = 4;
    draw(s, 16, 1);
    memcpy(s->color, s->plate.picture.color, sizeof s->color);
    check_turning(s, 16, 4, black);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        most = fmax(most, fabs((double)(s->color[4 * i] - s->plate.picture.color[4 * i])));
    printf("at most %.5f apart\n", most);
    assert_true(most < 0.002);
}

/* In the one sub-frame that a frame has depth and ids of, where it is for more than half of the time. */
static void depth_is_that_of_what_is_there_for_longer(void **state)
{
    scene *s = *state;
    uint32_t near = 0, far = 0;
    draw(s, 16, 4);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH / 2; x++) {
            const double step = (TURN_TO - TURN_FROM) / 16, angle = TURN_FROM + 8.5 * step;
            double point[2];
            point_of(x, y, point);
            const double dx = point[0] - axis_m[0], dy = point[1] - axis_m[1], r = hypot(dx, dy);
            if (r < BAR_INNER + 2 * PIXEL_M || r > BAR_OUTER - 2 * PIXEL_M)
                continue;
            const double off_m = r * fabs(atan2(dy, dx) - angle);
            const uint32_t id = s->plate.picture.id[y * WIDTH + x];
            if (off_m < 0.5 * BAR_WIDE - 0.8 * PIXEL_M) {
                assert_int_equal(id, 2);
                near++;
            } else if (off_m > 0.5 * BAR_WIDE + 0.8 * PIXEL_M) {
                assert_int_equal(id, 1);
                far++;
            }
        }
    printf("%u pixels of the bar, %u of the wall\n", near, far);
    assert_true(near > 5 && far > 100);
}

/* A bar with a height, seen from the side, hides a m + |s| b on either side: moved evenly by more than that, it is over
 * a point for twice as much of the way. */
static void a_high_bar_is_as_wide_as_it_is_seen(void **state)
{
    host_swept_place from[PLACES], to[PLACES];
    host_vertex v[HOST_SWEPT_VERTICES(PLACES)];
    const double half_width = 0.01, half_height = 0.03, way = 0.4;
    const host_swept_view view = {.eye_m = {0, 3, 1.5}, .margin_rad = 0.01};
    (void)state;
    for (int i = 0; i < PLACES; i++) {
        from[i] = (host_swept_place){.middle = {0.001 * i, 0, 0}, .across = {0, 1, 0}, .normal = {0, 0, 1}};
        to[i] = from[i];
        to[i].middle[1] += way;
    }
    const host_swept_bar bar = {.before = from,
                                .open = from,
                                .close = to,
                                .count = PLACES,
                                .half_width_m = half_width,
                                .half_height_m = half_height};
    host_swept_put(&bar, &view, v);
    const double slope = (3 - way) / 1.5, half = half_width + slope * half_height;
    const double far = hypot(3 - way, 1.5), margin = 0.01 * far / (1.5 / far);
    const host_vertex *trace = v + 2 * PLACES;
    assert_float_equal((double)v[0].position[1], -half, 1e-6);
    assert_float_equal((double)v[1].position[1], way + half, 1e-6);
    assert_float_equal((double)v[0].uv[0], -1, 1e-4);
    assert_float_equal((double)v[0].uv[1], -1 - way / half, 1e-4);
    assert_float_equal((double)v[1].uv[0], 1 + way / half, 1e-4);
    assert_float_equal((double)v[1].uv[1], 1, 1e-4);
    assert_float_equal((double)trace[0].position[1], -half - margin, 1e-6);
    assert_float_equal((double)trace[1].position[1], way + half + margin, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bar_hides_what_is_behind_it_for_its_share_of_the_time),
        cmocka_unit_test(sub_frames_that_share_shading_see_it_in_their_own_places),
        cmocka_unit_test(depth_is_that_of_what_is_there_for_longer),
        cmocka_unit_test(a_high_bar_is_as_wide_as_it_is_seen),
    };
    return fixture_result(cmocka_run_group_tests(tests, set_up, tear_down));
}
