/* test_png.c - PNG and JPEG, PNG as numbers, and the tone curve of previews. */
#include "check_io.h"
#include "png.h"

#include <math.h>
#include <zlib.h>

/* A grey 8 x 8 JPEG, every sample 200. */
static const uint8_t grey_jpeg[] = {
    0xff, 0xd8, 0xff, 0xe0, 0x00, 0x10, 0x4a, 0x46, 0x49, 0x46, 0x00, 0x01, 0x01, 0x00, 0x00, 0x01, 0x00, 0x01,
    0x00, 0x00, 0xff, 0xdb, 0x00, 0x43, 0x00, 0x06, 0x04, 0x05, 0x06, 0x05, 0x04, 0x06, 0x06, 0x05, 0x06, 0x07,
    0x07, 0x06, 0x08, 0x0a, 0x10, 0x0a, 0x0a, 0x09, 0x09, 0x0a, 0x14, 0x0e, 0x0f, 0x0c, 0x10, 0x17, 0x14, 0x18,
    0x18, 0x17, 0x14, 0x16, 0x16, 0x1a, 0x1d, 0x25, 0x1f, 0x1a, 0x1b, 0x23, 0x1c, 0x16, 0x16, 0x20, 0x2c, 0x20,
    0x23, 0x26, 0x27, 0x29, 0x2a, 0x29, 0x19, 0x1f, 0x2d, 0x30, 0x2d, 0x28, 0x30, 0x25, 0x28, 0x29, 0x28, 0xff,
    0xc0, 0x00, 0x0b, 0x08, 0x00, 0x08, 0x00, 0x08, 0x01, 0x01, 0x11, 0x00, 0xff, 0xc4, 0x00, 0x14, 0x00, 0x01,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x07, 0xff, 0xc4,
    0x00, 0x14, 0x10, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0xff, 0xda, 0x00, 0x08, 0x01, 0x01, 0x00, 0x00, 0x3f, 0x00, 0x60, 0x7f, 0xff, 0xd9,
};

static uint8_t *make_pixels(uint32_t width, uint32_t height, uint32_t channels)
{
    uint64_t seed = 1;
    size_t size = (size_t)width * height * channels;
    uint8_t *pixels = malloc(size);
    for (size_t i = 0; i < size; i++)
        pixels[i] = (uint8_t)random_bits(&seed);
    return pixels;
}

static void rgba_comes_back(void **state)
{
    (void)state;
    uint32_t width, height;
    uint8_t *pixels = make_pixels(37, 21, 4), *read;
    assert_true(png_write(in_folder("p.png"), 37, 21, 4, pixels, error, sizeof error));
    assert_true(png_read(in_folder("p.png"), &width, &height, &read, error, sizeof error));
    assert_int_equal(width, 37);
    assert_int_equal(height, 21);
    assert_memory_equal(read, pixels, 37 * 21 * 4);
    assert_int_equal(folder_entries(false), 1);
    free(pixels);
    free(read);
}

static void rgb_comes_back_opaque(void **state)
{
    (void)state;
    uint32_t width, height;
    uint8_t *pixels = make_pixels(5, 3, 3), *read;
    assert_true(png_write(in_folder("p.png"), 5, 3, 3, pixels, error, sizeof error));
    assert_true(png_read(in_folder("p.png"), &width, &height, &read, error, sizeof error));
    for (int i = 0; i < 15; i++) {
        assert_memory_equal(read + i * 4, pixels + i * 3, 3);
        assert_int_equal(read[i * 4 + 3], 255);
    }
    free(pixels);
    free(read);
}

static void jpeg_is_read_from_memory(void **state)
{
    (void)state;
    uint32_t width, height;
    uint8_t *read;
    if (!png_read_memory(grey_jpeg, sizeof grey_jpeg, "texture 3", &width, &height, &read, error, sizeof error))
        fail_msg("%s", error);
    assert_int_equal(width, 8);
    assert_int_equal(height, 8);
    for (int i = 0; i < 64; i++) {
        assert_in_range(read[i * 4 + 1], 199, 201);
        assert_int_equal(read[i * 4 + 3], 255);
    }
    free(read);
}

static void assert_unreadable(const void *data, size_t size, const char *reason)
{
    uint32_t width, height;
    uint8_t *read;
    assert_false(png_read_memory(data, size, "texture 3", &width, &height, &read, error, sizeof error));
    assert_error("texture 3", reason);
    assert_null(read);
    assert_int_equal(width, 0);
}

