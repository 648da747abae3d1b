/* Pictures to look at, in VIRGA_TEST_PICTURES; without it nothing is drawn. A ball, a cloud of drops, and the frames of
 * a dam break where they are. */
#include "../host/test_particles.h"
#include "water_picture_fixture.h"

#include "ply.h"

#define WIDTH  1280
#define HEIGHT 720

static shot s;

static void light_up(void)
{
    virga_lighting *lighting = &s.f.settings.lighting;
    memset(lighting, 0, sizeof *lighting);
    /* The harmonics of the sky of shot_checkers, by summation. */
    double sh[9][3] = {{0}};
    const int rows = 64, columns = 128;
    for (int row = 0; row < rows; row++)
        for (int column = 0; column < columns; column++) {
            const double theta = M_PI * (row + 0.5) / rows, phi = 2 * M_PI * (column + 0.5) / columns;
            const double d[3] = {sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi)}, eye[3] = {0, 0.5, 0};
            const double area = sin(theta) * M_PI / rows * 2 * M_PI / columns;
            const double basis[9] = {0.282095,
                                     0.488603 * d[1],
                                     0.488603 * d[2],
                                     0.488603 * d[0],
                                     1.092548 * d[0] * d[1],
                                     1.092548 * d[1] * d[2],
                                     0.315392 * (3 * d[2] * d[2] - 1),
                                     1.092548 * d[0] * d[2],
                                     0.546274 * (d[0] * d[0] - d[1] * d[1])};
            double rgb[3];
            s.scene(&s, eye, d, rgb);
            for (int i = 0; i < 9; i++)
                for (int c = 0; c < 3; c++)
                    sh[i][c] += area * basis[i] * rgb[c];
        }
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            lighting->environment_sh[i][c] = (float)sh[i][c];
    lighting->light_count = 1;
    lighting->lights[0] = (virga_light){.position_m = {4, 6, 2}, .intensity = {120, 110, 90}};
}

static void open_look(void)
{
    virga_water_def def = water_fixture_def();
    def.max_particles = 262144;
    def.max_cells = 1048576;
    def.max_blocks = 131072;
    def.max_surfels = 2097152;
    def.max_width = WIDTH;
    def.max_height = HEIGHT;
    shot_open_with(&s, &def, WIDTH, HEIGHT, true);
    light_up();
}

/* Draws and saves a picture, and prints what it took. */
static void look(const char *name)
{
    virga_pass_time times[32];
    shot_draw(&s);
    shot_save(&s, name);
    const uint32_t count = virga_timings_get(s.f.context, times, 32);
    printf("%s: %u particles, %u surfels\n", name, s.f.count, s.f.stats.surfels);
    for (uint32_t i = 0; i < count && i < 32; i++)
        printf("    %-24s %8.1f ms\n", times[i].name, times[i].milliseconds);
}

static void a_ball(void **state)
{
    (void)state;
    const double at[3] = {0.5, 0.45, 0.9}, to[3] = {0, 0.2, 0}, center[3] = {0, 0.22, 0};
    open_look();
    s.f.settings.kernel = VIRGA_WATER_KERNEL_ANISOTROPIC;
    s.f.settings.spacing_m = 0.015f;
    water_fixture_ball(&s.f, center, 0.2, 0.015);
    shot_aim(&s, at, to);
    look("ball");
    shot_close(&s);
}

static void a_cloud(void **state)
{
    (void)state;
    const double at[3] = {0.5, 0.45, 0.9}, to[3] = {0, 0.2, 0};
    const double low[3] = {-0.25, 0.005, -0.25};
    const uint32_t counts[3] = {50, 8, 50};
    uint32_t hash = 5;
    open_look();
    s.f.settings.kernel = VIRGA_WATER_KERNEL_ANISOTROPIC;
    s.f.settings.spray_density = 0.35f;
    s.f.settings.spacing_m = 0.01f;
    water_fixture_box(&s.f, low, counts, 0.01, 0.2);
    for (int i = 0; i < 6000; i++) {
        const double phi = water_random(&hash, 0, 6.28), r = 0.1 * sqrt(water_random(&hash, 0, 1));
        const double up = water_random(&hash, 0, 1), wide = 1 + 1.5 * up;
        water_fixture_add(&s.f, wide * r * cos(phi), 0.08 + 0.35 * up * up, wide * r * sin(phi));
    }
    shot_aim(&s, at, to);
    look("cloud");
    shot_close(&s);
}

/* 208,125 particles in a pool with waves. */
static void a_pool(void **state)
{
    (void)state;
    const double at[3] = {0.4, 0.95, 1.5}, to[3] = {0, 0.35, 0}, d = 1.0 / 75;
    open_look();
    s.f.settings.kernel = VIRGA_WATER_KERNEL_ANISOTROPIC;
    s.f.settings.spacing_m = (float)d;
    for (int z = 0; z < 75; z++)
        for (int y = 0; y < 37; y++)
            for (int x = 0; x < 75; x++) {
                const double u = d * (x - 37), v = d * (z - 37), up = d * (y + 0.5);
                const double wave = 0.03 * sin(9 * u + 3 * v) + 0.015 * sin(20 * v - 11 * u + 1);
                water_fixture_add(&s.f, u, up * (1 + wave / 0.5), v);
            }
    shot_aim(&s, at, to);
    look("pool");
    shot_close(&s);
}

static void a_dam_break(void **state)
{
    (void)state;
    static const int frames[] = {20, 50, 60, 100, 120};
    open_look();
    s.f.settings.kernel = VIRGA_WATER_KERNEL_ANISOTROPIC;
    s.f.settings.spray_density = 0.35f;
    s.f.settings.spacing_m = 0.025f;
    s.f.settings.volume_m3 = 0.8f * 0.025f * 0.025f * 0.025f;
    for (int k = 0; k < 5; k++) {
        char file[64], name[64], error[256];
        ply_points points = {0};
        snprintf(file, sizeof file, "dam_break_%04d.ply", frames[k]);
        if (!ply_read(test_particles_path(file), &points, error, sizeof error))
            break;
        s.f.count = 0;
        for (uint64_t i = 0; i < points.count; i++) {
            const union ply_value *row = &points.values[i * points.property_count];
            water_fixture_add(&s.f, (double)row[0].real, (double)row[1].real, (double)row[2].real);
        }
        ply_free(&points);
        const double at[3] = {2.0, 0.75, 1.9}, to[3] = {0.6, 0.22, 0.36};
        shot_aim(&s, at, to);
        snprintf(name, sizeof name, "dam_break_%04d", frames[k]);
        look(name);
    }
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball),
        cmocka_unit_test(a_cloud),
        cmocka_unit_test(a_pool),
        cmocka_unit_test(a_dam_break),
    };
    if (!getenv("VIRGA_TEST_PICTURES")) {
        printf("skipped: VIRGA_TEST_PICTURES is not set\n");
        return 77;
    }
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
