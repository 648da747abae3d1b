/* test_exr.c - OpenEXR frames written and read back, and what is said where that cannot be. */
#include "check_io.h"
#include "exr.h"
#include "make_exr.h"

#include <math.h>
#include <openexr.h>
#include <zlib.h>

static const exr_packing packings[] = {EXR_PACKING_ZIP, EXR_PACKING_ZIPS, EXR_PACKING_RLE, EXR_PACKING_PIZ,
                                       EXR_PACKING_NONE};

/* A frame of four interleaved floats per pixel and ids, with noise in some parts and none in others. */
typedef struct picture {
    uint32_t width, height;
    float *rgbz;
    uint32_t *ids;
} picture;

static picture make_picture(uint32_t width, uint32_t height)
{
    uint64_t seed = 5;
    size_t pixels = (size_t)width * height;
    picture made = {width, height, malloc(pixels * 16), malloc(pixels * 4)};
    for (size_t i = 0; i < pixels; i++) {
        for (size_t c = 0; c < 4; c++) /* quarters are halves too; the lower bits of Z are noise */
            made.rgbz[i * 4 + c] = c < 3 ? 0.25f * (float)(random_bits(&seed) % 64) : 1e-3f * (float)random_bits(&seed);
        made.ids[i] = i % 7 ? 0 : random_bits(&seed);
    }
    return made;
}

static void free_picture(picture *made)
{
    free(made->rgbz);
    free(made->ids);
}

static bool write_picture(const char *path, const picture *made, exr_packing packing)
{
    const exr_channel channels[] = {
        {.name = "rain.R", .type = EXR_SAMPLE_HALF, .data = made->rgbz, .stride = 16},
        {.name = "Z", .type = EXR_SAMPLE_FLOAT, .data = made->rgbz + 3, .stride = 16},
        {.name = "R", .type = EXR_SAMPLE_HALF, .data = made->rgbz + 1, .stride = 16},
        {.name = "id.Y", .type = EXR_SAMPLE_UINT, .data = made->ids},
        {.name = "G", .type = EXR_SAMPLE_FLOAT, .data = made->rgbz + 2, .stride = 16},
    };
    const exr_frame frame = {.width = made->width,
                             .height = made->height,
                             .channels = channels,
                             .channel_count = COUNT(channels),
                             .packing = packing};
    return exr_write(path, &frame, error, sizeof error);
}

static void assert_picture(const char *path, const picture *made)
{
    uint32_t width, height;
    exr_request requests[] = {{"R", EXR_SAMPLE_FLOAT, NULL},
                              {"rain.R", EXR_SAMPLE_FLOAT, NULL},
                              {"Z", EXR_SAMPLE_FLOAT, NULL},
                              {"id.Y", EXR_SAMPLE_UINT, NULL}};
    if (!exr_read_channels(path, &width, &height, requests, COUNT(requests), error, sizeof error))
        fail_msg("%s", error);
    assert_int_equal(width, made->width);
    assert_int_equal(height, made->height);
    const float *r = requests[0].data, *rain = requests[1].data, *z = requests[2].data;
    for (size_t i = 0; i < (size_t)width * height; i++)
        assert_true(r[i] == made->rgbz[i * 4 + 1] && rain[i] == made->rgbz[i * 4] && z[i] == made->rgbz[i * 4 + 3]);
    assert_memory_equal(requests[3].data, made->ids, (size_t)width * height * 4);
    for (size_t i = 0; i < COUNT(requests); i++)
        free(requests[i].data);
}

static void every_packing_comes_back(void **state)
{
    (void)state;
    picture made = make_picture(97, 53);
    for (size_t i = 0; i < COUNT(packings); i++) {
        if (!write_picture(in_folder("f.exr"), &made, packings[i]))
            fail_msg("%s", error);
        assert_picture(in_folder("f.exr"), &made);
    }
    assert_int_equal(folder_entries(false), 1);
    free_picture(&made);
}

static void large_frames_come_back(void **state)
{
    (void)state;
    picture made = make_picture(640, 361); /* large enough for two threads; the last chunk is short */
    for (size_t i = 0; i < COUNT(packings); i++) {
        assert_true(write_picture(in_folder("f.exr"), &made, packings[i]));
        assert_picture(in_folder("f.exr"), &made);
    }
    free_picture(&made);
}

