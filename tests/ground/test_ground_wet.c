/* test_ground_wet.c - wet ground over a picture: what darkens and what is mirrored, against a room whose floor and wall
 * are known as formulas. */
#include "ground_fixture.h"

#include "../scene/layered_pass.h"

#include <math.h>

#include <virga/light.h>

enum { WIDTH = 96, HEIGHT = 64, PIXELS = WIDTH * HEIGHT };

#define EYE_M      1.5
#define WALL_M     4.0 /* in front of the camera, 3 m high; above it is the sky */
#define WALL_TOP_M 3.0
#define NEAR_M     0.1
#define FAR_M      100.0
#define FORMAT     VK_FORMAT_R32G32B32A32_SFLOAT

/* How the host has it. */
typedef enum room_kind {
    PLAIN,
    REVERSED, /* greater depth is nearer, and there is no far plane */
    ENCODED,  /* its picture and the target hold sRGB values in bytes */
} room_kind;

typedef struct room {
    ground_fixture f;
    room_kind kind;
    layered_pass pass;
    virga_target *target;
    host_image depth, color;
    virga_view view;
    virga_ground_wet wet;
    float colors[PIXELS][4], depths[PIXELS];
    uint8_t bytes[PIXELS][4]; /* the colors, encoded */
} room;

/* Grey, so that a target can be cleared to it. */
static const double floor_color[3] = {0.35, 0.35, 0.35};

static void wall_color(double x, double y, double color[3])
{
    color[0] = 0.5 + 0.3 * sin(1.3 * x);
    color[1] = 0.3 + 0.1 * y;
    color[2] = 0.6 + 0.2 * cos(0.9 * x);
}

/* The ray of a pixel, with a view depth of 1 m. The projection's cotangents are 1 and the picture's ratio. */
static void ray_of(double x, double y, double ray[3])
{
    ray[0] = (2 * x / WIDTH - 1) * WIDTH / HEIGHT;
    ray[1] = 1 - 2 * y / HEIGHT;
    ray[2] = -1;
}

/* IEC 61966-2-1. */
static double encoded(double light)
{
    return light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055;
}

/* The value of a depth buffer at a view depth; 0: the sky. */
static float depth_of(room_kind kind, double z)
{
    const double near = NEAR_M, far = FAR_M;
    if (kind == REVERSED)
        return z > 0 ? (float)(near / z) : 0;
    return z > 0 ? (float)(far / (far - near) * (1 - near / z)) : 1;
}

static void paint(room *r)
{
    for (int i = 0; i < PIXELS; i++) {
        double ray[3], color[3] = {0.2, 0.4, 0.9}, z = 0; /* the sky */
        ray_of(i % WIDTH + 0.5, i / WIDTH + 0.5, ray);
        const double floor_z = ray[1] < 0 ? EYE_M / -ray[1] : 1e9, wall_y = EYE_M + WALL_M * ray[1];
        if (floor_z < WALL_M) {
            memcpy(color, floor_color, sizeof color);
            z = floor_z;
        } else if (wall_y < WALL_TOP_M) {
            wall_color(ray[0] * WALL_M, wall_y, color);
            z = WALL_M;
        }
        for (int c = 0; c < 3; c++) {
            r->colors[i][c] = (float)color[c];
            r->bytes[i][c] = (uint8_t)lround(255 * encoded(color[c]));
        }
        r->colors[i][3] = 1;
        r->bytes[i][3] = 255;
        r->depths[i] = depth_of(r->kind, z);
    }
}

static virga_image give(room *r, host_image *made, VkFormat format, const void *data, uint32_t bytes)
{
    fixture *gpu = &r->f.gpu;
    const host_image_def def = {
        .format = format, .extent = {WIDTH, HEIGHT, 1}, .usage = VK_IMAGE_USAGE_SAMPLED_BIT, .name = "of a host"};
    REQUIRE(host_image_create_with(&gpu->device, &def, data, (VkDeviceSize)PIXELS * bytes, bytes, made, gpu->error,
                                   sizeof gpu->error));
    return (virga_image){.image = made->image,
                         .view = made->view,
                         .format = format,
                         .before = {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}};
}

static void aim(room *r)
{
    const float near = (float)NEAR_M, far = (float)FAR_M, ratio = (float)HEIGHT / WIDTH;
    float clip[16] = {ratio, 0, 0, 0, 0, -1, 0, 0, 0, 0, -far / (far - near), -1, 0, 0, -far * near / (far - near)};
    if (r->kind == REVERSED) {
        clip[10] = 0;
        clip[14] = near;
    }
    r->view = virga_default_view();
    r->view.reversed_depth = r->kind == REVERSED;
    r->view.position_m[1] = r->view.open_position_m[1] = EYE_M;
    memcpy(r->view.clip_from_view, clip, sizeof clip);
    memcpy(r->view.open_clip_from_view, clip, sizeof clip);
    r->view.viewport[2] = WIDTH;
    r->view.viewport[3] = HEIGHT;
}

