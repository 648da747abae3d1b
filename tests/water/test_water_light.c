/* The light from water against closed forms in double precision: a flat sheet over a floor, and the thickness of a
 * ball. */
#include "water_sheet.h"

#define SIDE 96

static shot s;

static const double origin[3] = {0, 0, 0};

/* ---- a flat sheet over a floor whose color changes slowly */

static double slope; /* change of its color per metre */

static void floor_color(double x, double z, double rgb[3])
{
    rgb[0] = 0.5 + slope * x;
    rgb[1] = 0.4 + slope * z;
    rgb[2] = 0.6 - 0.5 * slope * (x + z);
}

static double floor_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of;
    const double distance = direction[1] < -1e-3 ? (SHEET_FLOOR_M - eye[1]) / direction[1] : INFINITY;
    floor_color(eye[0] + distance * direction[0], eye[2] + distance * direction[2], rgb);
    return distance;
}

/* The scene's picture is interpolated between pixels. The nearest pixel would be off by up to 10 mm of the floor. */
#define PIXEL_M     0.001
#define LIGHT_ERROR 4e-4

static void check_sheet(void)
{
    static const double eyes[3][3] = {{0, 0.6, 0.15}, {0.05, 0.35, 0.35}, {-0.2, 0.16, 0.5}};
    const double to[3] = {0, 0, -0.02};
    double worst = 0;
    uint32_t compared = 0;
    for (int i = 0; i < 3; i++) {
        shot_aim(&s, eyes[i], to);
        shot_draw(&s);
        for (uint32_t k = 0; k < SIDE * SIDE; k++) {
            const uint32_t x = k % SIDE, y = k / SIDE;
            double rgb[3];
            const float *pixel = shot_pixel(&s, x, y);
            if (x < SIDE / 4 || x >= SIDE * 3 / 4 || y < SIDE / 4 || y >= SIDE * 3 / 4 ||
                !sheet_expected(&s, x, y, floor_color, rgb))
                continue;
            compared++;
            REQUIRE(pixel[3] > 0.99f);
            for (int c = 0; c < 3; c++)
                worst = fmax(worst, fabs((double)pixel[c] / (double)pixel[3] - rgb[c]));
        }
    }
    printf("%u pixels of a flat sheet are off by up to %g\n", compared, worst);
    REQUIRE(compared > 5000);
    REQUIRE(worst < slope * PIXEL_M + LIGHT_ERROR);
}

static void a_flat_sheet_reflects_refracts_and_absorbs_as_fresnel_snell_and_beer_say(void **state)
{
    (void)state;
    shot_open(&s, SIDE, SIDE);
    s.scene = floor_scene;
    sheet_fill(&s);
    slope = 0.2;
    check_sheet();
    slope = 0.001;
    check_sheet();
    shot_close(&s);
}

/* ---- where the scene's picture ends */

#define OPEN_FOV_DEG 24.0
#define HOST_LIGHT   7.0 /* of the host's sky: far from what the environment has */

static double open_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of, (void)eye, (void)direction;
    rgb[0] = rgb[1] = rgb[2] = HOST_LIGHT;
    return INFINITY;
}

/* How far outside the picture the end of a direction is, in parts of its width; negative inside. */
static double outside_of(const double direction[3])
{
    const float *m = s.camera.view_from_world, *p = s.camera.clip_from_view;
    double v[3];
    for (int i = 0; i < 3; i++)
        v[i] = (double)m[i] * direction[0] + (double)m[4 + i] * direction[1] + (double)m[8 + i] * direction[2];
    return fmax(fabs(0.5 * (double)p[0] * v[0] / v[2]), fabs(0.5 * (double)p[5] * v[1] / v[2])) - 0.5;
}