static void the_smallest_frame_comes_back(void **state)
{
    (void)state;
    picture made = make_picture(1, 1);
    assert_true(write_picture(in_folder("f.exr"), &made, EXR_PACKING_ZIP));
    assert_picture(in_folder("f.exr"), &made);
    free_picture(&made);
}

static void the_same_frame_has_the_same_bytes(void **state)
{
    (void)state;
    size_t one, other;
    picture made = make_picture(640, 361);
    assert_true(write_picture(in_folder("a.exr"), &made, EXR_PACKING_ZIP));
    assert_true(write_picture(in_folder("b.exr"), &made, EXR_PACKING_ZIP));
    char *a = get_file(in_folder("a.exr"), &one), *b = get_file(in_folder("b.exr"), &other);
    assert_int_equal(one, other);
    assert_memory_equal(a, b, one);
    free(a);
    free(b);
    free_picture(&made);
}

/* One channel alone. */
static bool write_channel(const char *name, exr_sample type, const void *data, uint32_t width, uint32_t height,
                          exr_packing packing)
{
    const exr_channel channel = {.name = name, .type = type, .data = data};
    const exr_frame frame = {
        .width = width, .height = height, .channels = &channel, .channel_count = 1, .packing = packing};
    return exr_write(in_folder("f.exr"), &frame, error, sizeof error);
}

static void *read_channel(const char *name, exr_sample type)
{
    uint32_t width, height;
    exr_request request = {name, type, NULL};
    if (!exr_read_channels(in_folder("f.exr"), &width, &height, &request, 1, error, sizeof error))
        fail_msg("%s", error);
    return request.data;
}

static void halves_are_rounded_to_even_and_kept_finite(void **state)
{
    (void)state;
    static const float in[] = {1.0f + 0x1p-11f, 1.0f + 0x3p-11f, 65519.0f,  65520.0f,  1e30f,
                               -1e30f,          INFINITY,        -INFINITY, NAN,       0x1p-24f,
                               0x1p-25f,        0x3p-25f,        -0.0f,     0x1.004p0f};
    static const float out[] = {1.0f,      1.0f + 0x1p-9f, 65504.0f, 65504.0f, 65504.0f, -65504.0f, 65504.0f,
                                -65504.0f, 0.0f,           0x1p-24f, 0.0f,     0x1p-23f, -0.0f,     0x1.004p0f};
    assert_true(write_channel("R", EXR_SAMPLE_HALF, in, COUNT(in), 1, EXR_PACKING_ZIP));
    float *read = read_channel("R", EXR_SAMPLE_FLOAT);
    for (size_t i = 0; i < COUNT(in); i++)
        if (read[i] != out[i] || signbit(read[i]) != signbit(out[i]))
            fail_msg("%a was read as %a, expected %a", (double)in[i], (double)read[i], (double)out[i]);
    free(read);
}

static void floats_keep_their_bits(void **state)
{
    (void)state;
    static const uint32_t bits[] = {0x7F800000u, 0xFF800000u, 0x7FC01234u, 1u, 0x80000000u, 0x7F7FFFFFu};
    assert_true(write_channel("Z", EXR_SAMPLE_FLOAT, bits, COUNT(bits), 1, EXR_PACKING_ZIP));
    float *read = read_channel("Z", EXR_SAMPLE_FLOAT);
    assert_memory_equal(read, bits, sizeof bits);
    free(read);
}

/* Size of `raw` as ZIP packs it: bytes at even offsets before those at odd ones, each less its neighbour, deflated. */
static size_t zip_size(const uint8_t *raw, size_t size, uint8_t *apart, uint8_t *packed)
{
    size_t first = (size + 1) / 2;
    for (size_t i = 0; i < size; i++)
        apart[i % 2 ? first + i / 2 : i / 2] = raw[i];
    for (size_t i = size - 1; i > 0; i--)
        apart[i] = (uint8_t)(apart[i] - apart[i - 1] + 128);
    uLongf packed_size = compressBound(size);
    assert_int_equal(compress2(packed, &packed_size, apart, size, 4), Z_OK);
    return packed_size;
}

/* Noise with just so much order in it that packing neither gains nor loses a byte: the calm part grows while packing
 * loses and shrinks while it gains, with new noise each time. */
