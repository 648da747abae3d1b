/* test_glass_force.c - what pulls at drops: the motion of the car, the slope of a bent pane, a mesh's, the structure
 * of a surface. Each against its closed form: a drop of base radius a runs when the field along the pane exceeds
 * hold a / mass, and then in the field's direction. */
#include "glass_even_fixture.h"

#define CREEP 60 /* times the resistance: a drop comes to its direction and hardly moves */

static void open_creeping(const virga_glass_shape *shape)
{
    open_even(NULL);
    f.settings.drag = CREEP;
    if (shape)
        REQUIRE(virga_glass_shape_set(f.glass, shape) == VIRGA_OK);
}

/* Base radius of the smallest drop that runs in a field (m/s^2) along the pane. */
static double running_radius(double field)
{
    return sqrt(glass_hold(&f.settings) /
                (VIRGA_WATER_DENSITY * field * glass_cap_volume(glass_rest_deg(&f.settings))));
}

static const virga_glass_drop_gpu *drop_of(uint32_t id)
{
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (f.drops[i].id == id && glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP)
            return &f.drops[i];
    return NULL;
}

static bool ran(uint32_t id)
{
    const virga_glass_drop_gpu *drop = drop_of(id);
    return !drop || drop->velocity[0] != 0 || drop->velocity[1] != 0;
}

/* The direction that a drop has come to, against a field's: to so many radians. */
static void assert_direction(uint32_t id, double u, double v, double radians)
{
    const virga_glass_drop_gpu *drop = drop_of(id);
    REQUIRE(drop && ran(id));
    const double found = atan2((double)drop->velocity[1], (double)drop->velocity[0]), expected = atan2(v, u);
    print_message("direction %.4f, expected %.4f\n", found, expected);
    assert_true(fabs(remainder(found - expected, 2 * M_PI)) < radians);
}

/* ---- the car */

/* Field: gravity and what the car's acceleration leaves behind; 2 % around the radius that it just sets in motion. */
static void acceleration_of_the_car_sets_drops_in_motion(void **unused)
{
    (void)unused;
    for (int pushed = 0; pushed < 2; pushed++) {
        open_creeping(NULL);
        f.info.acceleration_m_s2[0] = pushed ? 8 : 0;
        const double critical = running_radius(hypot(8, VIRGA_GRAVITY));
        const uint32_t less = glass_fixture_land(&f, 0.04, 0.08, water_of(critical * 0.98))->id;
        const uint32_t more = glass_fixture_land(&f, 0.12, 0.08, water_of(critical * 1.02))->id;
        glass_fixture_step(&f, 30, true);
        assert_false(ran(less));
        assert_int_equal(ran(more), pushed);
        if (pushed)
            assert_direction(more, -8, -VIRGA_GRAVITY, 2e-3);
        glass_fixture_close(&f);
    }
}

/* A pane that lies flat and rotates about its corner: w^2 r outwards. */
static void a_turning_pane_throws_drops_outwards(void **unused)
{
    (void)unused;
    open_creeping(NULL);
    const double w = 7, radius = 3e-3;
    const double field = glass_hold(&f.settings) * radius / (water_of(radius) * 0.9982e-9), at = field / (w * w);
    REQUIRE(at > 0.07 && at < 0.12);
    f.info.world_from_pane[0] = f.info.world_from_pane[7] = 1;
    f.info.world_from_pane[5] = -1;
    f.info.angular_velocity_rad_s[1] = (float)w;
    const uint32_t held = glass_fixture_land(&f, 0.97 * at * 0.6, 0.97 * at * 0.8, water_of(radius))->id;
    const uint32_t thrown = glass_fixture_land(&f, 1.03 * at * 0.8, 1.03 * at * 0.6, water_of(radius))->id;
    glass_fixture_step(&f, 20, true);
    assert_false(ran(held));
    assert_direction(thrown, 0.8, 0.6, 2e-3);
    glass_fixture_close(&f);
}

/* Air that comes straight down on a level pane spreads from its middle in proportion to the distance: half of it at
 * the edge, and its force with the square. Air from the other side does not. */