/* A smooth floor under 3 mm of water: all of it is one level puddle. */
static void open_room(room *r, float start_water_mm, room_kind kind)
{
    virga_target_def target = virga_default_target_def();
    memset(r, 0, sizeof *r);
    r->kind = kind;
    ground_fixture_open(&r->f);
    virga_ground_def def = virga_default_ground_def();
    def.cells = 256; /* 12.8 m */
    def.far_cells = def.cached_tiles = 0;
    def.max_impacts = MAX_DROPS;
    ground_fixture_ground(&r->f, &def);
    ground_fixture_floor(&r->f, VIRGA_MATERIAL_CUSTOM);
    r->f.settings.start_wetness = start_water_mm > 0 ? 1 : 0;
    r->f.settings.start_water_mm = start_water_mm;
    REQUIRE(virga_ground_set(r->f.ground, &r->f.settings) == VIRGA_OK);
    r->f.camera[1] = EYE_M;
    ground_fixture_step(&r->f, 1);
    const VkFormat screen = VK_FORMAT_R8G8B8A8_UNORM;
    layered_pass_open(&r->pass, &r->f.gpu, kind == ENCODED ? screen : FORMAT, kind == ENCODED ? 4 : 16, WIDTH, HEIGHT,
                      1, 0);
    target.render_pass = r->pass.pass;
    target.depth_attached = false;
    target.encoding = kind == ENCODED ? VIRGA_ENCODING_SRGB : VIRGA_ENCODING_NOT_GIVEN;
    REQUIRE(virga_target_create(r->f.context, &target, &r->target) == VIRGA_OK);
    REQUIRE(virga_ground_attach(r->f.ground, r->target) == VIRGA_OK);
    paint(r);
    aim(r);
    r->view.depth = give(r, &r->depth, VK_FORMAT_R32_SFLOAT, r->depths, sizeof r->depths[0]);
    r->view.color = kind == ENCODED ? give(r, &r->color, screen, r->bytes, sizeof r->bytes[0])
                                    : give(r, &r->color, FORMAT, r->colors, sizeof r->colors[0]);
    r->view.color_encoding = target.encoding;
    r->wet = virga_default_ground_wet();
}

static void close_room(room *r)
{
    virga_target_destroy(&r->target);
    layered_pass_close(&r->pass);
    host_image_destroy(&r->f.gpu.device, &r->depth);
    host_image_destroy(&r->f.gpu.device, &r->color);
    ground_fixture_close(&r->f);
}

static const void *draw_over(room *r, float background)
{
    const VkCommandBuffer cmd = effect_fixture_begin(&r->f.gpu, r->f.context);
    layered_pass_begin(&r->pass, cmd, background);
    assert_int_equal(virga_ground_draw_wet(r->f.ground, cmd, &r->view, &r->wet, r->target), VIRGA_OK);
    layered_pass_end(&r->pass, cmd);
    effect_fixture_complete(&r->f.gpu, r->f.context);
    return layered_pass_pixels(&r->pass);
}

static const float *draw(room *r)
{
    return draw_over(r, 0);
}

/* What a level puddle shows at a pixel of the floor: premultiplied light and coverage. False: the wall's image there is
 * not on the picture, or near its borders. */
static bool puddle_at(const room *r, double x, double y, double expected[4])
{
    double ray[3], wall[3];
    ray_of(x, y, ray);
    if (ray[1] >= 0 || EYE_M / -ray[1] > WALL_M - 0.1)
        return false;
    const double z = EYE_M / -ray[1], length = sqrt(ray[0] * ray[0] + ray[1] * ray[1] + 1), cosine = -ray[1] / length;
    const double at_x = ray[0] * WALL_M, at_y = -ray[1] * (WALL_M - z); /* the mirrored ray rises as it fell */
    const double pixel_x = (at_x / WALL_M * HEIGHT / WIDTH + 1) / 2, pixel_y = (1 - (at_y - EYE_M) / WALL_M) / 2;
    if (fmin(fmin(pixel_x, 1 - pixel_x), fmin(pixel_y, 1 - pixel_y)) < 0.09 || at_y > WALL_TOP_M - 0.1)
        return false;
    wall_color(at_x, at_y, wall);
    const double strength = (double)r->wet.strength, rough = 0.03;
    const double fresnel = 0.0204 + (1 - rough - 0.0204) * pow(1 - cosine, 5);
    const double mirror = 1 - pow(1 - fresnel, strength), dark = 1 - pow(1 - (double)r->wet.darkening, strength);
    for (int c = 0; c < 3; c++)
        expected[c] = mirror * wall[c];
    expected[3] = 1 - (1 - dark) * (1 - mirror);
    return true;
}