/* Directions of view, of the ray that the water refracts, and of the one that it mirrors. */
static double refract_ray(const double ray[3], double seen[3], double in_water[3], double mirrored[3])
{
    const double length = sqrt(ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2]), across = hypot(ray[0], ray[2]);
    const double in = atan2(across, -ray[1]), out = asin(sin(in) / SHEET_WATER);
    for (int i = 0; i < 3; i++) {
        seen[i] = ray[i] / length;
        mirrored[i] = (i == 1 ? -1 : 1) * seen[i];
        in_water[i] = i == 1 ? -cos(out) : sin(out) * ray[i] / across;
    }
    return sheet_reflectance(in, out);
}

/* Nothing under the water: rays go on for ever. Where they end outside the picture by a sixteenth of it, the light is
 * the environment's; where they end inside, it is that of the host's picture, which has the host's sky. */
static void rays_that_leave_the_picture_see_the_environment(void **state)
{
    (void)state;
    static const double eyes[3][3] = {{0, 0.3, 0.3}, {0.1, 0.25, 0.35}, {-0.15, 0.35, 0.2}};
    uint32_t left = 0, stayed = 0;
    double worst = 0;
    shot_open(&s, SIDE, SIDE);
    s.scene = open_scene;
    s.fov_deg = OPEN_FOV_DEG;
    sheet_fill(&s);
    for (int c = 0; c < 3; c++)
        s.f.settings.absorption_1_m[c] = s.f.settings.scattering_1_m[c] = 0;
    for (int i = 0; i < 3; i++) {
        shot_aim(&s, eyes[i], origin);
        shot_draw(&s);
        for (uint32_t k = 0; k < SIDE * SIDE; k++) {
            double ray[3], seen[3], in_water[3], mirrored[3], between[3];
            shot_ray(&s, k % SIDE + 0.5, k / SIDE + 0.5, ray);
            const double share = refract_ray(ray, seen, in_water, mirrored);
            /* A layer of water turns the ray less: it ends between both directions, nearer to that in the water. */
            for (int axis = 0; axis < 3; axis++)
                between[axis] = 0.4 * seen[axis] + 0.6 * in_water[axis];
            const bool leaves = outside_of(between) > 1.0 / 16 && outside_of(in_water) > 1.0 / 16;
            if (!leaves && !(outside_of(in_water) < -0.01))
                continue;
            left += leaves;
            stayed += !leaves;
            for (int c = 0; c < 3; c++) {
                const double through = leaves ? sheet_sky(&s, in_water, c) : HOST_LIGHT;
                const double expected = (1 - share) * through + share * sheet_sky(&s, mirrored, c);
                worst = fmax(worst, fabs((double)s.pixels[4 * k + (size_t)c] - expected));
            }
        }
    }
    printf("%u rays that leave the picture and %u that do not: off by up to %g\n", left, stayed, worst);
    REQUIRE(left > 2000 && stayed > 2000);
    REQUIRE(worst < 2e-3);
    shot_close(&s);
}

/* ---- a red slab under the sheet */

#define SLAB_M 0.05 /* half of its side */

static double slab_low, slab_high; /* its lower and its upper face (m) */

/* Where a ray meets the slab, or INFINITY. */
static double slab_distance(const double eye[3], const double direction[3])
{
    const double low[3] = {-SLAB_M, slab_low, -SLAB_M}, high[3] = {SLAB_M, slab_high, SLAB_M};
    double near = 0, far = INFINITY;
    for (int i = 0; i < 3; i++) {
        const double a = (low[i] - eye[i]) / direction[i], b = (high[i] - eye[i]) / direction[i];
        near = fmax(near, fmin(a, b));
        far = fmin(far, fmax(a, b));
    }
    return near < far ? near : INFINITY;
}

static double slab_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    const double slab = slab_distance(eye, direction), distance = floor_scene(of, eye, direction, rgb);
    rgb[0] = slab < distance ? 2 : 0;
    rgb[1] = rgb[2] = 0;
    return fmin(slab, distance);
}

