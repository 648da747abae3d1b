/* Running water: how fast it is, what waves it has by that, and that they are carried along. */
#include "ground_fixture.h"

#include "ground/stream_table.h"

#include <math.h>

#define TEXELS 256
#define TEXEL  0.004
#define TAU    6.28318530717958647692

static ground_fixture f;
static host_buffer picture, records;

static const double lengths_m[VIRGA_STREAM_OCTAVES] = {VIRGA_STREAM_WAVE_LIST};

/* A plane that falls by `fall` along x, under `mm` of water. The ripple map is a metre around the origin. */
static void begin(double fall, double mm, float stream_waves)
{
    const float low = (float)(-3.2 * fall), high = (float)(3.2 * fall);
    const float plane[1][4][3] = {{{-3.2f, high, -3.2f}, {3.2f, low, -3.2f}, {3.2f, low, 3.2f}, {-3.2f, high, 3.2f}}};
    virga_ground_def def = virga_default_ground_def();
    def.cells = 128;
    def.cached_tiles = 0;
    def.max_impacts = MAX_DROPS;
    def.ripple_texels = TEXELS;
    def.ripple_texel_m = (float)TEXEL;
    ground_fixture_open(&f);
    ground_fixture_quads(&f, plane, NULL, 1);
    ground_fixture_ground(&f, &def);
    f.settings.stream_waves = stream_waves;
    f.settings.materials[VIRGA_MATERIAL_CUSTOM].manning_n = 0.015f;
    REQUIRE(virga_ground_set(f.ground, &f.settings) == VIRGA_OK);
    ground_fixture_step(&f, 0);
    virga_cell_gpu *cells = f.upload.mapped;
    for (uint32_t i = 0; i < 128 * 128; i++)
        cells[i] = (virga_cell_gpu){(uint32_t)(mm * 2.5e6), 0};
    ground_fixture_put(&f);
    REQUIRE(host_buffer_create(&f.gpu.device, TEXELS * TEXELS * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HOST_BUFFER_READBACK, "ripples", &picture, f.gpu.error, sizeof f.gpu.error));
    REQUIRE(host_buffer_create(&f.gpu.device, f.ground->rings->size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HOST_BUFFER_READBACK, "rings", &records, f.gpu.error, sizeof f.gpu.error));
}

static void run(uint32_t ticks)
{
    for (; ticks; ticks -= ticks < 16 ? ticks : 16)
        ground_fixture_step(&f, ticks < 16 ? ticks : 16);
}

static void read_back(void)
{
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {TEXELS, TEXELS, 1}};
    vkCmdCopyImageToBuffer(cmd, f.ground->ripples.map->colors[0]->image, VK_IMAGE_LAYOUT_GENERAL, picture.buffer, 1,
                           &copy);
    ground_fixture_copy(cmd, f.ground->rings->buffer, 0, records.buffer, 0, f.ground->rings->size);
    ground_fixture_submit(&f);
    host_buffer_invalidate(&f.gpu.device, &picture);
    host_buffer_invalidate(&f.gpu.device, &records);
}

static void end(void)
{
    host_buffer_destroy(&f.gpu.device, &picture);
    host_buffer_destroy(&f.gpu.device, &records);
    ground_fixture_close(&f);
}

static virga_stream_gpu stream_of(int x, int z)
{
    const size_t first = GROUND_STREAMS_OFFSET + sizeof(virga_streams_gpu);
    const virga_stream_gpu *streams = (const virga_stream_gpu *)((const char *)records.mapped + first);
    const uint32_t side = (uint32_t)sqrt((double)((f.ground->rings->size - first) / sizeof *streams));
    const virga_stream_gpu found =
        streams[((uint32_t)z + 0x80000000u) % side * side + ((uint32_t)x + 0x80000000u) % side];
    assert_int_equal(found.cell[0], x);
    assert_int_equal(found.cell[1], z);
    return found;
}

static double half_of(uint16_t half)
{
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    const double value = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return half & 0x8000 ? -value : value;
}

/* Slope along an axis of a texel of the map. */
static double slope_at(const uint16_t *map, int x, int y, int axis)
{
    return half_of(map[(y * TEXELS + x) * 2 + axis]);
}

