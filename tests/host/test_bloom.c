/* test_bloom.c - light that wet air spreads: the passes against the same in double precision, the filters against the
 * closed form of what droplets diffract, and that no light is lost. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "aureole.h"
#include "bloom.h"
#include "plate_fixture.h"

#define PI       3.14159265358979323846
#define NEAR_M   0.1
#define FAR_M    1000.0
#define MOST_PX  (192 * 160)
#define WAVE_RED 611e-9

typedef struct picture {
    uint32_t width, height;
    float color[MOST_PX * 4], depth[MOST_PX];
    float layer[MOST_PX * 4]; /* what was drawn over it */
} picture;

static fixture base;
static picture p;
static const host_bloom_air fog = {.visibility_m = 300, .drop_m = 15e-6, .sky_m = 400};
static float clip_from_view[16];

static void make_camera(void)
{
    memset(clip_from_view, 0, sizeof clip_from_view);
    clip_from_view[0] = 2.0f * (float)p.height / (float)p.width;
    clip_from_view[5] = -2;
    clip_from_view[8] = 0.01f; /* jitter */
    clip_from_view[9] = -0.02f;
    clip_from_view[10] = (float)(FAR_M / (NEAR_M - FAR_M));
    clip_from_view[11] = -1;
    clip_from_view[14] = (float)(NEAR_M * FAR_M / (NEAR_M - FAR_M));
}

static float depth_at(double metres)
{
    return (float)(FAR_M / (FAR_M - NEAR_M) * (1 - NEAR_M / metres));
}

static void make_black(uint32_t width, uint32_t height, double metres)
{
    p.width = width;
    p.height = height;
    memset(p.color, 0, sizeof p.color);
    for (uint32_t i = 0; i < width * height; i++)
        p.depth[i] = depth_at(metres);
    make_camera();
}

static float *pixel(uint32_t x, uint32_t y)
{
    return &p.color[4 * (y * p.width + x)];
}

static void upload(host_buffer *buffer, const float *from, size_t channels)
{
    const size_t size = p.width * p.height * channels * sizeof(float);
    assert_true(host_buffer_create(&base.device, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HOST_BUFFER_UPLOAD, "test",
                                   buffer, base.error, sizeof base.error));
    memcpy(buffer->mapped, from, size);
}

/* Draws the bloom of p.color into p.layer. */
static void draw(const host_bloom_air *air)
{
    host_target target;
    host_bloom bloom;
    host_buffer color, depth;
    VkCommandBuffer cmd;
    char *error = base.error;
    const size_t size = sizeof base.error;
    assert_true(host_target_create(&base.device, p.width, p.height, &target, error, size));
    const host_bloom_def def = {.width = p.width,
                                .height = p.height,
                                .color = target.images[HOST_COLOR].view,
                                .depth = target.images[HOST_DEPTH].view,
                                .pass = target.layer_pass};
    assert_true(host_bloom_create(&base.device, &def, &bloom, error, size));
    upload(&color, p.color, 4);
    upload(&depth, p.depth, 1);
    assert_true(host_begin_frame(&base.device, &cmd, error, size));
    host_target_fill_plate(&target, cmd, &color, &depth);
    for (int i = 0; i < 2; i++) { /* the second one needs what the first has drawn no more */
        host_bloom_record(&bloom, cmd, air, clip_from_view);
        host_target_begin_layer(&target, cmd);
        host_bloom_draw(&bloom, cmd);
        host_target_end_layer(&target, cmd);
    }
    host_target_copy_out(&target, cmd, 1u << HOST_LAYER);
    assert_true(host_submit(&base.device, error, size) && host_wait(&base.device, error, size));
    memcpy(p.layer, host_target_floats(&base.device, &target, HOST_LAYER), p.width * p.height * 4 * sizeof(float));
    host_buffer_destroy(&base.device, &color);
    host_buffer_destroy(&base.device, &depth);
    host_bloom_destroy(&bloom);
    host_target_destroy(&base.device, &target);
}

/* ---- the same in double precision, level by level */

typedef struct level {
    int width, height;
    double light[MOST_PX][3], more[MOST_PX][3];
} level;

static int inside(int at, int size)
{
    return at < 0 ? 0 : at >= size ? size - 1 : at;
}