static bool is_red(uint32_t x, uint32_t y)
{
    return x < SIDE && y < SIDE && shot_pixel(&s, x, y)[0] > 0.7f;
}

/* Removes the red piece that has the pixel, and returns its pixels. */
static uint32_t take_piece(uint32_t x, uint32_t y)
{
    if (!is_red(x, y))
        return 0;
    s.pixels[4 * (y * SIDE + x)] = 0;
    uint32_t sum = 1;
    for (uint32_t i = 0; i < 9; i++)
        sum += take_piece(x + i % 3 - 1, y + i / 3 - 1);
    return sum;
}

/* Clear water over a slab, without lamps. */
static void open_slab(void)
{
    shot_open(&s, SIDE, SIDE);
    s.scene = slab_scene;
    sheet_fill(&s);
    memset(&s.f.settings.lighting, 0, sizeof s.f.settings.lighting);
    for (int c = 0; c < 3; c++)
        s.f.settings.absorption_1_m[c] = s.f.settings.scattering_1_m[c] = 0;
}

/* Rays that pass behind its edge meet nothing that the picture shows. They must not show the slab a second time. */
static void an_object_under_water_has_no_outline_beside_it(void **state)
{
    (void)state;
    static const double eyes[3][3] = {{0, 0.6, 0.3}, {0.2, 0.35, 0.4}, {-0.3, 0.2, 0.4}};
    open_slab();
    for (int i = 0; i < 12; i++) {
        uint32_t whole = 0, beside = 0;
        slab_low = (const double[4]){-0.04, -0.09, -0.095, -0.09}[i / 3];
        slab_high = (const double[4]){-0.01, -0.01, -0.085, -0.07}[i / 3];
        shot_aim(&s, eyes[i % 3], (const double[3]){0, -0.05, 0});
        shot_draw(&s);
        shot_save(&s, (const char *[3]){"slab0", "slab1", "slab2"}[i % 3]);
        for (uint32_t k = 0; k < SIDE * SIDE; k++) {
            const uint32_t piece = take_piece(k % SIDE, k / SIDE), larger = piece > whole ? piece : whole;
            beside += piece + whole - larger;
            whole = larger;
        }
        printf("a slab of %u pixels, and %u beside it\n", whole, beside);
        REQUIRE(whole > 100);
        REQUIRE(beside == 0);
    }
    shot_close(&s);
}

/* Whether a ray that is refracted by the sheet meets the slab, at a point that the camera also sees without water, and
 * that is not at the slab's edge in the picture. */
static bool meets_slab(uint32_t x, uint32_t y)
{
    const float *m = s.camera.view_from_world, *p = s.camera.clip_from_view;
    const double *eye = s.camera.position_m;
    double ray[3], at[3], in[3], v[3];
    shot_ray(&s, x + 0.5, y + 0.5, ray);
    const double across = hypot(ray[0], ray[2]), t = -eye[1] / ray[1];
    const double out = asin(sin(atan2(across, -ray[1])) / SHEET_WATER);
    for (int i = 0; i < 3; i++) {
        at[i] = eye[i] + t * ray[i];
        in[i] = i == 1 ? -cos(out) : sin(out) * ray[i] / across;
    }
    const double distance = slab_distance(at, in);
    if (!isfinite(distance))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] = (double)m[i] * (at[0] + distance * in[0]) + (double)m[4 + i] * (at[1] + distance * in[1]) +
               (double)m[8 + i] * (at[2] + distance * in[2]) + (double)m[12 + i];
    const double px = (0.5 - 0.5 * (double)p[0] * v[0] / v[2]) * SIDE,
                 py = (0.5 - 0.5 * (double)p[5] * v[1] / v[2]) * SIDE;
    for (int i = 0; i < 9; i++) {
        double seen[3], rgb[3];
        shot_ray(&s, px + 1.5 * (i % 3 - 1), py + 1.5 * (i / 3 - 1), seen);
        const double to = shot_trace(&s, eye, seen, rgb);
        if (rgb[0] < 1 || (i == 4 && fabs(to + v[2]) > 1e-4))
            return false;
    }
    return true;
}