static void air_from_ahead_blows_drops_outwards(void **unused)
{
    (void)unused;
    const double speed = 60, radius = 2e-3;
    for (int behind = 0; behind < 2; behind++) {
        open_creeping(NULL);
        f.settings.air_share = 0.8f;
        f.settings.air_outward = 0.5f;
        const double angle = glass_rest_deg(&f.settings) * M_PI / 180;
        const double section = (angle - sin(angle) * cos(angle)) / (sin(angle) * sin(angle));
        const double drag = 0.5 * VIRGA_AIR_DENSITY * 0.9 * section * radius * radius;
        const double at = sqrt(glass_hold(&f.settings) * radius / drag) / (0.8 * 0.5 * speed); /* in half widths */
        REQUIRE(at > 0.2 && at < 0.9);
        f.info.world_from_pane[0] = f.info.world_from_pane[7] = 1;
        f.info.world_from_pane[5] = -1;
        f.info.wind_m_s[1] = (float)(behind ? speed : -speed);
        const uint32_t held = glass_fixture_land(&f, 0.08 + 0.97 * at * 0.08, 0.06, water_of(radius))->id;
        const uint32_t blown = glass_fixture_land(&f, 0.08 - 1.03 * at * 0.08, 0.06, water_of(radius))->id;
        glass_fixture_step(&f, 10, true);
        assert_false(ran(held));
        assert_int_equal(ran(blown), !behind);
        if (!behind)
            assert_direction(blown, -1, 0, 2e-3);
        glass_fixture_close(&f);
    }
}

/* ---- bent panes */

enum { POINTS = 33 };

/* A quarter of a cylinder that lies along u: upright at its foot, level at its top. */
static virga_glass_shape quarter(float positions[POINTS * 2 * 3], double radius_m)
{
    virga_glass_shape shape = virga_default_glass_shape();
    for (int i = 0; i < POINTS * 2; i++) {
        const double angle = M_PI / 2 * (i / 2) / (POINTS - 1.0);
        positions[3 * i] = i % 2 ? 0.16f : 0;
        positions[3 * i + 1] = (float)(radius_m * sin(angle));
        positions[3 * i + 2] = (float)(radius_m * cos(angle));
    }
    shape.positions = positions;
    shape.columns = 2;
    shape.rows = POINTS;
    return shape;
}

/* A drop of radius a runs where g cos(angle) is enough; 2 mm above and below that height. */
static void a_bent_pane_holds_drops_by_its_slope_where_they_are(void **unused)
{
    (void)unused;
    float positions[POINTS * 2 * 3];
    const double bend = 0.12 / (M_PI / 2), radius = 2.6e-3;
    const virga_glass_shape shape = quarter(positions, bend);
    open_creeping(&shape);
    const double ratio = running_radius(VIRGA_GRAVITY) / radius, height = bend * acos(ratio * ratio);
    const uint32_t above = glass_fixture_land(&f, 0.04, height + 2e-3, water_of(radius))->id;
    const uint32_t below = glass_fixture_land(&f, 0.12, height - 2e-3, water_of(radius))->id;
    glass_fixture_step(&f, 30, true);
    assert_false(ran(above));
    assert_true(ran(below));
    glass_fixture_close(&f);
}

/* Beside the middle of a raked windshield whose tangent has turned by p, gravity is (sin p sin rake, -cos rake). */
static void drops_on_a_windshields_side_run_outwards(void **unused)
{
    (void)unused;
    static float positions[POINTS * POINTS * 3];
    const double rake = 50 * M_PI / 180, bend = 0.12;
    virga_glass_shape shape = virga_default_glass_shape();
    virga_glass_fill_windshield(0.16f, 0.12f, 50, (float)bend, POINTS, POINTS, positions);
    shape.positions = positions;
    shape.columns = shape.rows = POINTS;
    open_creeping(&shape);
    const uint32_t id = glass_fixture_land(&f, 0.125, 0.09, water_of(4e-3))->id;
    glass_fixture_step(&f, 30, true);
    const double p = ((double)drop_of(id)->position[0] - 0.08) / bend;
    assert_direction(id, sin(p) * sin(rake), -cos(rake), 5e-3);
    glass_fixture_close(&f);
}

/* A blade lies on the surface: it wipes the same cells of a bent pane as of a flat one. */
static void a_blade_follows_a_bent_pane(void **unused)
{
    (void)unused;
    float positions[POINTS * 2 * 3];
    const virga_glass_shape shape = quarter(positions, 0.12 / (M_PI / 2));
    bool left[2][80];
    uint32_t gone = 0;
    for (int bent = 0; bent < 2; bent++) {
        uint32_t ids[80];
        open_creeping(bent ? &shape : NULL);
        f.settings.wiper_count = 1;
        f.settings.wipers[0] = virga_default_glass_wiper();
        f.settings.wipers[0].pivot_m[0] = 0.08f;
        f.settings.wipers[0].reach_m = 0.1f;
        f.settings.wipers[0].blade_m = 0.09f;
        f.settings.wipers[0].drive = VIRGA_GLASS_HOST;
        f.settings.wipers[0].host_deg = 30;
        for (int i = 0; i < 80; i++)
            ids[i] = glass_fixture_land(&f, 0.011 + 0.0152 * (i % 10), 0.011 + 0.0136 * (double)(i / 10), 500)->id;
        glass_fixture_step(&f, 1, false);
        f.settings.wipers[0].host_deg = 130;
        glass_fixture_step(&f, 20, true);
        for (int i = 0; i < 80; i++) {
            left[bent][i] = drop_of(ids[i]) != NULL;
            gone += !left[bent][i];
        }
        glass_fixture_close(&f);
    }
    assert_memory_equal(left[0], left[1], sizeof left[0]);
    assert_in_range(gone, 40, 120);
}