/* The share that is diffracted, and the part of it that is so more than once, of that at HOST_AUREOLE_MOST. */
static void shares(uint32_t i, double share[2])
{
    const double x = (i % p.width + 0.5) / p.width * 2 - 1, y = (i / p.width + 0.5) / p.height * 2 - 1;
    const double right = (x + (double)clip_from_view[8]) / (double)clip_from_view[0];
    const double up = (y + (double)clip_from_view[9]) / (double)clip_from_view[5];
    const double along = FAR_M * NEAR_M / (FAR_M - (double)p.depth[i] * (FAR_M - NEAR_M));
    const double metres = p.depth[i] >= 1 ? fog.sky_m : along * sqrt(1 + right * right + up * up);
    const double t = metres * 0.5 * log(50) / fog.visibility_m, most = HOST_AUREOLE_MOST;
    share[0] = -expm1(-t);
    share[1] = fmin((1 - t * exp(-t) / share[0]) / (1 - most * exp(-most) / -expm1(-most)), 1);
}

static void take_light(level *to)
{
    for (int i = 0; i < to->width * to->height; i++)
        for (int k = 0; k < 4; k++) {
            const int x = inside(2 * (i % to->width) + k % 2, (int)p.width);
            const int y = inside(2 * (i / to->width) + k / 2, (int)p.height);
            double share[2];
            shares((uint32_t)y * p.width + (uint32_t)x, share);
            for (int c = 0; c < 3; c++) {
                const double light = share[0] * (double)pixel((uint32_t)x, (uint32_t)y)[c] / 4;
                to->light[i][c] += light;
                to->more[i][c] += share[1] * light;
            }
        }
}

static void reduce(const level *from, level *to)
{
    static const double row[4] = {0.125, 0.375, 0.375, 0.125};
    for (int i = 0; i < to->width * to->height; i++)
        for (int k = 0; k < 16; k++) {
            const int x = inside(2 * (i % to->width) + k % 4 - 1, from->width);
            const int y = inside(2 * (i / to->width) + k / 4 - 1, from->height);
            for (int c = 0; c < 3; c++) {
                to->light[i][c] += row[k % 4] * row[k / 4] * from->light[y * from->width + x][c];
                to->more[i][c] += row[k % 4] * row[k / 4] * from->more[y * from->width + x][c];
            }
        }
}

/* A color of a level at a texel of the finer one. */
static double enlarged(const level *from, int x, int y, int c)
{
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        const double dx = fabs(0.5 * (x + 0.5) - (floor(0.5 * (x - 1)) + k % 2 + 0.5));
        const double dy = fabs(0.5 * (y + 0.5) - (floor(0.5 * (y - 1)) + k / 2 + 0.5));
        const int at_x = inside((int)floor(0.5 * (x - 1)) + k % 2, from->width);
        const int at_y = inside((int)floor(0.5 * (y - 1)) + k / 2, from->height);
        sum += (1 - dx) * (1 - dy) * from->light[at_y * from->width + at_x][c];
    }
    return sum;
}

static level *make_levels(uint32_t count, host_aureole_weight *kept)
{
    host_aureole_weight weights[HOST_BLOOM_LEVELS];
    level *levels = calloc(count, sizeof *levels);
    assert_non_null(levels);
    host_aureole_weights(fog.drop_m, 1.0 / p.height, count, kept, weights);
    for (uint32_t k = 0; k < count; k++) {
        levels[k].width = k ? (levels[k - 1].width + 1) / 2 : (int)(p.width + 1) / 2;
        levels[k].height = k ? (levels[k - 1].height + 1) / 2 : (int)(p.height + 1) / 2;
        if (k)
            reduce(&levels[k - 1], &levels[k]);
        else
            take_light(&levels[k]);
    }
    for (uint32_t k = count; k-- > 0;)
        for (int i = 0; i < levels[k].width * levels[k].height; i++)
            for (int c = 0; c < 3; c++) {
                double *light = &levels[k].light[i][c];
                *light = weights[k].single[c] * *light + weights[k].more[c] * levels[k].more[i][c];
                if (k + 1 < count)
                    *light += enlarged(&levels[k + 1], i % levels[k].width, i / levels[k].width, c);
            }
    return levels;
}