/* The way to the floor behind it may lead past it. */
static void an_object_under_water_is_whole(void **state)
{
    (void)state;
    static const double eyes[4][3] = {{0, 0.6, 0.3}, {0.2, 0.35, 0.4}, {-0.3, 0.2, 0.4}, {0.25, 0.16, 0.25}};
    open_slab();
    uint32_t met = 0, missed = 0;
    for (int i = 0; i < 8; i++) {
        slab_low = -0.05;
        slab_high = i < 4 ? -0.04 : -0.02;
        shot_aim(&s, eyes[i % 4], (const double[3]){0, -0.05, 0});
        shot_draw(&s);
        shot_save(&s, (const char *[4]){"whole0", "whole1", "whole2", "whole3"}[i % 4]);
        for (uint32_t k = 0; k < SIDE * SIDE; k++)
            if (meets_slab(k % SIDE, k / SIDE)) {
                met++;
                missed += !is_red(k % SIDE, k / SIDE);
            }
        printf("%u pixels show a slab, %u should and do not\n", met, missed);
    }
    shot_close(&s);
    REQUIRE(met > 2000);
    REQUIRE(missed <= met / 500); /* the slab is a few pixels high from the side */
}

/* ---- thickness */

static double black_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of, (void)eye, (void)direction;
    rgb[0] = rgb[1] = rgb[2] = 1;
    return INFINITY;
}

/* Nothing but absorption, and no refraction: the light that is left is the chord's. */
static void check_thickness(double distance, double share)
{
    const double radius = 0.2, at[3] = {0, 0, distance};
    shot_aim(&s, at, origin);
    shot_draw(&s);
    double worst = 0;
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
            double ray[3];
            shot_ray(&s, x + 0.5, y + 0.5, ray);
            const double tangent = hypot(ray[0], ray[1]), miss = distance * tangent / sqrt(1 + tangent * tangent);
            if (miss > share * radius)
                continue;
            const double chord = 2 * sqrt(radius * radius - miss * miss);
            const double in = asin(miss / radius), out = asin(sin(in) / SHEET_WATER);
            /* The layer below the surface that has the chord as its thickness along the view, see path_of. */
            const double path = chord * cos(in) / cos(out),
                         left = (double)shot_pixel(&s, x, y)[0] /
                                (1 - sheet_reflectance(fmax(in, 1e-4), fmax(out, 0.75e-4)));
            worst = fmax(worst, fabs(-log(left) - path) / chord);
        }
    printf("a ball at %g m: thickness off by %.3f of the chord\n", distance, worst);
    REQUIRE(worst < 0.05);
}

static void the_thickness_of_a_ball_is_its_chord(void **state)
{
    (void)state;
    shot_open(&s, SIDE, SIDE);
    s.scene = black_scene;
    memset(&s.f.settings.lighting, 0, sizeof s.f.settings.lighting);
    s.f.settings.spacing_m = 0.2f / 12;
    s.f.settings.refraction = 0;
    for (int c = 0; c < 3; c++)
        s.f.settings.absorption_1_m[c] = 1;
    water_fixture_shells(&s.f, origin, 0.2, 0.2 / 12);
    /* Texels of the thickness are 4 pixels wide, so the chord is blurred towards the border of a small ball. */
    check_thickness(0.5, 0.8);
    check_thickness(0.6, 0.8);
    check_thickness(1.2, 0.6);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_sheet_reflects_refracts_and_absorbs_as_fresnel_snell_and_beer_say),
        cmocka_unit_test(rays_that_leave_the_picture_see_the_environment),
        cmocka_unit_test(an_object_under_water_has_no_outline_beside_it),
        cmocka_unit_test(an_object_under_water_is_whole),
        cmocka_unit_test(the_thickness_of_a_ball_is_its_chord),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
