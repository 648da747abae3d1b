/* Motion vectors and the reactive mask of water: of its surface in closed form; of droplets and foam against where they
 * were a frame before, in the buffers of that frame. */
#include "water_fixture.h"

#include "../host/temporal_picture.h"
#include "camera.h"

enum { SIDE = 96 };

#define FRAME_S  (1.0 / 60)
#define RADIUS_M 0.2
#define EYE_M    0.7
#define FOV_DEG  40.0

typedef struct shot {
    water_fixture f;
    temporal_picture picture;
    virga_target *target;
    host_camera camera, before;
    double radius; /* of the surface */
} shot;

static const double velocity[3] = {0.9, -0.6, 1.2}; /* m/s */

static void aim(host_camera *camera, const double at[3])
{
    const host_camera_key key = {0, {at[0], at[1], at[2]}, {at[0], at[1], 0}, 0, false};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = FOV_DEG, .near_m = 0.02, .far_m = 100};
    host_camera_at(&path, 0, SIDE, SIDE, NULL, camera);
}

static void open_shot(shot *s)
{
    const double origin[3] = {0, 0, 0};
    memset(s, 0, sizeof *s);
    virga_water_def def = water_fixture_def();
    def.max_width = def.max_height = SIDE;
    water_fixture_open_with(&s->f, &def, false);
    picture_open(&s->f.gpu.device, SIDE, SIDE, &s->picture);
    const virga_target_def target = picture_target(&s->picture);
    REQUIRE(virga_target_create(s->f.context, &target, &s->target) == VIRGA_OK);
    REQUIRE(virga_water_attach(s->f.water, s->target) == VIRGA_OK);
    s->f.settings.spacing_m = (float)(RADIUS_M / 12);
    REQUIRE(virga_water_set(s->f.water, &s->f.settings) == VIRGA_OK);
    water_fixture_shells(&s->f, origin, RADIUS_M, RADIUS_M / 12);
    for (uint32_t i = 0; i < s->f.count; i++)
        for (int axis = 0; axis < 3; axis++)
            s->f.particles[i].velocity[axis] = (float)velocity[axis];
    s->radius = water_reference_radius(&s->f, origin, 1.2 * RADIUS_M);
}

static void close_shot(shot *s)
{
    virga_target_destroy(&s->target);
    picture_close(&s->f.gpu.device, &s->picture);
    water_fixture_close(&s->f);
}

static virga_view view_of(const shot *s)
{
    virga_view view = virga_default_view();
    host_camera_view(&s->camera, &s->camera, FRAME_S, &view);
    view.shutter_s = 0; /* foam is drawn in the middle of its way; vectors are of the moment */
    memcpy(view.temporal.position_m, s->before.position_m, sizeof s->before.position_m);
    memcpy(view.temporal.view_from_world, s->before.view_from_world, sizeof s->before.view_from_world);
    memcpy(view.temporal.clip_from_view, s->before.clip_from_view, sizeof s->before.clip_from_view);
    view.temporal.frame_interval_s = FRAME_S;
    view.temporal.reactive_gain = 1; /* the mask is the coverage */
    return view;
}

static void draw(shot *s)
{
    const virga_view view = view_of(s);
    const VkCommandBuffer cmd = effect_fixture_begin(&s->f.gpu, s->f.context);
    const virga_water_step_info info = {.particles = s->f.particle_buffer.buffer, .count = s->f.count};
    REQUIRE(virga_water_step(s->f.water, cmd, &info) == VIRGA_OK);
    REQUIRE(virga_water_prepare(s->f.water, cmd, &view) == VIRGA_OK);
    picture_begin(&s->picture, cmd);
    REQUIRE(virga_water_draw(s->f.water, cmd, s->target) == VIRGA_OK);
    picture_end(&s->picture, cmd);
    effect_fixture_complete(&s->f.gpu, s->f.context);
    picture_read(&s->f.gpu.device, &s->picture);
}