/* ---- meshes */

/* A flat mesh whose u points down to the right by 30 degrees, on a body that accelerates and is turned too. */
static void drops_on_a_mesh_run_along_its_own_axes(void **unused)
{
    (void)unused;
    const float s = 0.5f, c = 0.8660254f, w = 0.16f, h = 0.12f;
    const float at[4][3] = {{0, 0, 0}, {w * c, -w * s, 0}, {w * c + h * s, h * c - w * s, 0}, {h * s, h * c, 0}};
    const float uvs[4][2] = {{0, 0}, {w, 0}, {w, h}, {0, h}};
    const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    float grid[9 * 9 * 3];
    uint8_t mask[9 * 9];
    virga_glass_shape shape = virga_default_glass_shape();
    REQUIRE(virga_glass_fill_from_mesh(at[0], uvs[0], 4, indices, 6, w, h, 9, 9, grid, mask) == VIRGA_OK);
    shape.positions = grid;
    shape.columns = shape.rows = shape.mask_columns = shape.mask_rows = 9;
    shape.mask = mask;
    for (int turned = 0; turned < 2; turned++) {
        open_creeping(&shape);
        if (turned) { /* a quarter turn about z: its x points up, its y to the left */
            const float quarter_turn[9] = {0, 1, 0, -1, 0, 0, 0, 0, 1};
            memcpy(f.info.world_from_pane, quarter_turn, sizeof quarter_turn);
            f.info.acceleration_m_s2[0] = 5;
        }
        const uint32_t id = glass_fixture_land(&f, 0.08, 0.06, water_of(4e-3))->id;
        glass_fixture_step(&f, 30, true);
        const double x = turned ? -VIRGA_GRAVITY : 0, y = turned ? 5 : -VIRGA_GRAVITY; /* in the body's frame */
        assert_direction(id, x * (double)c - y * (double)s, x * (double)s + y * (double)c, 2e-3);
        glass_fixture_close(&f);
    }
}

/* ---- bump maps: Chen and Zhang, section IV */

enum { BUMPS = 64 };

/* What a cell knows of the pane that waits for its first step: affinity in standard deviations, slopes of the unit
 * normal in 1/128. */
static uint32_t cell_word(uint32_t column, uint32_t row)
{
    const uint32_t *words = f.glass->surface_upload->memory.block.mapped;
    return words[column + row * f.glass->columns];
}

static virga_glass_shape bumpy(const float *heights, double size_m)
{
    virga_glass_shape shape = virga_default_glass_shape();
    shape.bumps_m = heights;
    shape.bump_columns = shape.bump_rows = BUMPS;
    shape.bump_width_m = shape.bump_height_m = (float)size_m;
    return shape;
}

/* Waves of 16 mm along u: h = a sin(k u). The normal's part along u is -h' / sqrt(1 + h'^2), with h' over a cell the
 * derivative times sin(k cell / 2) / (k cell / 2); to a step of 1/128 and 2 % for the map's straight lines. */
static void cells_know_the_bump_maps_normal(void **unused)
{
    (void)unused;
    float heights[BUMPS * BUMPS];
    const double size = 0.016, k = 2 * M_PI / size, a = 1e-3, half = k * 1e-3;
    for (int i = 0; i < BUMPS * BUMPS; i++)
        heights[i] = (float)(a * sin(2 * M_PI * (i % BUMPS) / BUMPS));
    const virga_glass_shape shape = bumpy(heights, size);
    open_creeping(&shape);
    for (uint32_t column = 0; column < f.glass->columns; column++) {
        const double slope = a * k * cos(k * (column + 0.5) * 2e-3) * sin(half) / half;
        const double expected = -slope / sqrt(1 + slope * slope);
        const uint32_t word = cell_word(column, 7);
        assert_true(fabs(((word >> 8 & 0xff) - 128.0) / 128 - expected) < 1 / 128.0 + 0.02 * fabs(expected));
        assert_int_equal(word >> 16 & 0xff, 128);
    }
    glass_fixture_close(&f);
}

/* Hollows attract drops: a cell's affinity, in standard deviations, is the glass's less
 * `pull` times its height's. */