static void make_stubborn(uint8_t *raw, size_t size, uint64_t *seed)
{
    uint8_t *apart = malloc(size), *packed = malloc(compressBound(size));
    size_t calm = 0, packed_size = 0;
    for (int tries = 0; tries < 5000 && packed_size != size; tries++) {
        for (size_t i = 0; i < size; i++)
            raw[i] = i < calm && i % 2 ? 0x40 : (uint8_t)random_bits(seed);
        packed_size = zip_size(raw, size, apart, packed);
        if (packed_size > size)
            calm += 2;
        else if (calm)
            calm -= 2;
    }
    free(apart);
    free(packed);
    assert_int_equal(packed_size, size);
}

static void assert_stubborn(exr_packing packing, uint32_t lines_per_chunk)
{
    enum { WIDTH = 64, HEIGHT = 64 };
    static uint8_t raw[WIDTH * HEIGHT * 4];
    uint64_t seed = 11;
    size_t chunk = WIDTH * 4 * lines_per_chunk;
    for (size_t at = 0; at < sizeof raw; at += chunk)
        make_stubborn(raw + at, chunk, &seed);
    assert_true(write_channel("Z", EXR_SAMPLE_FLOAT, raw, WIDTH, HEIGHT, packing));
    float *read = read_channel("Z", EXR_SAMPLE_FLOAT);
    assert_memory_equal(read, raw, sizeof raw);
    free(read);
}

static void lines_that_pack_to_their_own_size_come_back(void **state)
{
    (void)state;
    assert_stubborn(EXR_PACKING_ZIPS, 1);
}

static void chunks_that_pack_to_their_own_size_come_back(void **state)
{
    (void)state;
    assert_stubborn(EXR_PACKING_ZIP, 16);
}

/* Between noise and order every packing meets chunks near their own size. */
static void every_mixture_of_noise_comes_back(void **state)
{
    (void)state;
    enum { WIDTH = 48, HEIGHT = 512 };
    static uint8_t raw[WIDTH * HEIGHT * 4];
    uint64_t seed = 3;
    for (size_t y = 0; y < HEIGHT; y++)
        for (size_t i = 0; i < WIDTH * 4; i++)
            raw[y * WIDTH * 4 + i] = random_bits(&seed) % HEIGHT < y ? 0 : (uint8_t)random_bits(&seed);
    for (size_t i = 0; i < COUNT(packings); i++) {
        assert_true(write_channel("id.Y", EXR_SAMPLE_UINT, raw, WIDTH, HEIGHT, packings[i]));
        uint32_t *read = read_channel("id.Y", EXR_SAMPLE_UINT);
        assert_memory_equal(read, raw, sizeof raw);
        free(read);
    }
}

static const exr_attribute attributes[] = {
    {"worldToCamera", EXR_ATTRIBUTE_M44F, {.m44f = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}}},
    {"framesPerSecond", EXR_ATTRIBUTE_RATIONAL, {.rational = {24000, 1001}}},
    {"seed", EXR_ATTRIBUTE_INT, {.integer = -7}},
    {"time", EXR_ATTRIBUTE_DOUBLE, {.real64 = 0.1}},
    {"rate", EXR_ATTRIBUTE_FLOAT, {.real = 25.5f}},
    {"device", EXR_ATTRIBUTE_STRING, {.string = "a \xC3\xA9 device"}},
    {"empty", EXR_ATTRIBUTE_STRING, {.string = ""}},
};

static bool write_attributes(const exr_attribute *list, uint32_t count)
{
    static const float pixel;
    const exr_channel channel = {.name = "Y", .type = EXR_SAMPLE_FLOAT, .data = &pixel};
    const exr_frame frame = {.width = 1,
                             .height = 1,
                             .channels = &channel,
                             .channel_count = 1,
                             .attributes = list,
                             .attribute_count = count};
    return exr_write(in_folder("f.exr"), &frame, error, sizeof error);
}

static exr_context_t open_core(const char *path)
{
    exr_context_t file = NULL;
    assert_int_equal(exr_start_read(&file, path, NULL), EXR_ERR_SUCCESS);
    return file;
}