/* Where the point of the ball at a pixel was a frame before, in pixels from there. Both cameras look along -Z. */
static bool expected_motion(const shot *s, double x, double y, double motion[2])
{
    const double *eye = s->camera.position_m, *old = s->before.position_m;
    const double px = 0.5 * SIDE / tan(FOV_DEG * M_PI / 360); /* per unit of slope */
    const double d[3] = {(x - 0.5 * SIDE) / px, -(y - 0.5 * SIDE) / px, -1};
    const double a = d[0] * d[0] + d[1] * d[1] + 1, b = d[0] * eye[0] + d[1] * eye[1] - eye[2];
    const double c = eye[0] * eye[0] + eye[1] * eye[1] + eye[2] * eye[2] - s->radius * s->radius, root = b * b - a * c;
    if (root < 0.36 * s->radius * s->radius * a) /* 0.8 of the radius aside */
        return false;
    const double t = (-b - sqrt(root)) / a;
    double at[3];
    for (int i = 0; i < 3; i++)
        at[i] = eye[i] + t * d[i] - velocity[i] * FRAME_S - old[i];
    motion[0] = 0.5 * SIDE - px * at[0] / at[2] - x;
    motion[1] = 0.5 * SIDE + px * at[1] / at[2] - y;
    return true;
}

static void check(shot *s)
{
    double worst = 0;
    uint32_t compared = 0;
    draw(s);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        double motion[2];
        if (!expected_motion(s, i % SIDE + 0.5, i / SIDE + 0.5, motion))
            continue;
        compared++;
        for (int k = 0; k < 2; k++)
            worst = fmax(worst, fabs((double)s->picture.motion[2 * i + (uint32_t)k] - motion[k]));
        REQUIRE(s->picture.reactive[i] > 0.99f);
    }
    printf("%u motion vectors are off by up to %g px\n", compared, worst);
    REQUIRE(compared > 1000 && worst < 0.1);
}

static void motion_vectors_lead_to_where_the_ball_was(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    aim(&s.camera, (const double[3]){0, 0, EYE_M});
    s.before = s.camera;
    check(&s);
    aim(&s.before, (const double[3]){0.01, -0.02, EYE_M + 0.015});
    check(&s);
    close_shot(&s);
}

static void where_there_is_no_water_the_motion_stays(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    aim(&s.camera, (const double[3]){0, 0, EYE_M});
    s.before = s.camera;
    draw(&s);
    REQUIRE(!picture_has_motion(&s.picture, 0) && picture_has_motion(&s.picture, SIDE / 2 * SIDE + SIDE / 2));
    REQUIRE(s.picture.reactive[0] == 0);
    close_shot(&s);
}

/* ---- droplets and foam */

enum { MOST = 4096 };

/* What is followed, and where it was a frame before. */
typedef struct mark {
    double now[3], before[3], radius;
} mark;

static host_buffer foam_down;

static void open_marks(shot *s)
{
    memset(s, 0, sizeof *s);
    virga_water_def def = water_fixture_def();
    def.max_width = def.max_height = SIDE;
    def.max_foam = MOST;
    water_fixture_open_with(&s->f, &def, false);
    picture_open(&s->f.gpu.device, SIDE, SIDE, &s->picture);
    const virga_target_def target = picture_target(&s->picture);
    REQUIRE(virga_target_create(s->f.context, &target, &s->target) == VIRGA_OK);
    REQUIRE(virga_water_attach(s->f.water, s->target) == VIRGA_OK);
    REQUIRE(host_buffer_create(&s->f.gpu.device, s->f.water->foam.particles->size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HOST_BUFFER_READBACK, "foam down", &foam_down, s->f.gpu.error, sizeof s->f.gpu.error));
    s->f.settings.spacing_m = 0.02f;
    s->f.settings.spray_density = 0.45f;
    s->f.settings.foam_coverage = 1;
    aim(&s->camera, (const double[3]){0, 0, EYE_M});
    aim(&s->before, (const double[3]){0.01, -0.02, EYE_M + 0.015});
}

static void close_marks(shot *s)
{
    host_buffer_destroy(&s->f.gpu.device, &foam_down);
    close_shot(s);
}

