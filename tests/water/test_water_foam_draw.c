/* How foam covers what is behind it, against closed forms. */
#include "water_picture_fixture.h"

#include <virga/shared/compact.h>

#include "../../shaders/shared/foam.h"

#define SIDE     96
#define DISTANCE 0.5

static shot s;
static const double eye_m[3] = {0, 0, DISTANCE}, middle_m[3] = {0, 0, 0};

#define MAX 64
/* What the next frames show, in place of foam that the step made. */
static struct injected {
    virga_foam_gpu foam[MAX];
    uint32_t slots[MAX], count;
    virga_water_state_gpu counts;
} * in;

static void fill(VkCommandBuffer cmd, const virga_buffer *to, VkDeviceSize at, size_t from, VkDeviceSize size)
{
    const VkBufferCopy copy = {from, at, size};
    vkCmdCopyBuffer(cmd, s.extra.buffer, to->buffer, 1, &copy);
}

static void inject(VkCommandBuffer cmd)
{
    const virga_water *water = s.f.water;
    memset(&in->counts, 0, sizeof in->counts);
    in->counts.foam = in->count;
    in->counts.foam_vertices[0] = 3 * in->count;
    in->counts.foam_vertices[1] = in->counts.foam_groups[0] = in->counts.foam_groups[1] = in->counts.foam_groups[2] = 1;
    for (uint32_t i = 0; i < MAX; i++)
        in->slots[i] = i;
    effect_fixture_transfers(cmd);
    fill(cmd, water->foam.particles, 0, offsetof(struct injected, foam), sizeof in->foam);
    fill(cmd, water->foam.slots, sizeof(virga_list_gpu), offsetof(struct injected, slots), sizeof in->slots);
    const size_t first = offsetof(virga_water_state_gpu, foam_started);
    fill(cmd, water->state, first, offsetof(struct injected, counts) + first, sizeof in->counts - first);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
}

static double gray_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of, (void)eye, (void)direction;
    rgb[0] = rgb[1] = rgb[2] = 0.5;
    return INFINITY;
}

static void set_up(void)
{
    virga_water_def def = water_fixture_def();
    def.max_foam = 256;
    def.max_particles = 16384;
    def.max_width = def.max_height = SIDE;
    shot_open_with(&s, &def, SIDE, SIDE, false);
    s.scene = gray_scene;
    in = s.extra.mapped;
    memset(in, 0, sizeof *in);
    shot_aim(&s, eye_m, middle_m);
}

static void add(double x, double y, double z, double radius, uint32_t kind)
{
    in->foam[in->count++] = (virga_foam_gpu){
        .position = {(float)x, (float)y, (float)z}, .radius = (float)radius, .life_s = 2, .age_s = 1, .kind = kind};
}

/* Water is not drawn, so the pixels are those of foam alone. */
static void draw(void)
{
    REQUIRE(virga_water_set(s.f.water, &s.f.settings) == VIRGA_OK);
    const VkCommandBuffer cmd = effect_fixture_begin(&s.f.gpu, s.f.context);
    const virga_water_step_info info = {.particles = s.f.particle_buffer.buffer, .count = s.f.count};
    REQUIRE(virga_water_step(s.f.water, cmd, &info) == VIRGA_OK);
    inject(cmd);
    const virga_view view = shot_view(&s);
    REQUIRE(virga_water_prepare(s.f.water, cmd, &view) == VIRGA_OK);
    host_target_begin_layer(&s.picture, cmd);
    REQUIRE(virga_water_draw_foam(s.f.water, cmd, s.layer) == VIRGA_OK);
    vkCmdEndRenderPass(cmd);
    host_target_copy_out(&s.picture, cmd, 1u << HOST_LAYER);
    effect_fixture_complete(&s.f.gpu, s.f.context);
    memcpy(s.pixels, host_target_floats(&s.f.gpu.device, &s.picture, HOST_LAYER), (size_t)SIDE * SIDE * 16);
}

static double px_of(double radius)
{
    return radius / (DISTANCE * 2 * tan(FOV_DEG * M_PI / 360) / SIDE);
}

/* The integral of a (1 - r^2) (1 + r^2) over the disc is 2/3 a pi R^2, however small the disc is. */
static void a_particle_covers_its_disc(void **state)
{
    (void)state;
    static const double radii[] = {0.02, 0.008, 0.002, 0.0005};
    set_up();
    for (int i = 0; i < 4; i++) {
        in->count = 0;
        add(0.003, -0.002, 0, radii[i], VIRGA_FOAM_SURFACE);
        draw();
        const double px = px_of(radii[i]), expected = 2.0 / 3 * 0.3 * M_PI * px * px;
        printf("radius %g px: covers %g px, expected %g\n", px, shot_covered(&s), expected);
        if (fabs(shot_covered(&s) / expected - 1) > (px > 3 ? 0.02 : 0.35)) /* small ones fall between pixels */
            fail_msg("radius %g px: covers %g px, expected %g", px, shot_covered(&s), expected);
    }
    shot_close(&s);
}

/* It is at (0.05, 0.02, 0) when the shutter closes, and has come (0.1, 0, 0) since it opened. It covers as much as one
 * that stands still, evenly over its way: the mean is in the middle, and the variance along it is that of a line of
 * the length L and a disc, L^2 / 12 + 3 R^2 / 16 with the disc's own weights 1 - q^4. */