static void attributes_come_back(void **state)
{
    (void)state;
    exr_attr_m44f_t matrix;
    exr_attr_rational_t fps;
    int32_t seed, length;
    double time;
    float rate;
    const char *text;
    if (!write_attributes(attributes, COUNT(attributes)))
        fail_msg("%s", error);
    exr_context_t file = open_core(in_folder("f.exr"));
    assert_int_equal(exr_attr_get_m44f(file, 0, "worldToCamera", &matrix), EXR_ERR_SUCCESS);
    assert_memory_equal(matrix.m, attributes[0].m44f, sizeof matrix.m);
    assert_int_equal(exr_attr_get_rational(file, 0, "framesPerSecond", &fps), EXR_ERR_SUCCESS);
    assert_true(fps.num == 24000 && fps.denom == 1001);
    assert_int_equal(exr_attr_get_int(file, 0, "seed", &seed), EXR_ERR_SUCCESS);
    assert_int_equal(seed, -7);
    assert_int_equal(exr_attr_get_double(file, 0, "time", &time), EXR_ERR_SUCCESS);
    assert_true(time == 0.1);
    assert_int_equal(exr_attr_get_float(file, 0, "rate", &rate), EXR_ERR_SUCCESS);
    assert_true(rate == 25.5f);
    assert_int_equal(exr_attr_get_string(file, 0, "device", &length, &text), EXR_ERR_SUCCESS);
    assert_string_equal(text, "a \xC3\xA9 device");
    assert_int_equal(exr_attr_get_string(file, 0, "empty", &length, &text), EXR_ERR_SUCCESS);
    assert_int_equal(length, 0);
    exr_finish(&file);
}

static void any_seed_comes_back(void **state)
{
    (void)state;
    static const uint32_t seeds[] = {0, 1, INT32_MAX, (uint32_t)INT32_MAX + 1, 4000000000, UINT32_MAX};
    for (size_t i = 0; i < COUNT(seeds); i++) {
        char digits[EXR_UINT_DIGITS], expected[16];
        exr_header header;
        exr_text seed = {.name = "seed"};
        const exr_attribute one = exr_attribute_uint("seed", seeds[i], digits);
        assert_int_equal(one.kind, seeds[i] > INT32_MAX ? EXR_ATTRIBUTE_STRING : EXR_ATTRIBUTE_INT);
        assert_true(write_attributes(&one, 1));
        if (!exr_read_header(in_folder("f.exr"), &header, &seed, 1, error, sizeof error))
            fail_msg("%s", error);
        snprintf(expected, sizeof expected, "%u", seeds[i]);
        assert_string_equal(seed.text, expected);
    }
}

static void a_header_is_read_without_pixels(void **state)
{
    (void)state;
    picture made = make_picture(97, 53);
    exr_header header;
    exr_text texts[] = {{.name = "seed"}, {.name = "time"}, {.name = "none"}};
    assert_true(write_picture(in_folder("f.exr"), &made, EXR_PACKING_ZIP));
    assert_true(exr_read_header(in_folder("f.exr"), &header, NULL, 0, error, sizeof error));
    assert_int_equal(header.width, 97);
    assert_int_equal(header.height, 53);
    assert_string_equal(header.channels, ",G,R,Z,id.Y,rain.R,");
    /* what is there but neither text nor a whole number counts as absent */
    assert_true(write_attributes(attributes, COUNT(attributes)));
    memset(texts[1].text, 'x', sizeof texts[1].text);
    assert_true(exr_read_header(in_folder("f.exr"), &header, texts, COUNT(texts), error, sizeof error));
    assert_string_not_equal(texts[0].text, "");
    assert_string_equal(texts[1].text, "");
    assert_string_equal(texts[2].text, "");
    free_picture(&made);
}

static void headers_of_broken_pictures_are_refused(void **state)
{
    (void)state;
    size_t size;
    exr_header header;
    picture made = make_picture(64, 64);
    assert_true(write_picture(in_folder("f.exr"), &made, EXR_PACKING_ZIP));
    char *whole = get_file(in_folder("f.exr"), &size);
    for (size_t length = 0; length < 400; length += 9) { /* within the header */
        put_file(in_folder("cut.exr"), whole, length);
        assert_false(exr_read_header(in_folder("cut.exr"), &header, NULL, 0, error, sizeof error));
        assert_error("cannot read", "cut.exr");
    }
    exr_recipe recipe = {.width = 8, .height = 64, .rows = 40, .channels = "RGB", .samples = made.rgbz};
    assert_true(make_exr(in_folder("part.exr"), &recipe));
    assert_false(exr_read_header(in_folder("part.exr"), &header, NULL, 0, error, sizeof error));
    assert_error("part.exr", "incomplete");
    free(whole);
    free_picture(&made);
}