/* Steps, draws foam or what is not foam, and reads droplets and foam of the step. */
static void draw_marks(shot *s, bool foam)
{
    VkDeviceSize offset = 0, foam_offset = 0;
    const virga_view view = view_of(s);
    REQUIRE(virga_water_set(s->f.water, &s->f.settings) == VIRGA_OK);
    const VkCommandBuffer cmd = effect_fixture_begin(&s->f.gpu, s->f.context);
    const virga_water_step_info info = {
        .particles = s->f.particle_buffer.buffer, .count = s->f.count, .time_s = s->f.time_s};
    REQUIRE(virga_water_step(s->f.water, cmd, &info) == VIRGA_OK);
    REQUIRE(virga_water_prepare(s->f.water, cmd, &view) == VIRGA_OK);
    picture_begin(&s->picture, cmd);
    REQUIRE((foam ? virga_water_draw_foam : virga_water_draw)(s->f.water, cmd, s->target) == VIRGA_OK);
    picture_end(&s->picture, cmd);
    effect_fixture_transfers(cmd);
    s->f.droplets = effect_fixture_copy(cmd, s->f.water->spray.droplets->buffer, s->f.water->spray.droplets->size,
                                        &s->f.download, &offset);
    effect_fixture_copy(cmd, s->f.water->foam.particles->buffer, s->f.water->foam.particles->size, &foam_down,
                        &foam_offset);
    effect_fixture_complete(&s->f.gpu, s->f.context);
    host_buffer_invalidate(&s->f.gpu.device, &s->f.download);
    host_buffer_invalidate(&s->f.gpu.device, &foam_down);
    picture_read(&s->f.gpu.device, &s->picture);
    virga_water_stats_get(s->f.water, &s->f.stats);
    s->f.time_s += FRAME_S;
    for (uint32_t i = 0; i < s->f.count; i++) {
        virga_particle_gpu *p = &s->f.particles[i];
        p->velocity[1] -= (float)(9.81 * FRAME_S);
        for (int k = 0; k < 3; k++)
            p->position[k] += (float)FRAME_S * p->velocity[k];
    }
}

/* Drops or foam of two frames, which have ids: those of both. */
static uint32_t find_marks(const void *now, const void *before, uint32_t count, uint32_t count_before, size_t stride,
                           size_t id_at, mark *marks)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < count_before; k++) {
            const char *a = (const char *)now + i * stride, *b = (const char *)before + k * stride;
            const float *p = (const float *)a, *q = (const float *)b;
            if (memcmp(a + id_at, b + id_at, 4) || p[3] <= 0 || q[3] <= 0)
                continue;
            for (int axis = 0; axis < 3; axis++) {
                marks[found].now[axis] = (double)p[axis];
                marks[found].before[axis] = (double)q[axis];
            }
            marks[found++].radius = (double)p[3];
            break;
        }
    return found;
}

/* Both cameras look along -Z. Returns pixels of a metre there. */
static double project_px(const host_camera *camera, const double at[3], double pixel[2])
{
    const double px = 0.5 * SIDE / tan(FOV_DEG * M_PI / 360) / (camera->position_m[2] - at[2]);
    pixel[0] = 0.5 * SIDE + px * (at[0] - camera->position_m[0]);
    pixel[1] = 0.5 * SIDE - px * (at[1] - camera->position_m[1]);
    return px;
}

/* How far a pixel's vector is from that of the mark around it that fits best (px); negative: there is none. */
static double motion_error(const shot *s, const mark *marks, uint32_t count, uint32_t pixel)
{
    const double x = pixel % SIDE + 0.5, y = pixel / SIDE + 0.5;
    double best = -1;
    for (uint32_t i = 0; i < count; i++) {
        double now[2], before[2];
        const double px = project_px(&s->camera, marks[i].now, now);
        project_px(&s->before, marks[i].before, before);
        if (hypot(now[0] - x, now[1] - y) > fmax(1.05 * px * marks[i].radius, 0.75))
            continue;
        const double error = hypot((double)s->picture.motion[2 * pixel] - (before[0] - now[0]),
                                   (double)s->picture.motion[2 * pixel + 1] - (before[1] - now[1]));
        best = best < 0 ? error : fmin(best, error);
    }
    return best;
}