/* Within 0.005 of light that is up to 1: rays are followed by halvings, and the picture is filtered between pixels. */
static void check_puddle(room_kind kind)
{
    static room r;
    open_room(&r, 3, kind);
    for (int strength = 1; strength <= 2; strength++) {
        r.wet.strength = (float)strength;
        const float *pixels = draw(&r);
        double most = 0;
        uint32_t compared = 0;
        for (int i = 0; i < PIXELS; i++) {
            double expected[4];
            if (!puddle_at(&r, i % WIDTH + 0.5, i / WIDTH + 0.5, expected))
                continue;
            compared++;
            for (int c = 0; c < 4; c++)
                most = fmax(most, fabs((double)pixels[4 * i + c] - expected[c]));
        }
        printf("strength %d: %u pixels, off by %.5f at most\n", strength, compared, most);
        assert_true(compared > 500 && most < 0.005);
    }
    close_room(&r);
}

static void a_puddle_mirrors_the_wall_and_darkens(void **state)
{
    (void)state;
    check_puddle(PLAIN);
}

static void and_in_reversed_depth(void **state)
{
    (void)state;
    check_puddle(REVERSED);
}

/* Over the host's picture, which the pass knows, blending is exact: the bytes are those of the light above, encoded.
 * Within 1.5/255, of which rounding is a half. */
static void and_where_picture_and_target_are_encoded(void **state)
{
    static room r;
    (void)state;
    open_room(&r, 3, ENCODED);
    for (int strength = 1; strength <= 2; strength++) {
        r.wet.strength = (float)strength;
        const uint8_t *pixels = draw_over(&r, (float)encoded(floor_color[0]));
        double most = 0;
        uint32_t compared = 0;
        for (int i = 0; i < PIXELS; i++) {
            double light[4];
            if (!puddle_at(&r, i % WIDTH + 0.5, i / WIDTH + 0.5, light))
                continue;
            compared++;
            for (int c = 0; c < 3; c++)
                most = fmax(most, fabs(pixels[4 * i + c] - 255 * encoded(light[c] + (1 - light[3]) * floor_color[c])));
        }
        printf("strength %d: %u pixels, off by %.2f/255 at most\n", strength, compared, most);
        assert_true(compared > 500 && most < 1.5);
    }
    close_room(&r);
}

/* Without water, and above it, nothing is drawn. */
static void dry_ground_and_walls_stay_as_they_are(void **state)
{
    static room r;
    (void)state;
    open_room(&r, 0, PLAIN);
    const float *pixels = draw(&r);
    for (int i = 0; i < 4 * PIXELS; i++)
        assert_true(pixels[i] == 0);
    close_room(&r);
    open_room(&r, 3, PLAIN);
    pixels = draw(&r);
    for (int i = 0; i < PIXELS; i++) {
        double ray[3];
        ray_of(i % WIDTH + 0.5, i / WIDTH + 0.5, ray);
        if (ray[1] > 0 || EYE_M / -ray[1] > WALL_M + 0.2)
            assert_true(pixels[4 * i + 3] == 0);
    }
    r.wet.strength = 0;
    pixels = draw(&r);
    for (int i = 0; i < 4 * PIXELS; i++)
        assert_true(fabsf(pixels[i]) < 1e-6f);
    close_room(&r);
}

static void expect_refusal(room *r, VkCommandBuffer cmd, const char *line)
{
    r->f.logged[0] = 0;
    assert_int_equal(virga_ground_draw_wet(r->f.ground, cmd, &r->view, &r->wet, r->target), VIRGA_ERROR_INVALID);
    if (!strstr(r->f.logged, line))
        fail_msg("expected '%s' in: %s", line, r->f.logged);
}

static void what_is_missing_or_out_of_range_is_told(void **state)
{
    static room r;
    (void)state;
    open_room(&r, 3, PLAIN);
    const VkCommandBuffer cmd = effect_fixture_begin(&r.f.gpu, r.f.context);
    const virga_ground_wet wet = r.wet;
    const virga_view view = r.view;
    layered_pass_begin(&r.pass, cmd, 0);
    r.view.color = (virga_image){0};
    expect_refusal(&r, cmd, "got no color");
    r.view = view;
    r.view.depth = (virga_image){0};
    expect_refusal(&r, cmd, "got no depth");
    r.view = view;
    r.wet.strength = -1;
    expect_refusal(&r, cmd, "ground_wet.strength: expected 0 to 4");
    r.wet = wet;
    r.wet.far_material = VIRGA_GROUND_MATERIALS;
    expect_refusal(&r, cmd, "ground_wet.far_material");
    r.wet = wet;
    r.wet.environment_sh[3][1] = NAN;
    expect_refusal(&r, cmd, "ground_wet.environment_sh");
    r.wet = (virga_ground_wet){0};
    expect_refusal(&r, cmd, "ground_wet");
    layered_pass_end(&r.pass, cmd);
    effect_fixture_complete(&r.f.gpu, r.f.context);
    close_room(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_puddle_mirrors_the_wall_and_darkens),
        cmocka_unit_test(and_in_reversed_depth),
        cmocka_unit_test(and_where_picture_and_target_are_encoded),
        cmocka_unit_test(dry_ground_and_walls_stay_as_they_are),
        cmocka_unit_test(what_is_missing_or_out_of_range_is_told),
    };
    return effect_fixture_close(cmocka_run_group_tests_name("wet ground", tests, NULL, NULL));
}
