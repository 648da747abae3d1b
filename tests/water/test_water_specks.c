/* Droplets that are smaller than a pixel: what they cover, and what is behind them. */
#include "water_picture_fixture.h"

#define SIDE      128
#define SPACING_M 0.02
#define EACH      5 /* droplets along each axis */

static shot s;

static const double origin[3] = {0, 0, 0};

static double empty_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of, (void)eye, (void)direction;
    rgb[0] = rgb[1] = rgb[2] = 0.5;
    return INFINITY;
}

/* Particles all alone become a droplet each. */
static void open_spray(void)
{
    virga_water_def def = water_fixture_def();
    def.max_width = def.max_height = SIDE;
    def.max_cells = 262144;
    shot_open_with(&s, &def, SIDE, SIDE, false);
    s.scene = empty_scene;
    s.f.settings.spacing_m = (float)SPACING_M;
    s.f.settings.style = VIRGA_WATER_STYLE_PAPER;
    s.f.settings.spray_density = 0.35f;
    s.f.settings.spray_pieces = 1;
}

/* Radius of a droplet (m): equation 3. */
static double droplet_radius(void)
{
    return cbrt(3 / (4 * M_PI)) * SPACING_M;
}

/* Pixels of a metre at the distance. */
static double pixels_at(double distance)
{
    return 0.5 * SIDE / tan(FOV_DEG * M_PI / 360) / distance;
}

/* Droplets 20 pixels apart, but no more than a metre, in a plane that faces the camera. */
static void add_droplets(double distance, double z)
{
    const double step = fmin(20 / pixels_at(distance), 1);
    uint32_t hash = 3;
    for (int i = 0; i < EACH * EACH; i++)
        water_fixture_add(&s.f, step * (i % EACH - EACH / 2) + water_random(&hash, -0.05, 0.05) * step,
                          step * (i / EACH - EACH / 2) + water_random(&hash, -0.05, 0.05) * step, z);
}

/* Pixels that a droplet covers, as the mean over all of them. */
static double covered_px(double radius_px)
{
    const double distance = droplet_radius() * pixels_at(1) / radius_px, at[3] = {0, 0, distance};
    s.f.count = 0;
    add_droplets(distance, 0);
    shot_aim(&s, at, origin);
    shot_draw(&s);
    REQUIRE(s.f.stats.droplets == EACH * EACH);
    return shot_covered(&s) / (EACH * EACH);
}

static void a_droplet_covers_its_disc_whatever_its_size(void **state)
{
    (void)state;
    static const double radii[] = {0.05, 0.1, 0.2, 0.5, 0.8, 1.2, 1.6, 2, 2.4, 3, 5};
    double worst[2] = {0}; /* of specks, and of droplets with a surface, whose rim is closed as that of water is */
    open_spray();
    for (size_t i = 0; i < sizeof radii / sizeof radii[0]; i++) {
        const double share = covered_px(radii[i]) / (M_PI * radii[i] * radii[i]);
        printf("a droplet of %g px covers %.3f of its disc\n", radii[i], share);
        const int row = radii[i] > 2;
        worst[row] = fmax(worst[row], fabs(share - 1));
    }
    shot_close(&s);
    REQUIRE(worst[0] < 0.12 && worst[1] < 0.2);
}

/* A droplet of 0.8 px that comes 24 px along x while the shutter is open covers as much as at rest, around the middle
 * of its way. The variance along x grows by L^2 / 12. */
static void a_speck_that_moves_leaves_a_streak_with_the_same_cover(void **state)
{
    (void)state;
    const double distance = droplet_radius() * pixels_at(1) / 0.8, at[3] = {0, 0, distance}, length = 24;
    double covered[2], middle[2], variance[2];
    open_spray();
    s.open_shutter_s = 0.02;
    for (int moves = 0; moves < 2; moves++) {
        double sums[3] = {0};
        s.f.count = 0;
        water_fixture_add(&s.f, 0, 0, 0)->velocity[0] =
            moves ? (float)(length / pixels_at(distance) / s.open_shutter_s) : 0;
        shot_aim(&s, at, origin);
        shot_draw(&s);
        for (int i = 0; i < SIDE * SIDE; i++)
            for (int k = 0; k < 3; k++)
                sums[k] += (double)s.pixels[4 * i + 3] * pow(i % SIDE + 0.5, k);
        covered[moves] = sums[0];
        middle[moves] = sums[1] / sums[0];
        variance[moves] = sums[2] / sums[0] - middle[moves] * middle[moves];
    }
    printf("covers %.3f px at rest and %.3f, with its middle at %.2f and %.2f; deviation %.3f px\n", covered[0],
           covered[1], middle[0], middle[1], sqrt(variance[1] - variance[0]));
    assert_float_equal(covered[1] / covered[0], 1, 0.05);
    assert_float_equal(middle[1] - middle[0], -0.5 * length, 0.2);
    assert_float_equal(sqrt(variance[1] - variance[0]), length / sqrt(12), 0.2);
    shot_close(&s);
}

#define WALL    50  /* particles along its sides */
#define WALL_M  1.0 /* its width */
#define APART_M 0.2 /* from the wall to the droplets */

/* The least that the wall covers behind droplets of a radius. */
static double least_covered(double radius_px)
{
    const double distance = droplet_radius() * pixels_at(1) / radius_px, at[3] = {0, 0, distance};
    const double low[3] = {-0.5 * WALL_M, -0.5 * WALL_M, -APART_M - 3 * SPACING_M};
    const uint32_t counts[3] = {WALL, WALL, 3};
    const double half = fmin(0.5 * WALL_M * pixels_at(distance + APART_M) - 4, 0.5 * SIDE - 1);
    const double step = 1.6 * half / EACH / pixels_at(distance);
    float least = 1;
    s.f.count = 0;
    for (int i = 0; i < EACH * EACH; i++)
        water_fixture_add(&s.f, step * (i % EACH - EACH / 2 + 0.03 * (i % 7)), step * (i / EACH - EACH / 2), 0);
    water_fixture_box(&s.f, low, counts, SPACING_M, 0);
    shot_aim(&s, at, origin);
    shot_draw(&s);
    REQUIRE(s.f.stats.droplets == EACH * EACH);
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++)
            if (fmax(fabs(x + 0.5 - 0.5 * SIDE), fabs(y + 0.5 - 0.5 * SIDE)) < half)
                least = fminf(least, shot_pixel(&s, x, y)[3]);
    return (double)least;
}

static void droplets_make_no_holes_in_water_behind_them(void **state)
{
    (void)state;
    static const double radii[] = {0.3, 0.8, 1.2, 1.8, 2.4, 3, 4};
    double worst = 1;
    open_spray();
    for (size_t i = 0; i < sizeof radii / sizeof radii[0]; i++) {
        const double least = least_covered(radii[i]);
        printf("a wall of water behind droplets of %g px covers %.3f at least\n", radii[i], least);
        worst = fmin(worst, least);
    }
    shot_close(&s);
    REQUIRE(worst > 0.98);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_droplet_covers_its_disc_whatever_its_size),
        cmocka_unit_test(a_speck_that_moves_leaves_a_streak_with_the_same_cover),
        cmocka_unit_test(droplets_make_no_holes_in_water_behind_them),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
