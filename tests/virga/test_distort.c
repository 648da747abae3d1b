/* test_distort.c - pictures between a pinhole and a lens that bends lines: places, light, and what is kept. */
#include "shot/distort.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 160, HEIGHT = 90, PIXELS = WIDTH * HEIGHT };

static char error[256];

static shot_distortion lens;
static host_drawn pinhole, picture;

/* A strong barrel, close to its fold in the corners. */
static int open_lens(void **state)
{
    (void)state;
    distortion_map map = {.lens = {-0.24, 0.07, 0.0004, -0.0006, -0.008},
                          .size = {WIDTH, HEIGHT},
                          .focal_px = {73.3, 73.2},
                          .center_px = {79.6, 46}};
    assert_true(distortion_map_open(&map, error, sizeof error));
    assert_true(shot_distortion_open(&lens, &map, error, sizeof error));
    assert_true(host_drawn_create(map.pinhole_size[0], map.pinhole_size[1], &pinhole, error, sizeof error));
    assert_true(host_drawn_create(WIDTH, HEIGHT, &picture, error, sizeof error));
    return 0;
}

static int close_lens(void **state)
{
    (void)state;
    shot_distortion_close(&lens);
    host_drawn_destroy(&pinhole);
    host_drawn_destroy(&picture);
    return 0;
}

static void redo(shot_distortion_kind kind, const shot_distortion_plate *plate)
{
    const shot_distortion_kind kinds[HOST_MAX_LAYERS] = {kind};
    shot_distortion_redo(&lens, &pinhole, kinds, 1, plate, &picture);
}

/* A soft spot of one layer, at a place of the pinhole's picture. Returns its light. */
static double draw_spot(const double at[2], double sigma_px)
{
    double sum = 0;
    for (size_t i = 0; i < (size_t)pinhole.width * pinhole.height; i++) {
        const double x = (double)(i % pinhole.width) + 0.5 - at[0], y = (double)(i / pinhole.width) + 0.5 - at[1];
        const double light = exp(-0.5 * (x * x + y * y) / (sigma_px * sigma_px));
        for (size_t c = 0; c < 4; c++)
            pinhole.layers[0][4 * i + c] = light > 1e-6 ? (float)light : 0;
        sum += light;
    }
    return sum;
}