static double variance_of(const uint16_t *map)
{
    double sum = 0;
    for (int i = 0; i < TEXELS * TEXELS; i++)
        sum += pow(slope_at(map, i % TEXELS, i / TEXELS, 0), 2) + pow(slope_at(map, i % TEXELS, i / TEXELS, 1), 2);
    return sum / (2.0 * TEXELS * TEXELS);
}

static double manning(double h, double fall)
{
    return pow(h, 2.0 / 3) * sqrt(fall) / 0.015;
}

/* Standard deviations of an octave's heights, as shaders/ground/stream.glsl derives them: of what stands still, and of
 * what is carried along. */
static void heights_of(int octave, double h, double mean_m_s, double heights[2])
{
    const double pi = TAU / 2, k = TAU / lengths_m[octave], u = mean_m_s / 0.85;
    const double omega = sqrt((9.80665 * k + 7.293e-5 * k * k * k) * tanh(k * h)), c = omega / k;
    const double bed_m = pow(21.1 * 0.015, 6), b = bed_m / 4.43;
    const double spectrum = b * b * bed_m * bed_m / (4 * pi) * exp(-k * k * bed_m * bed_m / 4);
    const double gamma = 2 * 1.004e-6 * k * k + sqrt(1.004e-6 * omega / 2) * k / sinh(2 * k * h);
    const double tangent = sqrt(fmax(u * u / (c * c) - 1, 1.0 / 9)), felt = 1 / cosh(k * h);
    const double share = fmin(fmax((u / c - 1) / 0.2, 0), 1), smooth = share * share * (3 - 2 * share);
    const double stones = log(2) * k * k * spectrum * felt * felt * pi * omega / (2 * gamma * tangent) * smooth;
    const double fall = pow(0.015 * mean_m_s, 2) / pow(h, 4.0 / 3);
    const double eddies = pow(h * fall, 2) * fmax(1 - fabs(log2(lengths_m[octave] / (5 * h))), 0);
    const double most = fmin(0.25 * h, 0.2 / k) / sqrt(VIRGA_STREAM_OCTAVES);
    const double less = fmin(most / fmax(sqrt(stones + eddies), 1e-9), 1);
    heights[0] = less * sqrt(0.667 * stones);
    heights[1] = less * sqrt(0.333 * stones + eddies);
}

/* Share of the heights that is drawn: none of waves that are not seen among the rain's. */
static double shown_of(double h, double mean_m_s)
{
    double variance = 0, heights[2];
    for (int i = 0; i < VIRGA_STREAM_OCTAVES; i++) {
        heights_of(i, h, mean_m_s, heights);
        variance += 0.5 * pow(TAU / lengths_m[i], 2) * (pow(heights[0], 2) + pow(heights[1], 2));
    }
    const double share = fmin(fmax((variance - 5e-5) / 1.5e-4, 0), 1);
    return share * share * (3 - 2 * share);
}

/* Share of an octave's heights that is drawn, by its part of the variance that the map can show: the least are left
 * out. */
static double part_of(int octave, double h, double mean_m_s)
{
    double all = 0, own = 0, heights[2];
    for (int i = 0; i < VIRGA_STREAM_OCTAVES; i++) {
        heights_of(i, h, mean_m_s, heights);
        const double k = TAU / lengths_m[i], blur = exp(-0.5 * pow(k * TEXEL / 2, 2));
        const double variance = pow(k * blur, 2) * (pow(heights[0], 2) + pow(heights[1], 2));
        all += variance;
        own = i == octave ? variance : own;
    }
    const double share = fmin(fmax((own / all - 0.02) / 0.03, 0), 1);
    return share * share * (3 - 2 * share);
}

static void check_waves(double fall, double mm)
{
    begin(fall, mm, 1);
    run(120);
    read_back();
    const virga_stream_gpu found = stream_of(2, -3);
    const double expected = manning(mm * 1e-3, fall);
    assert_float_equal(found.depth_m / (mm * 1e-3), 1, 0.01);
    assert_float_equal(found.flow[0] * 0.85 / expected, 1, 0.02);
    assert_true(fabsf(found.flow[1]) < 1e-3f * found.flow[0]);
    const double shown = shown_of((double)found.depth_m, 0.85 * (double)found.flow[0]);
    assert_true(shown > 0.02);
    for (int i = 0; i < VIRGA_STREAM_OCTAVES; i++) {
        const double blurred = shown * exp(-0.5 * pow(TAU / lengths_m[i] * TEXEL / 2, 2)) *
                               part_of(i, (double)found.depth_m, 0.85 * (double)found.flow[0]);
        double heights[2];
        /* By the speed that it has found: where water is but a little faster than the waves, a hundredth is much. */
        heights_of(i, (double)found.depth_m, 0.85 * (double)found.flow[0], heights);
        assert_float_equal(found.standing_m[i], blurred * heights[0], 0.005 * heights[0] + 1e-9);
        assert_float_equal(found.height_m[i], blurred * heights[1], 0.005 * heights[1] + 1e-9);
    }
    end();
}