static void the_header_is_as_designed(void **state)
{
    (void)state;
    static const char *const names[] = {"G", "R", "Z", "id.Y", "rain.R"};
    static const exr_pixel_type_t types[] = {EXR_PIXEL_FLOAT, EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, EXR_PIXEL_UINT,
                                             EXR_PIXEL_HALF};
    picture made = make_picture(20, 10);
    const exr_attr_chlist_t *channels;
    exr_attr_box2i_t data, display;
    exr_compression_t compression;
    assert_true(write_picture(in_folder("f.exr"), &made, EXR_PACKING_ZIP));
    exr_context_t file = open_core(in_folder("f.exr"));
    exr_get_channels(file, 0, &channels);
    exr_get_data_window(file, 0, &data);
    exr_get_display_window(file, 0, &display);
    exr_get_compression(file, 0, &compression);
    assert_int_equal(compression, EXR_COMPRESSION_ZIP);
    assert_int_equal(channels->num_channels, COUNT(names));
    for (size_t i = 0; i < COUNT(names); i++) {
        assert_string_equal(channels->entries[i].name.str, names[i]);
        assert_int_equal(channels->entries[i].pixel_type, types[i]);
    }
    assert_true(data.min.x == 0 && data.min.y == 0 && data.max.x == 19 && data.max.y == 9);
    assert_memory_equal(&data, &display, sizeof data);
    exr_finish(&file);
    free_picture(&made);
}

static void wrong_attributes_are_refused(void **state)
{
    (void)state;
    const struct {
        exr_attribute list[2];
        const char *reason;
    } wrong[] = {
        {{{"anAttributeWithThirtyTwoLetters_", EXR_ATTRIBUTE_INT, {0}}, {"b", EXR_ATTRIBUTE_INT, {0}}}, "at most 31"},
        {{{"", EXR_ATTRIBUTE_INT, {0}}, {"b", EXR_ATTRIBUTE_INT, {0}}}, "no name"},
        {{{"a", EXR_ATTRIBUTE_STRING, {0}}, {"b", EXR_ATTRIBUTE_INT, {0}}}, "no text"},
        {{{"b", EXR_ATTRIBUTE_FLOAT, {0}}, {"b", EXR_ATTRIBUTE_INT, {0}}}, "twice"},
        {{{"a", EXR_ATTRIBUTE_FLOAT, {0}}, {"dataWindow", EXR_ATTRIBUTE_INT, {0}}}, "'dataWindow'"},
    };
    for (size_t i = 0; i < COUNT(wrong); i++) {
        assert_false(write_attributes(wrong[i].list, 2));
        assert_error("f.exr", wrong[i].reason);
    }
    assert_int_equal(folder_entries(false), 0);
}

static void a_name_of_31_bytes_is_fine(void **state)
{
    (void)state;
    const exr_attribute one = {"anAttributeWithThirtyOneLetters", EXR_ATTRIBUTE_INT, {0}};
    assert_int_equal(strlen(one.name), EXR_MAX_NAME);
    assert_true(write_attributes(&one, 1));
}

static void wrong_frames_are_refused(void **state)
{
    (void)state;
    static const float pixel;
    const exr_channel good[] = {{.name = "Y", .data = &pixel}, {.name = "Y", .data = &pixel}};
    const exr_channel none = {.name = "Y"},
                      longer = {.name = "layer.with.a.name.of.forty.bytes.in.all.R", .data = &pixel};
    const struct {
        exr_frame frame;
        const char *reason;
    } wrong[] = {
        {{.width = 0, .height = 1, .channels = good, .channel_count = 1}, "0 x 1 pixels"},
        {{.width = 1, .height = 20000, .channels = good, .channel_count = 1}, "1 x 20000 pixels"},
        {{.width = 1, .height = 1, .channels = good, .channel_count = 0}, "no channels"},
        {{.width = 1, .height = 1, .channels = good, .channel_count = 2}, "twice"},
        {{.width = 1, .height = 1, .channels = &none, .channel_count = 1}, "no samples"},
        {{.width = 1, .height = 1, .channels = &longer, .channel_count = 1}, "at most 31"},
    };
    for (size_t i = 0; i < COUNT(wrong); i++) {
        assert_false(exr_write(in_folder("f.exr"), &wrong[i].frame, error, sizeof error));
        assert_error("f.exr", wrong[i].reason);
    }
    assert_int_equal(folder_entries(false), 0);
}