static void light_stays_and_lands_at_its_place(void **state)
{
    (void)state;
    for (int k = 0; k < 12; k++) {
        const double wanted[2] = {15 + 11.7 * k, 14 + 5.3 * k};
        double at[2], seen[2], m[2][2], sum = 0, middle[2] = {0, 0};
        assert_true(distortion_map_undo(&lens.map, wanted, at));
        distortion_map_apply(&lens.map, at, seen, m);
        const double sharpest = fmin(m[0][0], m[1][1]), sigma_px = fmin(1.2 / sharpest, 3);
        const double drawn = draw_spot(at, sigma_px) * (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
        redo(SHOT_DISTORT_COLOR, &(shot_distortion_plate){.color = NULL});
        for (size_t i = 0; i < PIXELS; i++) {
            const double light = (double)picture.layers[0][4 * i + 3];
            assert_true(light >= 0);
            sum += light;
            middle[0] += light * ((double)(i % WIDTH) + 0.5);
            middle[1] += light * ((double)(i / WIDTH) + 0.5);
        }
        /* A spot is not a point: the lens bends it, by half its variance times the slope of the Jacobian. */
        if (!(fabs(sum / drawn - 1) < 0.05))
            fail_msg("spot %d has %.3f of its light", k, sum / drawn);
        if (!(hypot(middle[0] / sum - seen[0], middle[1] / sum - seen[1]) < 0.05))
            fail_msg("spot %d is at %.3f, %.3f, expected %.3f, %.3f", k, middle[0] / sum, middle[1] / sum, seen[0],
                     seen[1]);
    }
}

/* A plate of noise, whose pixels no resampling would keep. */
static float *noise(size_t count, uint32_t seed)
{
    float *values = malloc(count * sizeof *values);
    assert_non_null(values);
    for (size_t i = 0; i < count; i++) {
        seed = seed * 1664525u + 1013904223u;
        values[i] = (float)(seed >> 8) / 16777216.0f;
    }
    return values;
}

static void plates_keep_their_pixels(void **state)
{
    (void)state;
    float *plate = noise(PIXELS * 4, 1), *depth = noise(PIXELS, 2);
    const shot_distortion_plate given = {.color = plate, .depth = depth};
    draw_spot((const double[]){0.5 * pinhole.width, 0.5 * pinhole.height}, 2);
    redo(SHOT_DISTORT_COLOR, &given);
    assert_memory_equal(picture.color, plate, PIXELS * 4 * sizeof *plate);
    assert_memory_equal(picture.depth, depth, PIXELS * sizeof *depth);
    size_t empty = 0;
    for (size_t i = 0; i < PIXELS; i++)
        empty += picture.layers[0][4 * i + 3] == 0;
    assert_true(empty > PIXELS * 9 / 10);
    /* Of a plate that was blurred, what the blur changed is added. */
    float *undone = malloc((size_t)pinhole.width * pinhole.height * 4 * sizeof *undone);
    assert_non_null(undone);
    shot_distortion_undo_color(&lens, plate, undone);
    for (size_t i = 0; i < (size_t)pinhole.width * pinhole.height * 4; i++)
        pinhole.color[i] = undone[i] + 0.25f;
    redo(SHOT_DISTORT_COLOR, &(shot_distortion_plate){.color = plate, .undone = undone});
    for (size_t i = 0; i < PIXELS * 4; i++)
        assert_true(fabsf(picture.color[i] - plate[i] - 0.25f) < 1e-5f);
    free(undone);
    free(plate);
    free(depth);
}

/* A ramp comes back as it was, and what is beyond the border is that of the border. */
static void plates_are_undone(void **state)
{
    (void)state;
    float *ramp = malloc(PIXELS * 4 * sizeof *ramp), *numbers = malloc(PIXELS * sizeof *numbers);
    const size_t seen_pixels = (size_t)pinhole.width * pinhole.height;
    float *undone = malloc(seen_pixels * 4 * sizeof *undone), *near = malloc(seen_pixels * sizeof *near);
    assert_true(ramp && numbers && undone && near);
    for (size_t i = 0; i < PIXELS; i++) {
        numbers[i] = (float)i;
        for (size_t c = 0; c < 4; c++)
            ramp[4 * i + c] = c == 0 ? (float)(i % WIDTH) + 0.5f : c == 1 ? (float)(i / WIDTH) + 0.5f : 1;
    }
    shot_distortion_undo_color(&lens, ramp, undone);
    shot_distortion_undo_nearest(&lens, numbers, near);
    size_t inside = 0;
    for (size_t i = 0; i < seen_pixels; i++) {
        const double at[2] = {(double)(i % pinhole.width) + 0.5, (double)(i / pinhole.width) + 0.5};
        double seen[2];
        distortion_map_apply(&lens.map, at, seen, NULL);
        assert_true(isfinite(undone[4 * i]) && near[i] >= 0 && near[i] < PIXELS);
        assert_true(fabsf(undone[4 * i + 3] - 1) < 1e-6f);
        if (seen[0] < 3 || seen[1] < 3 || seen[0] > WIDTH - 3 || seen[1] > HEIGHT - 3)
            continue;
        inside++;
        assert_true(hypot((double)undone[4 * i] - seen[0], (double)undone[4 * i + 1] - seen[1]) < 0.02);
        assert_true(near[i] == floorf((float)seen[1]) * WIDTH + floorf((float)seen[0]));
    }
    assert_true(inside > PIXELS);
    free(ramp);
    free(numbers);
    free(undone);
    free(near);
}

static void offsets_are_those_of_the_picture(void **state)
{
    (void)state;
    for (size_t i = 0; i < (size_t)pinhole.width * pinhole.height; i++) {
        pinhole.layers[0][4 * i] = pinhole.velocity[2 * i] = 7;
        pinhole.layers[0][4 * i + 1] = pinhole.velocity[2 * i + 1] = -4;
    }
    redo(SHOT_DISTORT_OFFSET, &(shot_distortion_plate){.color = NULL});
    for (size_t i = 0; i < PIXELS; i++) {
        const double at[2] = {(double)(i % WIDTH) + 0.5, (double)(i / WIDTH) + 0.5};
        double from[2], there[2], before[2];
        assert_true(distortion_map_undo(&lens.map, at, from));
        distortion_map_apply(&lens.map, (const double[]){from[0] + 7, from[1] - 4}, there, NULL);
        distortion_map_apply(&lens.map, (const double[]){from[0] - 7, from[1] + 4}, before, NULL);
        for (int axis = 0; axis < 2; axis++) {
            assert_true(fabs((double)picture.layers[0][4 * i + (size_t)axis] - (there[axis] - at[axis])) < 1e-3);
            assert_true(fabs((double)picture.velocity[2 * i + (size_t)axis] - (at[axis] - before[axis])) < 1e-3);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(light_stays_and_lands_at_its_place, open_lens, close_lens),
        cmocka_unit_test_setup_teardown(plates_keep_their_pixels, open_lens, close_lens),
        cmocka_unit_test_setup_teardown(plates_are_undone, open_lens, close_lens),
        cmocka_unit_test_setup_teardown(offsets_are_those_of_the_picture, open_lens, close_lens),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