static void hollows_have_more_affinity(void **unused)
{
    (void)unused;
    float heights[BUMPS * BUMPS];
    uint8_t even[80];
    const double size = 0.016, pull = 0.7;
    for (int i = 0; i < BUMPS * BUMPS; i++)
        heights[i] = (float)(1e-3 * sin(2 * M_PI * (i % BUMPS) / BUMPS));
    open_creeping(NULL);
    for (uint32_t column = 0; column < 80; column++)
        even[column] = (uint8_t)cell_word(column, 7);
    virga_glass_shape shape = bumpy(heights, size);
    shape.bump_affinity = (float)pull;
    REQUIRE(virga_glass_shape_set(f.glass, &shape) == VIRGA_OK);
    for (uint32_t column = 0; column < 80; column++) {
        /* The deviation of a sine is its amplitude over the root of 2; bytes are 1/32, and end at 0 and 255. */
        const double more = -pull * sqrt(2) * sin(2 * M_PI * (column + 0.5) * 2e-3 / size) * 32;
        assert_true(fabs((cell_word(column, 7) & 0xff) - fmin(fmax(even[column] + more, 0), 255)) < 1.6);
    }
    glass_fixture_close(&f);
}

/* Equation 14: of the force F the part F - (N . F) N is left. On a slope of k both ways, with F = (0, -1, 0) and
 * N = (-k, -k, 1) / sqrt(1 + 2 k^2), its direction is (k^2, -1 - k^2) along the pane. */
static void a_slope_of_the_bump_map_deflects_the_force(void **unused)
{
    (void)unused;
    float heights[BUMPS * BUMPS];
    const double k = 0.9, size = 0.4; /* the ramp's break lies beyond the pane */
    for (int i = 0; i < BUMPS * BUMPS; i++)
        heights[i] = (float)(k * size / BUMPS * (i % BUMPS + i / BUMPS));
    virga_glass_shape shape = bumpy(heights, size);
    shape.bump_affinity = 0;
    open_creeping(&shape);
    const uint32_t id = glass_fixture_land(&f, 0.08, 0.06, water_of(4e-3))->id;
    glass_fixture_step(&f, 30, true);
    assert_direction(id, k * k, -1 - k * k, 8e-3); /* normals are kept in steps of 1/128 */
    glass_fixture_close(&f);
}

/* The probability of a step follows the affinity, so drops that come down beside a groove end nearer to it. */
static double mean_way_from_groove(float pull)
{
    float heights[BUMPS * BUMPS];
    uint32_t ids[12];
    double sum = 0;
    uint32_t found = 0;
    for (int i = 0; i < BUMPS * BUMPS; i++) /* grooves in the middle of each 40 mm */
        heights[i] = (float)(2e-5 * cos(2 * M_PI * (i % BUMPS) / BUMPS));
    virga_glass_shape shape = bumpy(heights, 0.04);
    shape.bump_affinity = pull;
    open_creeping(&shape);
    f.settings.affinity = 0.5f;
    f.settings.meander = 1;
    f.settings.path_ease = 0;
    f.settings.merge_distance = 0; /* those that come together stay two */
    f.settings.drag = 4;
    for (int i = 0; i < 12; i++)
        ids[i] = glass_fixture_land(&f, 0.02 + 0.04 * (i % 4) + (i % 2 ? 0.007 : -0.007),
                                    0.115 - 0.012 * (double)(i / 4), water_of(2.9e-3))
                     ->id;
    for (int i = 0; i < 4; i++)
        glass_fixture_step(&f, 20, true);
    for (int i = 0; i < 12; i++) {
        const virga_glass_drop_gpu *drop = drop_of(ids[i]);
        if (!drop || !ran(ids[i]))
            continue;
        sum += fabs(remainder((double)drop->position[0] - 0.02, 0.04));
        found++;
    }
    glass_fixture_close(&f);
    print_message("%u drops at %.4f m from a groove\n", found, sum / found);
    REQUIRE(found > 3);
    return sum / found;
}

static void drops_gather_in_grooves(void **unused)
{
    (void)unused;
    assert_true(mean_way_from_groove(4) < 0.6 * mean_way_from_groove(0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(acceleration_of_the_car_sets_drops_in_motion),
        cmocka_unit_test(a_turning_pane_throws_drops_outwards),
        cmocka_unit_test(air_from_ahead_blows_drops_outwards),
        cmocka_unit_test(a_bent_pane_holds_drops_by_its_slope_where_they_are),
        cmocka_unit_test(drops_on_a_windshields_side_run_outwards),
        cmocka_unit_test(a_blade_follows_a_bent_pane),
        cmocka_unit_test(drops_on_a_mesh_run_along_its_own_axes),
        cmocka_unit_test(cells_know_the_bump_maps_normal),
        cmocka_unit_test(hollows_have_more_affinity),
        cmocka_unit_test(a_slope_of_the_bump_map_deflects_the_force),
        cmocka_unit_test(drops_gather_in_grooves),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