static void what_is_no_picture_is_refused(void **state)
{
    (void)state;
    assert_unreadable("", 0, "empty");
    assert_unreadable("hello", 5, "not a PNG or JPEG");
}

static void a_cut_picture_is_refused(void **state)
{
    (void)state;
    size_t size;
    uint8_t *pixels = make_pixels(37, 21, 4);
    assert_true(png_write(in_folder("p.png"), 37, 21, 4, pixels, error, sizeof error));
    char *file = get_file(in_folder("p.png"), &size);
    assert_unreadable(file, 10, "not a PNG or JPEG");
    assert_unreadable(file, 60, "damaged");
    assert_unreadable(file, size / 2, "damaged");
    free(file);
    free(pixels);
}

static void a_missing_file_is_one_line(void **state)
{
    (void)state;
    uint32_t width, height;
    uint8_t *read;
    assert_false(png_read(in_folder("none.png"), &width, &height, &read, error, sizeof error));
    assert_error("none.png", "No such file or directory");
}

static void a_folder_is_no_picture(void **state)
{
    (void)state;
    uint32_t width, height;
    uint8_t *read;
    assert_false(png_read(folder, &width, &height, &read, error, sizeof error));
    assert_error(folder, "Is a directory");
}

static void wrong_shapes_are_refused(void **state)
{
    (void)state;
    uint8_t pixel[4] = {0};
    assert_false(png_write(in_folder("p.png"), 0, 1, 4, pixel, error, sizeof error));
    assert_error("p.png", "pixels");
    assert_false(png_write(in_folder("p.png"), 1, 1, 2, pixel, error, sizeof error));
    assert_error("p.png", "RGB");
    assert_false(png_write(in_folder("p.png"), 16384, 16384, 4, pixel, error, sizeof error));
    assert_error("p.png", "1 GiB");
    assert_int_equal(folder_entries(false), 0);
}

static void a_missing_folder_is_one_line(void **state)
{
    (void)state;
    uint8_t pixel[4] = {0};
    assert_false(png_write(in_folder("none/p.png"), 1, 1, 4, pixel, error, sizeof error));
    assert_error("none/p.png", "No such file or directory");
}

static void a_full_disk_is_one_line(void **state)
{
    (void)state;
    uint8_t pixel[4] = {0};
    assert_false(png_write("/dev/full", 1, 1, 4, pixel, error, sizeof error));
    assert_error("/dev/full", "No space left on device");
}

static void failing_in_the_middle_leaves_nothing(void **state)
{
    (void)state;
    uint8_t *pixels = make_pixels(100, 100, 4);
    limit_files(1000);
    bool ok = png_write(in_folder("p.png"), 100, 100, 4, pixels, error, sizeof error);
    unlimit_files();
    assert_false(ok);
    assert_error("p.png", "File too large");
    assert_int_equal(folder_entries(false), 0);
    free(pixels);
}

/* ---- numbers */

enum { GREY = 0, RGB = 2, PALETTE = 3, GREY_ALPHA = 4 };

static void put_word(uint8_t *to, size_t word)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(word >> (24 - 8 * i));
}

static void put_chunk(FILE *file, const char *name, const uint8_t *data, size_t size)
{
    uint8_t chunk[2048], word[4];
    assert_true(size + 4 <= sizeof chunk);
    memcpy(chunk, name, 4);
    memcpy(chunk + 4, data, size);
    put_word(word, size);
    fwrite(word, 1, 4, file);
    fwrite(chunk, 1, size + 4, file);
    put_word(word, crc32(0, chunk, (uInt)(size + 4)));
    fwrite(word, 1, 4, file);
}

/* Rows as they stand in the file, each behind a 0 that says it is unfiltered. Palettes are all white, and half clear in
 * their first entry. */
