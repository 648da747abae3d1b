/* Motion vectors and the reactive mask of water, in closed form. */
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

static void draw(shot *s)
{
    virga_view view = virga_default_view();
    host_camera_view(&s->camera, &s->camera, FRAME_S, &view);
    memcpy(view.temporal.position_m, s->before.position_m, sizeof s->before.position_m);
    memcpy(view.temporal.view_from_world, s->before.view_from_world, sizeof s->before.view_from_world);
    memcpy(view.temporal.clip_from_view, s->before.clip_from_view, sizeof s->before.clip_from_view);
    view.temporal.frame_interval_s = FRAME_S;
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(motion_vectors_lead_to_where_the_ball_was),
        cmocka_unit_test(where_there_is_no_water_the_motion_stays),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