static void test_water_has_the_speed_of_manning_and_the_waves_of_its_stones(void **state)
{
    (void)state;
    check_waves(0.03, 4);
}

static void test_slow_water_has_the_bumps_of_its_eddies(void **state)
{
    (void)state;
    check_waves(0.01, 3);
}

/* Each octave has half of k^2 height^2 along an axis, less what is smoothed away. A map shows some hundred waves. */
static void test_the_map_shows_the_waves(void **state)
{
    (void)state;
    begin(0.03, 4, 1);
    run(120);
    read_back();
    const virga_stream_gpu found = stream_of(0, 0);
    double expected = 0;
    for (int i = 0; i < VIRGA_STREAM_OCTAVES; i++)
        expected += 0.5 * pow(TAU / lengths_m[i], 2) *
                    (pow((double)found.height_m[i], 2) + pow((double)found.standing_m[i], 2));
    assert_true(expected > 1e-5);
    assert_float_equal(variance_of(picture.mapped) / expected, 1, 0.2);
    end();
}

/* The standard deviation of the map goes neither up nor down as layers begin and end. */
static void test_waves_do_not_pulse(void **state)
{
    (void)state;
    double least = 1e9, most = 0;
    begin(0.03, 4, 1);
    run(60);
    for (int i = 0; i < 12; i++) {
        run(8); /* a layer lasts 96 */
        read_back();
        const double now = sqrt(variance_of(picture.mapped));
        least = fmin(least, now);
        most = fmax(most, now);
    }
    assert_true(least > 0.85 * most);
    end();
}

static double correlation(const uint16_t *a, const uint16_t *b, int shift)
{
    double both = 0, own = 0, other = 0;
    for (int y = 0; y < TEXELS; y++)
        for (int x = 0; x + shift < TEXELS; x++) {
            const double p = slope_at(a, x, y, 0), q = slope_at(b, x + shift, y, 0);
            both += p * q;
            own += p * p;
            other += q * q;
        }
    return both / sqrt(own * other);
}

/* Slow water carries its bumps along as they are: after twelve ticks they are the way of the surface farther down. */
static void test_bumps_are_carried_along(void **state)
{
    (void)state;
    begin(0.01, 3, 1);
    run(110);
    read_back();
    uint16_t *before = malloc(picture.size);
    memcpy(before, picture.mapped, picture.size);
    run(12);
    read_back();
    const double way_m = manning(3e-3, 0.01) / 0.85 * 12 / 60;
    const int shift = (int)floor(way_m / TEXEL + 0.5);
    assert_true(shift >= 5);
    const double along = correlation(before, picture.mapped, shift), still = correlation(before, picture.mapped, 0);
    if (!(along > 0.85 && still < 0.6))
        fail_msg("%g of them along, %g where they were", along, still);
    free(before);
    end();
}

static void check_calm(double fall, double mm, float stream_waves)
{
    begin(fall, mm, stream_waves);
    run(60);
    read_back();
    assert_true(variance_of(picture.mapped) == 0);
    end();
}

static void test_water_at_rest_has_no_such_waves(void **state)
{
    (void)state;
    check_calm(0, 6, 1);
}

static void test_waves_that_are_not_seen_are_not_drawn(void **state)
{
    (void)state;
    check_calm(0.004, 6, 1);
}

static void test_they_can_be_left_out(void **state)
{
    (void)state;
    check_calm(0.03, 4, 0);
}