static void put_png(uint8_t depth, uint8_t color, uint32_t width, uint32_t height, const uint8_t *rows, size_t size)
{
    uint8_t head[13] = {0}, packed[1024], white[768];
    uLongf packed_size = sizeof packed;
    FILE *file = fopen(in_folder("p.png"), "wb");
    assert_non_null(file);
    put_word(head, width);
    put_word(head + 4, height);
    head[8] = depth;
    head[9] = color;
    memset(white, 0xff, sizeof white);
    assert_int_equal(compress(packed, &packed_size, rows, size), Z_OK);
    fwrite("\x89PNG\r\n\x1a\n", 1, 8, file);
    put_chunk(file, "IHDR", head, sizeof head);
    if (color == PALETTE) {
        put_chunk(file, "PLTE", white, (size_t)3 << depth);
        put_chunk(file, "tRNS", (const uint8_t *)"\x7f", 1);
    }
    put_chunk(file, "IDAT", packed, packed_size);
    put_chunk(file, "IEND", NULL, 0);
    assert_int_equal(fclose(file), 0);
}

static void expect_numbers(uint32_t columns, uint32_t rows, const uint8_t *expected)
{
    uint32_t width, height;
    uint8_t *numbers;
    if (!png_read_numbers(in_folder("p.png"), &width, &height, &numbers, error, sizeof error))
        fail_msg("%s", error);
    assert_int_equal(width, columns);
    assert_int_equal(height, rows);
    assert_memory_equal(numbers, expected, (size_t)columns * rows);
    free(numbers);
}

static void entries_of_a_palette_are_numbers(void **state)
{
    (void)state;
    static const uint8_t bytes[] = {0, 0, 7, 255, 0, 1, 128, 2}, bits[] = {0, 0xa0};
    static const uint8_t pairs[] = {0, 0xe4}, halves[] = {0, 0x1f, 0x20};
    put_png(8, PALETTE, 3, 2, bytes, sizeof bytes);
    expect_numbers(3, 2, (const uint8_t[]){0, 7, 255, 1, 128, 2});
    put_png(1, PALETTE, 3, 1, bits, sizeof bits);
    expect_numbers(3, 1, (const uint8_t[]){1, 0, 1});
    put_png(2, PALETTE, 4, 1, pairs, sizeof pairs);
    expect_numbers(4, 1, (const uint8_t[]){3, 2, 1, 0});
    put_png(4, PALETTE, 3, 1, halves, sizeof halves);
    expect_numbers(3, 1, (const uint8_t[]){1, 15, 2});
}

static void first_channels_are_numbers(void **state)
{
    (void)state;
    static const uint8_t grey[] = {0, 3, 255}, both[] = {0, 3, 0, 200, 9}, rgb[] = {0, 5, 90, 200, 6, 91, 201};
    put_png(8, GREY, 2, 1, grey, sizeof grey);
    expect_numbers(2, 1, (const uint8_t[]){3, 255});
    put_png(8, GREY_ALPHA, 2, 1, both, sizeof both);
    expect_numbers(2, 1, (const uint8_t[]){3, 200});
    put_png(8, RGB, 2, 1, rgb, sizeof rgb);
    expect_numbers(2, 1, (const uint8_t[]){5, 6});
}

static void assert_no_numbers(const char *reason)
{
    uint32_t width, height;
    uint8_t *numbers;
    assert_false(png_read_numbers(in_folder("p.png"), &width, &height, &numbers, error, sizeof error));
    assert_error("p.png", reason);
    assert_null(numbers);
    assert_int_equal(width, 0);
}

static void what_has_no_numbers_is_refused(void **state)
{
    (void)state;
    static const uint8_t wide[] = {0, 0, 3, 0, 255}, bytes[] = {0, 1, 2, 3};
    size_t size;
    put_png(16, GREY, 2, 1, wide, sizeof wide);
    assert_no_numbers("expected 8 bits a channel, got 16");
    put_file(in_folder("p.png"), grey_jpeg, sizeof grey_jpeg);
    assert_no_numbers("not a PNG picture");
    put_file(in_folder("p.png"), "", 0);
    assert_no_numbers("not a PNG picture");
    put_png(8, PALETTE, 3, 1, bytes, sizeof bytes);
    char *file = get_file(in_folder("p.png"), &size);
    for (size_t cut = 0; cut < size - 8; cut++) {
        put_file(in_folder("p.png"), file, cut);
        assert_no_numbers("cannot read");
    }
    free(file);
    unlink(in_folder("p.png"));
    assert_no_numbers("No such file or directory");
}