static void a_missing_folder_is_one_line(void **state)
{
    (void)state;
    picture made = make_picture(4, 4);
    assert_false(write_picture(in_folder("none/f.exr"), &made, EXR_PACKING_ZIP));
    assert_error("none/f.exr", "No such file or directory");
    free_picture(&made);
}

static void a_folder_without_permission_is_one_line(void **state)
{
    (void)state;
    if (geteuid() == 0)
        skip(); /* the superuser may write everywhere */
    picture made = make_picture(4, 4);
    assert_int_equal(chmod(folder, 0500), 0);
    assert_false(write_picture(in_folder("f.exr"), &made, EXR_PACKING_ZIP));
    assert_error("f.exr", "Permission denied");
    chmod(folder, 0700);
    free_picture(&made);
}

static void a_full_disk_is_one_line(void **state)
{
    (void)state;
    picture made = make_picture(4, 4);
    assert_false(write_picture("/dev/full", &made, EXR_PACKING_ZIP));
    assert_error("/dev/full", "No space left on device");
    free_picture(&made);
}

static void failing_in_the_middle_leaves_the_old_file(void **state)
{
    (void)state;
    size_t size;
    picture made = make_picture(640, 361);
    put_file(in_folder("f.exr"), "old", 3);
    limit_files(200000);
    bool ok = write_picture(in_folder("f.exr"), &made, EXR_PACKING_ZIP);
    unlimit_files();
    assert_false(ok);
    assert_error("f.exr", "File too large");
    assert_int_equal(folder_entries(false), 1);
    char *text = get_file(in_folder("f.exr"), &size);
    assert_string_equal(text, "old");
    free(text);
    free_picture(&made);
}

static void wrong_requests_are_refused(void **state)
{
    (void)state;
    uint32_t width, height;
    static const float pixel;
    exr_request absent[] = {{"Y", EXR_SAMPLE_FLOAT, NULL}, {"rain.R", EXR_SAMPLE_FLOAT, NULL}};
    exr_request whole = {"Y", EXR_SAMPLE_UINT, NULL};
    assert_true(write_channel("Y", EXR_SAMPLE_FLOAT, &pixel, 1, 1, EXR_PACKING_ZIP));
    assert_false(exr_read_channels(in_folder("f.exr"), &width, &height, absent, 2, error, sizeof error));
    assert_error("f.exr", "missing channel rain.R (the file has Y)");
    assert_null(absent[0].data);
    assert_false(exr_read_channels(in_folder("f.exr"), &width, &height, &whole, 1, error, sizeof error));
    assert_error("f.exr", "no whole numbers");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(every_packing_comes_back),
        TEST_IN_FOLDER(large_frames_come_back),
        TEST_IN_FOLDER(the_smallest_frame_comes_back),
        TEST_IN_FOLDER(the_same_frame_has_the_same_bytes),
        TEST_IN_FOLDER(halves_are_rounded_to_even_and_kept_finite),
        TEST_IN_FOLDER(floats_keep_their_bits),
        TEST_IN_FOLDER(lines_that_pack_to_their_own_size_come_back),
        TEST_IN_FOLDER(chunks_that_pack_to_their_own_size_come_back),
        TEST_IN_FOLDER(every_mixture_of_noise_comes_back),
        TEST_IN_FOLDER(attributes_come_back),
        TEST_IN_FOLDER(any_seed_comes_back),
        TEST_IN_FOLDER(a_header_is_read_without_pixels),
        TEST_IN_FOLDER(headers_of_broken_pictures_are_refused),
        TEST_IN_FOLDER(the_header_is_as_designed),
        TEST_IN_FOLDER(wrong_attributes_are_refused),
        TEST_IN_FOLDER(a_name_of_31_bytes_is_fine),
        TEST_IN_FOLDER(wrong_frames_are_refused),
        TEST_IN_FOLDER(a_missing_folder_is_one_line),
        TEST_IN_FOLDER(a_folder_without_permission_is_one_line),
        TEST_IN_FOLDER(a_full_disk_is_one_line),
        TEST_IN_FOLDER(failing_in_the_middle_leaves_the_old_file),
        TEST_IN_FOLDER(wrong_requests_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