/* A drop's ring goes along with the surface. */
static void test_a_ring_is_carried_along(void **state)
{
    (void)state;
    begin(0.004, 6, 0);
    run(8);
    const uint32_t tick = f.tick;
    ground_fixture_drop(&f, 0, 0, 0, 4000)->id = 7;
    ground_fixture_step(&f, 1);
    run(15);
    read_back();
    const virga_ring_gpu *ring = (const virga_ring_gpu *)((const virga_rings_gpu *)records.mapped + 1);
    assert_int_equal(ring->tick, tick);
    assert_float_equal(ring->drift[0] * 0.85 / manning(6e-3, 0.004), 1, 0.03);
    /* Slopes are the same, but for their signs, on both sides of the middle. */
    const double way = (0.025 + (double)ring->drift[0] * 16 / 60) / TEXEL + TEXELS / 2.0;
    double apart = 0, size = 0;
    for (int i = 4; i < 24; i++) {
        const int y = TEXELS / 2 + 6;
        const double left = slope_at(picture.mapped, (int)floor(way) - i, y, 0),
                     right = slope_at(picture.mapped, (int)floor(way) + i - (way - floor(way) < 0.5), y, 0);
        apart += pow(left + right, 2);
        size += left * left + right * right;
    }
    assert_true(size > 1e-6);
    if (!(apart < 0.25 * size))
        fail_msg("the ring is not around the place that it was carried to: %g of it is apart", apart / size);
    end();
}

static double tile_slope(uint8_t byte)
{
    return (byte - 128) / 127.0 * VIRGA_STREAM_TILE_SLOPE;
}

/* The picture of waves: of one length, both surfaces of deviation 1, unlike each other, and without a seam. */
static void test_the_picture_of_waves_is_of_one_length_and_has_no_seam(void **state)
{
    (void)state;
    static uint8_t texels[VIRGA_STREAM_TILE][VIRGA_STREAM_TILE][4];
    double squares[4] = {0}, together = 0;
    stream_table_fill(texels);
    /* From its last texels to its first ones it changes as much as between any others. */
    const int last = VIRGA_STREAM_TILE - 1;
    double seam[2] = {0}, inside[2] = {0};
    for (int i = 0; i < VIRGA_STREAM_TILE; i++) {
        seam[0] += pow(tile_slope(texels[i][0][0]) - tile_slope(texels[i][last][0]), 2);
        seam[1] += pow(tile_slope(texels[0][i][0]) - tile_slope(texels[last][i][0]), 2);
        for (int k = 1; k < VIRGA_STREAM_TILE; k++) {
            inside[0] += pow(tile_slope(texels[i][k][0]) - tile_slope(texels[i][k - 1][0]), 2) / last;
            inside[1] += pow(tile_slope(texels[k][i][0]) - tile_slope(texels[k - 1][i][0]), 2) / last;
        }
    }
    for (int axis = 0; axis < 2; axis++)
        assert_true(seam[axis] < 2 * inside[axis]);
    for (int y = 0; y < VIRGA_STREAM_TILE; y++)
        for (int x = 0; x < VIRGA_STREAM_TILE; x++) {
            for (int i = 0; i < 4; i++)
                squares[i] += pow(tile_slope(texels[y][x][i]), 2) / (VIRGA_STREAM_TILE * VIRGA_STREAM_TILE);
            together +=
                tile_slope(texels[y][x][0]) * tile_slope(texels[y][x][2]) / (VIRGA_STREAM_TILE * VIRGA_STREAM_TILE);
        }
    const double number = TAU * VIRGA_STREAM_TILE_WAVES;
    for (int i = 0; i < 2; i++)
        assert_float_equal((squares[2 * i] + squares[2 * i + 1]) / (number * number), 1, 0.02);
    assert_true(fabs(together) < 0.2 * sqrt(squares[0] * squares[2]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_water_has_the_speed_of_manning_and_the_waves_of_its_stones),
        cmocka_unit_test(test_slow_water_has_the_bumps_of_its_eddies),
        cmocka_unit_test(test_the_map_shows_the_waves),
        cmocka_unit_test(test_waves_do_not_pulse),
        cmocka_unit_test(test_bumps_are_carried_along),
        cmocka_unit_test(test_water_at_rest_has_no_such_waves),
        cmocka_unit_test(test_waves_that_are_not_seen_are_not_drawn),
        cmocka_unit_test(test_they_can_be_left_out),
        cmocka_unit_test(test_a_ring_is_carried_along),
        cmocka_unit_test(test_the_picture_of_waves_is_of_one_length_and_has_no_seam),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