static void foam_that_moves_leaves_a_streak_with_the_same_cover(void **state)
{
    (void)state;
    double sum = 0, mean[2] = {0}, square = 0;
    set_up();
    s.open_shutter_s = 0.05;
    add(0.05, 0.02, 0, 0.008, VIRGA_FOAM_SURFACE);
    in->foam[0].moved[0] = 2;
    draw();
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double covered = (double)s.pixels[4 * i + 3], at[2] = {i % SIDE + 0.5, i / SIDE + 0.5};
        sum += covered;
        square += covered * at[0] * at[0];
        for (int axis = 0; axis < 2; axis++)
            mean[axis] += covered * at[axis];
    }
    const double px = px_of(0.008), expected = 2.0 / 3 * 0.3 * M_PI * px * px, length = px_of(0.1);
    const double deviation = sqrt(square / sum - mean[0] / sum * mean[0] / sum);
    printf("covers %.4f px, expected %.4f; middle %.3f, %.3f; deviation %.3f px\n", sum, expected, mean[0] / sum,
           mean[1] / sum, deviation);
    assert_float_equal(sum / expected, 1, 0.05);
    assert_float_equal(mean[0] / sum, 0.5 * SIDE, 0.1);
    assert_float_equal(mean[1] / sum, 0.5 * SIDE - px_of(0.02), 0.1);
    assert_float_equal(deviation, sqrt(length * length / 12 + 3 * px * px / 16), 0.1);
    shot_close(&s);
}

/* Particles over each other cover 1 - (1 - a)^n, whatever their order is. */
static void many_particles_cover_softly(void **state)
{
    (void)state;
    set_up();
    for (int n = 1; n <= 16; n *= 2) {
        while (in->count < (uint32_t)n)
            add(0, 0, 0.001 * in->count, 0.05, VIRGA_FOAM_SURFACE);
        draw();
        const double covered = (double)shot_pixel(&s, SIDE / 2, SIDE / 2)[3];
        assert_float_equal(covered, 1 - pow(1 - 0.3, n), 0.005);
    }
    shot_close(&s);
}

/* White that a sky of radiance 1 shines on. */
static void foam_is_white(void **state)
{
    (void)state;
    set_up();
    memset(&s.f.settings.lighting, 0, sizeof s.f.settings.lighting);
    for (int c = 0; c < 3; c++)
        s.f.settings.lighting.environment_sh[0][c] = (float)sqrt(4 * M_PI);
    add(0, 0, 0, 0.05, VIRGA_FOAM_SURFACE);
    draw();
    const float *middle = shot_pixel(&s, SIDE / 2, SIDE / 2);
    for (int c = 0; c < 3; c++)
        assert_float_equal(middle[c] / middle[3], 0.9, 0.005);
    shot_close(&s);
}

/* A block of water, and bubbles at depths in it: less what the surface mirrors, and what the water swallows. */
static void bubbles_are_seen_through_the_water(void **state)
{
    (void)state;
    const double d = 0.01, low[3] = {-0.15, -0.15, -0.2};
    const uint32_t size[3] = {31, 31, 16};
    double covered[3];
    set_up();
    s.f.settings.spacing_m = (float)d;
    water_fixture_box(&s.f, low, size, d, 0);
    for (int c = 0; c < 3; c++)
        s.f.settings.absorption_1_m[c] = 5;
    for (int i = 0; i < 3; i++) {
        in->count = 0;
        add(0, 0, i == 0 ? 0.05 : i == 1 ? -0.07 : -0.12, 0.02, VIRGA_FOAM_BUBBLE);
        draw();
        covered[i] = (double)shot_pixel(&s, SIDE / 2, SIDE / 2)[3];
    }
    /* The surface is at z = -0.045; above it nothing is lost. Between the other two are 5 cm of water, both ways. */
    assert_float_equal(covered[0], 0.6 * 0.3, 0.005);
    assert_float_equal(covered[2] / covered[1], exp(-2 * 5 * 0.05), 0.01);
    assert_float_equal(covered[1] / covered[0], (1 - 0.0204) * exp(-2 * 5 * (0.07 - 0.045 - 0.005)), 0.02);
    shot_close(&s);
}

/* A wall 10 cm behind the origin. */
static double wall_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of;
    rgb[0] = rgb[1] = rgb[2] = 0.5;
    return (eye[2] + 0.1) / -direction[2];
}

static void foam_behind_the_scene_is_hidden(void **state)
{
    (void)state;
    set_up();
    s.scene = wall_scene;
    shot_aim(&s, eye_m, middle_m);
    add(0, 0, -0.15, 0.02, VIRGA_FOAM_SURFACE);
    draw();
    assert_true(shot_covered(&s) == 0);
    in->foam[0].position[2] = -0.05f;
    draw();
    assert_true(shot_covered(&s) > 0);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_particle_covers_its_disc),
        cmocka_unit_test(foam_that_moves_leaves_a_streak_with_the_same_cover),
        cmocka_unit_test(many_particles_cover_softly),
        cmocka_unit_test(foam_is_white),
        cmocka_unit_test(bubbles_are_seen_through_the_water),
        cmocka_unit_test(foam_behind_the_scene_is_hidden),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