static void no_tone_curve_falls(void **state)
{
    (void)state;
    for (png_curve curve = PNG_CURVE_SHOULDER; curve <= PNG_CURVE_NONE; curve++) {
        float before = -1.0f;
        for (int i = 0; i <= 10000; i++) {
            float tone = png_tone(curve, (float)i * 0.001f);
            assert_true(tone >= before && tone <= 1.0f);
            before = tone;
        }
        assert_true(png_tone(curve, 0.0f) == 0.0f && png_tone(curve, -1.0f) == 0.0f && png_tone(curve, NAN) == 0.0f);
        assert_true(png_tone(curve, INFINITY) == 1.0f);
    }
    assert_true(png_tone(PNG_CURVE_SHOULDER, 8.0f) == 1.0f);
    assert_true(png_tone(PNG_CURVE_NONE, 0.7f) == 0.7f);
}

static void the_shoulder_keeps_mid_tones(void **state)
{
    (void)state;
    const png_curve curve = PNG_CURVE_SHOULDER;
    assert_true(png_tone(curve, 0.18f) == 0.18f);
    /* no kink where the shoulder begins: the slopes on both sides agree within 1 % */
    float below = (png_tone(curve, 0.6f) - png_tone(curve, 0.599f)) / 0.001f;
    float above = (png_tone(curve, 0.601f) - png_tone(curve, 0.6f)) / 0.001f;
    assert_true(fabsf(above / below - 1.0f) < 0.01f);
}

/* The rational function in double precision, with its exposure. */
static void the_filmic_curve_is_the_fit_of_its_paper(void **state)
{
    (void)state;
    for (int i = 1; i < 200; i++) {
        const double light = 0.02 * i, x = 0.6 * light;
        const double expected = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
        assert_true(fabs((double)png_tone(PNG_CURVE_FILMIC, (float)light) - fmin(expected, 1)) < 1e-6);
    }
    assert_true(fabsf(png_tone(PNG_CURVE_FILMIC, 0.18f) - 0.140f) < 0.0005f);
}

static void light_becomes_srgb_bytes(void **state)
{
    (void)state;
    const float light[4 * 4] = {0.0f, 0.18f, 0.5f, 1.0f, 8.0f, 1000.0f, INFINITY, 0.0f, -1.0f, NAN, 0.002f, 1.0f};
    uint8_t rgb[9];
    png_from_linear(light, 3, 0.0f, PNG_CURVE_SHOULDER, rgb);
    /* sRGB of 0.18 is 117.7, of 0.5 is 187.5, of 0.002 is 6.6 (IEC 61966-2-1) */
    const uint8_t expected[9] = {0, 118, 188, 255, 255, 255, 0, 0, 7};
    for (int i = 0; i < 9; i++)
        assert_int_equal(rgb[i], expected[i]);
}

static void exposure_is_in_stops(void **state)
{
    (void)state;
    const float dim[4] = {0.05f, 0.1f, 0.125f, 1.0f}, bright[4] = {0.2f, 0.4f, 0.5f, 1.0f};
    uint8_t one[3], other[3];
    png_from_linear(dim, 1, 2.0f, PNG_CURVE_SHOULDER, one);
    png_from_linear(bright, 1, 0.0f, PNG_CURVE_SHOULDER, other);
    assert_memory_equal(one, other, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(rgba_comes_back),
        TEST_IN_FOLDER(rgb_comes_back_opaque),
        TEST_IN_FOLDER(jpeg_is_read_from_memory),
        TEST_IN_FOLDER(what_is_no_picture_is_refused),
        TEST_IN_FOLDER(a_cut_picture_is_refused),
        TEST_IN_FOLDER(a_missing_file_is_one_line),
        TEST_IN_FOLDER(a_folder_is_no_picture),
        TEST_IN_FOLDER(wrong_shapes_are_refused),
        TEST_IN_FOLDER(a_missing_folder_is_one_line),
        TEST_IN_FOLDER(a_full_disk_is_one_line),
        TEST_IN_FOLDER(failing_in_the_middle_leaves_nothing),
        TEST_IN_FOLDER(entries_of_a_palette_are_numbers),
        TEST_IN_FOLDER(first_channels_are_numbers),
        TEST_IN_FOLDER(what_has_no_numbers_is_refused),
        TEST_IN_FOLDER(no_tone_curve_falls),
        TEST_IN_FOLDER(the_shoulder_keeps_mid_tones),
        TEST_IN_FOLDER(the_filmic_curve_is_the_fit_of_its_paper),
        TEST_IN_FOLDER(light_becomes_srgb_bytes),
        TEST_IN_FOLDER(exposure_is_in_stops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
