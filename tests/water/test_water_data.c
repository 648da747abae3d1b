/* Thickness, normal and motion of water, against those of a ball. */
#include "water_picture_fixture.h"

#define SIDE     96
#define RADIUS   0.2
#define DISTANCE 0.8
#define FRAME_S  (1.0 / 24)

static shot s;
static double surface_m; /* radius of the ball's surface */

static double empty_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of, (void)eye, (void)direction;
    rgb[0] = rgb[1] = rgb[2] = 0.5;
    return INFINITY;
}

static void set_up(void)
{
    static const double center[3] = {0, 0, 0}, eye[3] = {0, 0, DISTANCE};
    shot_open(&s, SIDE, SIDE);
    s.scene = empty_scene;
    s.f.settings.spacing_m = (float)(RADIUS / 12);
    water_fixture_shells(&s.f, center, RADIUS, RADIUS / 12);
    for (uint32_t i = 0; i < s.f.count; i++)
        s.f.particles[i].velocity[0] = 0.5f;
    surface_m = water_reference_radius(&s.f, center, 1.2 * RADIUS);
    shot_aim(&s, eye, center);
    s.frame_interval_s = s.open_shutter_s = FRAME_S;
}

static void draw(virga_water_data what)
{
    REQUIRE(virga_water_set(s.f.water, &s.f.settings) == VIRGA_OK);
    const VkCommandBuffer cmd = effect_fixture_begin(&s.f.gpu, s.f.context);
    const virga_water_step_info info = {.particles = s.f.particle_buffer.buffer, .count = s.f.count};
    REQUIRE(virga_water_step(s.f.water, cmd, &info) == VIRGA_OK);
    const virga_view view = shot_view(&s);
    REQUIRE(virga_water_prepare(s.f.water, cmd, &view) == VIRGA_OK);
    host_target_begin_layer(&s.picture, cmd);
    REQUIRE(virga_water_draw_data(s.f.water, cmd, s.layer, what) == VIRGA_OK);
    assert_int_equal(virga_water_draw_data(s.f.water, cmd, s.layer, (virga_water_data)3), VIRGA_ERROR_INVALID);
    vkCmdEndRenderPass(cmd);
    host_target_copy_out(&s.picture, cmd, 1u << HOST_LAYER);
    effect_fixture_complete(&s.f.gpu, s.f.context);
    memcpy(s.pixels, host_target_floats(&s.f.gpu.device, &s.picture, HOST_LAYER), (size_t)SIDE * SIDE * 16);
}

/* The nearest point of the ball at a pixel. False beyond `share` of its radius. */
static bool hit(uint32_t x, uint32_t y, double share, double at[3], double *chord)
{
    double ray[3];
    shot_ray(&s, x + 0.5, y + 0.5, ray);
    const double length = sqrt(ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2]);
    const double ahead = -DISTANCE * ray[2] / length, miss2 = DISTANCE * DISTANCE - ahead * ahead;
    if (miss2 > share * share * surface_m * surface_m)
        return false;
    *chord = 2 * sqrt(surface_m * surface_m - miss2);
    for (int k = 0; k < 3; k++)
        at[k] = (k == 2 ? DISTANCE : 0) + (ahead - 0.5 * *chord) * ray[k] / length;
    return true;
}

/* The largest difference of a channel from what `expected` says, over the middle of the ball. */
static double worst(double share, uint32_t channels, void (*expected)(const double at[3], double chord, double out[3]))
{
    double most = 0;
    uint32_t compared = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        double at[3], chord, out[3];
        if (!hit(i % SIDE, i / SIDE, share, at, &chord))
            continue;
        const float *pixel = shot_pixel(&s, i % SIDE, i / SIDE);
        assert_true(pixel[3] == 1);
        expected(at, chord, out);
        for (uint32_t c = 0; c < channels; c++)
            most = fmax(most, fabs((double)pixel[c] - out[c]));
        compared++;
    }
    assert_true(shot_pixel(&s, 0, 0)[3] == 0);
    REQUIRE(compared > 500);
    return most;
}

static void expect_thickness(const double at[3], double chord, double out[3])
{
    (void)at;
    out[0] = chord;
}

static void expect_normal(const double at[3], double chord, double out[3])
{
    (void)chord;
    for (int k = 0; k < 3; k++)
        out[k] = at[k] / surface_m;
}

/* To where the point was a frame before. */
static void expect_motion(const double at[3], double chord, double out[3])
{
    (void)chord;
    const double px = 0.5 * SIDE / tan(FOV_DEG * M_PI / 360);
    out[0] = -0.5 * FRAME_S * px / (DISTANCE - at[2]);
    out[1] = 0;
}

static void data_are_those_of_a_ball(void **state)
{
    (void)state;
    set_up();
    draw(VIRGA_WATER_DATA_THICKNESS);
    const double thickness = worst(0.7, 1, expect_thickness);
    draw(VIRGA_WATER_DATA_NORMAL);
    const double normal = worst(0.8, 3, expect_normal);
    draw(VIRGA_WATER_DATA_MOTION);
    const double motion = worst(0.8, 2, expect_motion);
    printf("off by up to %g m of %g, %g of the unit normal, %g px of motion\n", thickness, 2 * surface_m, normal,
           motion);
    REQUIRE(thickness < 0.02 && normal < 0.1 && motion < 0.1);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(data_are_those_of_a_ball)};
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