/* Vectors are compared where what covers a pixel by half or more is one of the marks. The mask has 8 bits, in which
 * layers of foam lie over each other. */
static void check_marks(const shot *s, const mark *marks, uint32_t count, const char *what)
{
    double worst = 0, sum = 0, mask = 0;
    uint32_t compared = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const double covered = (double)s->picture.color[4 * i + 3];
        const double error = picture_has_motion(&s->picture, i) ? motion_error(s, marks, count, i) : -1;
        mask = fmax(mask, fabs((double)s->picture.reactive[i] - covered));
        if (error < 0)
            continue;
        compared++;
        sum += error;
        worst = fmax(worst, error);
    }
    printf("%u vectors of %u %s are off by %.3f px on average, up to %.3f px; the mask by %.4f\n", compared, count,
           what, sum / compared, worst, mask);
    REQUIRE(compared > 100 && worst < 0.25 && mask < 0.02);
}

/* Particles all alone, which become a drop each: they fly apart, slowed by the air. */
static void droplets_have_the_motion_of_two_frames(void **state)
{
    (void)state;
    static mark marks[MOST];
    static virga_spray_gpu before[MOST];
    uint32_t hash = 3, droplets = 0;
    shot s;
    open_marks(&s);
    s.f.settings.spray_turbulence = 0;
    for (int i = 0; i < 25; i++) {
        virga_particle_gpu *p = water_fixture_add(&s.f, 0.09 * (i % 5 - 2), 0.09 * (i / 5 - 2), 0);
        for (int k = 0; k < 3; k++)
            p->velocity[k] = (float)water_random(&hash, -1, 1);
    }
    for (int frame = 0; frame < 3; frame++) {
        droplets = s.f.stats.droplets;
        memcpy(before, s.f.droplets ? s.f.droplets : before, droplets * sizeof *before);
        draw_marks(&s, false);
    }
    REQUIRE(s.f.stats.droplets == 25 && droplets == 25);
    const uint32_t found =
        find_marks(s.f.droplets, before, 25, 25, sizeof *before, offsetof(virga_spray_gpu, id), marks);
    assert_int_equal(found, 25);
    check_marks(&s, marks, found, "droplets");
    close_marks(&s);
}

/* Two blocks of water meet, and trap air: foam is carried along, and held at the surface. */
static void foam_has_the_motion_of_two_frames(void **state)
{
    (void)state;
    static mark marks[MOST];
    static virga_foam_gpu before[MOST];
    const uint32_t counts[3] = {5, 10, 4};
    shot s;
    open_marks(&s);
    s.f.settings.foam_air_hz = 25;
    s.f.settings.foam_radius_m = 0.01f;
    s.f.settings.foam_crest_hz = 0;
    water_fixture_box(&s.f, (const double[3]){-0.12, -0.05, -0.05}, counts, 0.02, 0.1);
    water_fixture_box(&s.f, (const double[3]){0.02, -0.05, -0.05}, counts, 0.02, 0.1);
    for (uint32_t i = 0; i < s.f.count; i++) {
        s.f.particles[i].velocity[0] = i < s.f.count / 2 ? 1.5f : -1.5f;
        s.f.particles[i].velocity[1] = 1;
    }
    for (int frame = 0; frame < 6; frame++) {
        memcpy(before, foam_down.mapped, sizeof before);
        draw_marks(&s, true);
    }
    const uint32_t found =
        find_marks(foam_down.mapped, before, MOST, MOST, sizeof *before, offsetof(virga_foam_gpu, id), marks);
    check_marks(&s, marks, found, "particles of foam");
    close_marks(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(motion_vectors_lead_to_where_the_ball_was),
        cmocka_unit_test(where_there_is_no_water_the_motion_stays),
        cmocka_unit_test(droplets_have_the_motion_of_two_frames),
        cmocka_unit_test(foam_has_the_motion_of_two_frames),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
