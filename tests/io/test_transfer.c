/* test_transfer.c - transfer curves: published values, and the way from a code to light and back. */
#include "picture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Light of mid grey and of marks that the publications give, as codes of 1023 where those do. */
static void curves_have_the_published_values(void **state)
{
    (void)state;
    static const struct {
        transfer_curve curve;
        double light, code, within;
    } known[] = {
        {TRANSFER_SRGB, 0.2140411, 0.5, 1e-6},
        {TRANSFER_SRGB, 1, 1, 1e-9},
        {TRANSFER_REC709, 0.018, 0.081, 1e-3},
        {TRANSFER_REC709, 0.18, 0.4090, 2e-4},
        {TRANSFER_REC709, 1, 1, 1e-9},
        {TRANSFER_ACESCCT, 0.18, 0.4135884, 1e-6},
        {TRANSFER_ACESCCT, 0, 0.0729055, 1e-6},
        {TRANSFER_ACESCCT, 1, 0.5547945, 1e-6},
        {TRANSFER_CINEON, 1, 685.0 / 1023, 1e-9},
        {TRANSFER_CINEON, 0, 95.0 / 1023, 1e-9},
        {TRANSFER_LOGC3, 0.18, 0.391007, 1e-5},
        {TRANSFER_LOGC3, 0, 0.092809, 1e-6},
        {TRANSFER_SLOG3, 0.18, 420.0 / 1023, 1e-9},
        {TRANSFER_SLOG3, 0, 95.0 / 1023, 1e-9},
        {TRANSFER_SLOG3, 0.9, 598.0 / 1023, 5e-4},
        {TRANSFER_LINEAR, 0.3, 0.3, 1e-9},
    };
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        const double code = transfer_to_code(known[i].curve, known[i].light);
        if (fabs(code - known[i].code) > known[i].within)
            fail_msg("%s: code %.7f of light %g, expected %.7f", transfer_name(known[i].curve), code, known[i].light,
                     known[i].code);
    }
}

/* Through floats, as a plate goes: the largest error in codes. */
static double round_trip(transfer_curve curve, uint32_t largest)
{
    double worst = 0;
    for (uint32_t code = 0; code <= largest; code++) {
        const float light = (float)transfer_to_light(curve, (double)code / largest);
        worst = fmax(worst, fabs(transfer_to_code(curve, (double)light) * largest - code));
    }
    return worst;
}

static void every_code_comes_back(void **state)
{
    (void)state;
    for (uint32_t curve = TRANSFER_LINEAR; curve < TRANSFER_COUNT; curve++)
        for (uint32_t bits = 8; bits <= 16; bits += 2) {
            const double worst = round_trip(curve, (1u << bits) - 1);
            if (worst > 0.5 / 16)
                fail_msg("%s, %u bits: %.3f codes off", transfer_name(curve), bits, worst);
        }
}

static void light_rises_with_the_code(void **state)
{
    (void)state;
    for (uint32_t curve = TRANSFER_LINEAR; curve < TRANSFER_COUNT; curve++)
        for (uint32_t code = 0; code < 65535; code++)
            assert_true(transfer_to_light(curve, (code + 1) / 65535.0) > transfer_to_light(curve, code / 65535.0));
}

/* Line and curve of a formula meet: the published constants are rounded to some 1e-4 of a code. */
static void curves_have_no_step(void **state)
{
    (void)state;
    for (uint32_t curve = TRANSFER_LINEAR; curve < TRANSFER_COUNT; curve++)
        for (int i = -100; i < 20000; i++) {
            const double light = i * 1e-5;
            const double step = transfer_to_code(curve, light + 1e-9) - transfer_to_code(curve, light);
            assert_true(step >= 0 && step < 3e-5);
        }
}

/* 64 x 64 pixels of every third 8-bit code, and of all between, through light and back. */
static void samples_come_back_through_light(void **state)
{
    (void)state;
    enum { COUNT = 65536 };
    float *rgb = malloc(COUNT * 3 * sizeof *rgb), *rgba = malloc(COUNT * 4 * sizeof *rgba);
    uint16_t *words = malloc(COUNT * 3 * sizeof *words);
    for (uint32_t bits = 8; bits <= 16; bits += 8)
        for (uint32_t curve = TRANSFER_LINEAR; curve < TRANSFER_COUNT; curve++) {
            const picture_format format = {PICTURE_PNG, bits};
            const uint32_t largest = (1u << bits) - 1;
            for (uint32_t i = 0; i < COUNT * 3; i++)
                rgb[i] = (float)(i / 3 % (largest + 1)) / (float)largest;
            picture_to_light(rgb, COUNT * 3, curve, format);
            for (uint32_t i = 0; i < COUNT * 3; i++)
                rgba[i / 3 * 4 + i % 3] = rgb[i];
            picture_from_light(rgba, NULL, COUNT, curve, format, 7, words);
            for (uint32_t i = 0; i < COUNT * 3; i++)
                assert_int_equal(bits == 8 ? ((uint8_t *)words)[i] : words[i], i / 3 % (largest + 1));
        }
    free(rgb);
    free(rgba);
    free(words);
}

/* A light between two codes: dither gives their mean, and the same for the same seed. */
static void dither_keeps_the_mean(void **state)
{
    (void)state;
    enum { COUNT = 40000 };
    const picture_format format = {PICTURE_JPEG, 8};
    float *rgba = malloc(COUNT * 4 * sizeof *rgba);
    uint8_t *first = malloc(COUNT * 3), *again = malloc(COUNT * 3), *other = malloc(COUNT * 3);
    for (int i = 0; i < COUNT * 4; i++)
        rgba[i] = (float)transfer_to_light(TRANSFER_SRGB, 100.3 / 255);
    picture_from_light(rgba, NULL, COUNT, TRANSFER_AUTO, format, 1, first);
    picture_from_light(rgba, NULL, COUNT, TRANSFER_AUTO, format, 1, again);
    picture_from_light(rgba, NULL, COUNT, TRANSFER_AUTO, format, 2, other);
    double sum = 0;
    for (int i = 0; i < COUNT * 3; i++)
        sum += first[i];
    assert_true(fabs(sum / (COUNT * 3) - 100.3) < 0.01); /* 7 standard errors */
    assert_memory_equal(first, again, COUNT * 3);
    assert_true(memcmp(first, other, COUNT * 3));
    free(rgba);
    free(first);
    free(again);
    free(other);
}

static void light_out_of_range_is_cut(void **state)
{
    (void)state;
    const float rgba[8] = {-1, 2, NAN, 1, 65504, 0, 1, 1};
    uint8_t bytes[6];
    picture_from_light(rgba, NULL, 2, TRANSFER_SRGB, (picture_format){PICTURE_PNG, 8}, 1, bytes);
    const uint8_t expected[6] = {0, 255, 0, 255, 0, 255};
    assert_memory_equal(bytes, expected, 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(curves_have_the_published_values), cmocka_unit_test(every_code_comes_back),
        cmocka_unit_test(light_rises_with_the_code),        cmocka_unit_test(curves_have_no_step),
        cmocka_unit_test(samples_come_back_through_light),  cmocka_unit_test(dither_keeps_the_mean),
        cmocka_unit_test(light_out_of_range_is_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