static void passes_agree_with_double_precision(void **state)
{
    (void)state;
    srand(5);
    make_black(37, 23, 1);
    for (uint32_t i = 0; i < p.width * p.height; i++) {
        for (int c = 0; c < 3; c++)
            p.color[4 * i + (uint32_t)c] = rand() % 20 ? (float)rand() / (float)RAND_MAX : 100;
        p.depth[i] = rand() % 9 ? depth_at(1 + rand() % 800) : 1;
    }
    draw(&fog);
    host_aureole_weight kept;
    level *levels = make_levels(4, &kept);
    for (uint32_t i = 0; i < p.width * p.height; i++) {
        double share[2];
        shares(i, share);
        const double lost = share[0] * (1 - kept.single[0] - share[1] * kept.more[0]);
        assert_float_equal(p.layer[4 * i + 3], lost, 2e-4); /* of depth in floats: far things have few bits */
        for (int c = 0; c < 3; c++) {
            const double is = enlarged(&levels[0], (int)(i % p.width), (int)(i / p.width), c);
            assert_float_equal(p.layer[4 * i + (uint32_t)c], is, 2e-4 * is + 1e-6);
        }
    }
    free(levels);
}

/* ---- light */

static double sum_after(int channel)
{
    double sum = 0;
    for (uint32_t i = 0; i < p.width * p.height; i++)
        sum += (1 - (double)p.layer[4 * i + 3]) * (double)p.color[4 * i + (uint32_t)channel] +
               (double)p.layer[4 * i + (uint32_t)channel];
    return sum;
}

static void make_lamp(double metres)
{
    make_black(191, 159, metres); /* odd: texels that are half outside */
    pixel(95, 79)[0] = pixel(95, 79)[1] = pixel(95, 79)[2] = 1000;
}

static void no_light_is_lost_where_all_of_it_stays_in_the_picture(void **state)
{
    const host_bloom_air mist = {.visibility_m = 100, .drop_m = 50e-6, .sky_m = 400};
    (void)state;
    make_lamp(60);
    draw(&mist);
    for (int c = 0; c < 3; c++)
        assert_float_equal(sum_after(c), 1000, 2);
    assert_true((double)p.layer[4 * (79 * p.width + 95) + 3] > 0.3); /* and a third of it was spread */
}

/* Standard deviation of the layer's light around the lamp, to the right. */
static double width_px(int channel)
{
    double sum = 0, moment = 0;
    for (uint32_t i = 0; i < p.width * p.height; i++) {
        const double light = (double)p.layer[4 * i + (uint32_t)channel], x = i % p.width - 95.0;
        sum += light;
        moment += light * x * x;
    }
    return sqrt(moment / sum);
}

static void what_is_farther_blooms_wider_and_more(void **state)
{
    const host_bloom_air mist = {.visibility_m = 100, .drop_m = 30e-6, .sky_m = 400};
    double width[2], glow[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        make_lamp(i ? 120 : 10);
        draw(&mist);
        width[i] = width_px(1);
        glow[i] = (double)p.layer[4 * (79 * p.width + 99) + 1]; /* 4 pixels beside it */
    }
    assert_true(width[1] > 1.2 * width[0]);
    assert_true(glow[1] > 2 * glow[0]);
}

static void red_blooms_wider_than_blue(void **state)
{
    const host_bloom_air mist = {.visibility_m = 100, .drop_m = 30e-6, .sky_m = 400};
    (void)state;
    make_lamp(20);
    draw(&mist);
    assert_true(width_px(0) > 1.05 * width_px(2));
}

static void an_even_picture_stays_as_it_is(void **state)
{
    (void)state;
    make_black(61, 47, 80);
    for (uint32_t i = 0; i < 4 * p.width * p.height; i++)
        p.color[i] = 0.5f;
    for (uint32_t i = 0; i < p.width * p.height; i++) /* one distance, not one depth */
        p.depth[i] = 1;
    draw(&fog);
    for (uint32_t i = 0; i < p.width * p.height; i++)
        assert_float_equal((1 - p.layer[4 * i + 3]) * 0.5f + p.layer[4 * i], 0.5f, 1e-6);
}

static void colors_that_are_not_finite_spread_nothing(void **state)
{
    (void)state;
    make_black(33, 21, 50);
    pixel(7, 7)[0] = NAN;
    pixel(20, 10)[1] = INFINITY;
    pixel(25, 15)[2] = -INFINITY;
    draw(&fog);
    for (uint32_t i = 0; i < p.width * p.height; i++)
        for (uint32_t c = 0; c < 3; c++)
            assert_true(p.layer[4 * i + c] == 0); /* cmocka takes NaN for equal */
}

static void pictures_of_a_pixel_spread_nothing(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1}, {1, 9}, {9, 1}, {2, 2}};
    (void)state;
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        make_black(sizes[k][0], sizes[k][1], 50);
        for (uint32_t i = 0; i < 4 * p.width * p.height; i++)
            p.color[i] = 2;
        draw(&fog);
        for (uint32_t i = 0; i < p.width * p.height; i++) /* they keep their light, whatever is spread */
            assert_float_equal((1 - p.layer[4 * i + 3]) * 2 + p.layer[4 * i], 2, 0.02);
    }
}

/* ---- what droplets diffract */

/* A disc's transfer at low frequencies s is 1 - (4 / pi) s wavelength / d. Here sizes vary, and light is diffracted
 * anywhere on its way, which halves it. */
static void transfer_begins_as_the_diffraction_of_discs(void **state)
{
    const double drop = 20e-6, s = 1;
    (void)state;
    assert_float_equal(host_aureole_once(drop, WAVE_RED, 0), 1, 1e-12);
    /* the mean of 1 / d by cross-section is 1 / (d (1 - v)), v = 0.1 */
    assert_float_equal(1 - host_aureole_once(drop, WAVE_RED, s), 0.5 * 4 / PI * WAVE_RED / (drop * 0.9) * s, 1e-4);
    assert_float_equal(host_aureole_once(drop, WAVE_RED, 1e9), 0, 1e-6);
    assert_float_equal(host_aureole_transfer(drop, WAVE_RED, 1e-4, s), host_aureole_once(drop, WAVE_RED, s), 1e-4);
    assert_true(host_aureole_transfer(drop, WAVE_RED, 2, s) < host_aureole_once(drop, WAVE_RED, s));
}

/* Against the closed form at all frequencies that the picture has, for pixels of 0.06 and 0.3 degrees, at both ends of
 * the depths, and between them. */
static void levels_have_that_transfer(void **state)
{
    static const double drops[] = {5e-6, 15e-6, 60e-6, 200e-6}, pixels[] = {0.001, 0.005}, depths[] = {1e-3, 0.5, 1, 2};
    (void)state;
    for (int d = 0; d < 32; d++) {
        const double drop = drops[d / 8], pixel_rad = pixels[d / 4 % 2], t = depths[d % 4], most = HOST_AUREOLE_MOST;
        const double h = (1 - t * exp(-t) / -expm1(-t)) / (1 - most * exp(-most) / -expm1(-most));
        host_aureole_weight weights[1 + HOST_BLOOM_LEVELS];
        host_aureole_weights(drop, pixel_rad, HOST_BLOOM_LEVELS, weights, weights + 1);
        for (double s = 0.001; s < 0.25; s *= 1.3) {
            double is = 0, sum = 0;
            for (uint32_t k = 0; k <= HOST_BLOOM_LEVELS; k++) {
                const double weight = weights[k].single[0] + h * weights[k].more[0];
                const double sigma = k ? host_aureole_level_px(k) : 0;
                is += weight * exp(-2 * pow(PI * sigma * s, 2));
                sum += weight;
                assert_true(weight >= 0);
            }
            assert_float_equal(sum, 1, 1e-9);
            assert_float_equal(is, host_aureole_transfer(drop, WAVE_RED, t, s / pixel_rad), 0.04);
        }
    }
}

/* Koschmieder's visibility: 2 % of the light of a black thing's surroundings is left, half of it by diffraction. */
static void visibility_is_an_optical_depth(void **state)
{
    (void)state;
    assert_float_equal(exp(-2 * host_aureole_per_m(300) * 300), 0.02, 1e-9);
}

static int set_up(void **state)
{
    (void)state;
    if (fixture_begin(&base))
        return 0;
    fprintf(stderr, "no device to draw with: %s\n", base.error);
    exit(77);
}

static int tear_down(void **state)
{
    (void)state;
    return fixture_end(&base) ? -1 : 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passes_agree_with_double_precision),
        cmocka_unit_test(no_light_is_lost_where_all_of_it_stays_in_the_picture),
        cmocka_unit_test(what_is_farther_blooms_wider_and_more),
        cmocka_unit_test(red_blooms_wider_than_blue),
        cmocka_unit_test(an_even_picture_stays_as_it_is),
        cmocka_unit_test(colors_that_are_not_finite_spread_nothing),
        cmocka_unit_test(pictures_of_a_pixel_spread_nothing),
        cmocka_unit_test(transfer_begins_as_the_diffraction_of_discs),
        cmocka_unit_test(levels_have_that_transfer),
        cmocka_unit_test(visibility_is_an_optical_depth),
    };
    return fixture_result(cmocka_run_group_tests(tests, set_up, tear_down));
}
