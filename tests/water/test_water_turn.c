/* No hole in a turn of 360 degrees: rays that meet water well inside its surface must show it. Over a pool with waves,
 * and over the settled frames of a dam break where they are.
 *
 *     VIRGA_TEST_TURN=1280x720x360 build/tests/water/water-turn
 *
 * is the turn in full, with a view for each degree; the suite has few views of a small picture. */
#include "water_picture_fixture.h"

#include "../host/test_particles.h"
#include "particles.h"

static shot s;

/* Water under a surface y = height[z][x], in cells. What is covered must be deeper than a spacing. */
#define CELLS 64
static struct {
    double low[2], cell_m, bottom_m, top_m, spacing_m;
    int count[2];
    double height[CELLS][CELLS];
} body;

static uint32_t width = 160, height = 90, views = 12;

static void read_size(void)
{
    const char *given = getenv("VIRGA_TEST_TURN");
    if (given && sscanf(given, "%ux%ux%u", &width, &height, &views) != 3)
        fail_msg("VIRGA_TEST_TURN: expected WIDTHxHEIGHTxVIEWS, got %s", given);
}

static double empty_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of, (void)eye, (void)direction;
    rgb[0] = rgb[1] = rgb[2] = 0.5;
    return INFINITY;
}

static void find_box(void)
{
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
    for (uint32_t i = 0; i < s.f.count; i++)
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = fmin(low[axis], (double)s.f.particles[i].position[axis]);
            high[axis] = fmax(high[axis], (double)s.f.particles[i].position[axis]);
        }
    body.cell_m = 2 * body.spacing_m;
    body.bottom_m = low[1];
    body.top_m = high[1];
    for (int k = 0; k < 2; k++) {
        body.low[k] = low[2 * k];
        body.count[k] = (int)((high[2 * k] - low[2 * k]) / body.cell_m);
        REQUIRE(body.count[k] > 4 && body.count[k] <= CELLS);
    }
}

/* The height of the water of each cell by the volume of its particles, then the lowest of those around it. So spray and
 * what is hollow count for little. */
static void find_body(void)
{
    static double tall[CELLS][CELLS], tops[CELLS][CELLS];
    const double d = body.spacing_m;
    find_box();
    memset(tall, 0, sizeof tall);
    memset(tops, 0, sizeof tops);
    for (uint32_t i = 0; i < s.f.count; i++) {
        const float *p = s.f.particles[i].position;
        const int x = (int)(((double)p[0] - body.low[0]) / body.cell_m);
        const int z = (int)(((double)p[2] - body.low[1]) / body.cell_m);
        if (x >= body.count[0] || z >= body.count[1])
            continue;
        tall[z][x] += water_particle_m3(&s.f.settings) / (body.cell_m * body.cell_m);
        tops[z][x] = fmax(tops[z][x], (double)p[1] - body.bottom_m);
    }
    for (int z = 0; z < body.count[1]; z++)
        for (int x = 0; x < body.count[0]; x++) {
            double least = 1e9;
            for (int i = 0; i < 9; i++) {
                const int u = x + i % 3 - 1, v = z + i / 3 - 1;
                if (u >= 0 && v >= 0 && u < body.count[0] && v < body.count[1])
                    least = fmin(least, fmin(tall[v][u], tops[v][u]));
            }
            body.height[z][x] = body.bottom_m + least - 1.5 * d;
        }
}

/* Whether a ray meets the water, at least a cell inside its sides. */
static bool must_show(const double eye[3], const double ray[3])
{
    double from = 0, to = 1e9;
    const double low[3] = {body.low[0] + body.cell_m, body.bottom_m + body.spacing_m, body.low[1] + body.cell_m};
    const double high[3] = {body.low[0] + (body.count[0] - 1) * body.cell_m, body.top_m,
                            body.low[1] + (body.count[1] - 1) * body.cell_m};
    for (int axis = 0; axis < 3; axis++) {
        const double a = (low[axis] - eye[axis]) / ray[axis], b = (high[axis] - eye[axis]) / ray[axis];
        from = fmax(from, fmin(a, b));
        to = fmin(to, fmax(a, b));
    }
    const double length = sqrt(ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2]);
    for (double t = from; t < to; t += 0.25 * body.spacing_m / length) {
        const int x = (int)((eye[0] + t * ray[0] - body.low[0]) / body.cell_m);
        const int z = (int)((eye[2] + t * ray[2] - body.low[1]) / body.cell_m);
        if (eye[1] + t * ray[1] < body.height[z][x])
            return true;
    }
    return false;
}

typedef struct turn {
    uint64_t shown; /* pixels that must show water */
    uint32_t holes;
    float least;
} turn;

static void aim_from(double angle, double distance, double up)
{
    const double to[3] = {body.low[0] + 0.5 * body.count[0] * body.cell_m, 0.5 * (body.bottom_m + body.top_m),
                          body.low[1] + 0.5 * body.count[1] * body.cell_m};
    const double at[3] = {to[0] + distance * cos(up) * cos(angle), to[1] + distance * sin(up),
                          to[2] + distance * cos(up) * sin(angle)};
    shot_aim(&s, at, to);
}

static void count_holes(turn *t)
{
    shot_draw(&s);
    for (uint32_t i = 0; i < width * height; i++) {
        double ray[3];
        shot_ray(&s, i % width + 0.5, i / width + 0.5, ray);
        if (!must_show(s.camera.position_m, ray))
            continue;
        const float alpha = s.pixels[4 * i + 3];
        t->shown++;
        t->holes += !(alpha > 0.95f);
        t->least = fminf(t->least, alpha);
    }
}

static void look_from(double angle, double distance, double up, turn *t)
{
    aim_from(angle, distance, up);
    count_holes(t);
}

static void check(const char *name, uint32_t count, const turn *t)
{
    printf("%s, %s kernels: %u views of %u x %u, %llu pixels of water, %u holes, the least coverage %g\n", name,
           s.f.settings.kernel == VIRGA_WATER_KERNEL_ANISOTROPIC ? "anisotropic" : "isotropic", count, width, height,
           (unsigned long long)t->shown, t->holes, (double)t->least);
    REQUIRE(t->shown > (uint64_t)count * width * height / 50);
    REQUIRE(t->holes == 0);
}

static void turn_around(const char *name, double distance)
{
    find_body();
    for (int kernel = 0; kernel < 2; kernel++) {
        turn t = {.least = 1};
        s.f.settings.kernel = (virga_water_kernel)kernel;
        for (uint32_t i = 0; i < views; i++)
            look_from(2 * M_PI * i / views + 0.1, distance, i % 2 ? 0.6 : 0.2, &t);
        check(name, views, &t);
    }
}

/* Crests before other water, so near that a surfel is as large as in a picture of 1280 x 720: smaller ones leave no
 * gaps. */
static void look_along_crests(void)
{
    for (int kernel = 0; kernel < 2; kernel++) {
        turn t = {.least = 1};
        s.f.settings.kernel = (virga_water_kernel)kernel;
        look_from(2.54, 0.5, 0.2, &t);
        check("along crests", 1, &t);
    }
}

/* Parts of a picture of 1280 x 720, at its scale, around pixels that once were holes. */
static void look_at_old_holes(void)
{
    static const struct {
        virga_water_kernel kernel;
        double angle, up, x, y;
    } holes[] = {
        {VIRGA_WATER_KERNEL_ISOTROPIC, 1.49626, 0.2, 541, 321},   /* what neighbours closed in part hid water behind */
        {VIRGA_WATER_KERNEL_ANISOTROPIC, 1.84533, 0.2, 716, 302}, /* the same */
        {VIRGA_WATER_KERNEL_ANISOTROPIC, 3.06706, 0.6, 614, 449}, /* weights add up to 1/2 along a sharp edge */
        {VIRGA_WATER_KERNEL_ANISOTROPIC, 3.41613, 0.6, 734, 441}, /* the same */
    };
    const double slope = tan(FOV_DEG * M_PI / 360);
    for (size_t i = 0; i < sizeof holes / sizeof holes[0]; i++) {
        turn t = {.least = 1};
        double at[3], to[3];
        aim_from(holes[i].angle, 1, holes[i].up);
        shot_ray(&s, (holes[i].x + 0.5) / 1280 * width, (holes[i].y + 0.5) / 720 * height, to);
        for (int k = 0; k < 3; k++) {
            at[k] = s.camera.position_m[k];
            to[k] += at[k];
        }
        s.fov_deg = 360 / M_PI * atan(slope * height / 720);
        s.f.settings.kernel = holes[i].kernel;
        shot_aim(&s, at, to);
        count_holes(&t);
        check("an old hole", 1, &t);
        s.fov_deg = 0;
    }
}

static void open_turn(double spacing_m)
{
    virga_water_def def = water_fixture_def();
    read_size();
    def.max_width = width;
    def.max_height = height;
    def.max_blocks = 8192;
    def.max_surfels = 262144;
    shot_open_with(&s, &def, width, height, false);
    s.scene = empty_scene;
    body.spacing_m = spacing_m;
    s.f.settings.spacing_m = (float)spacing_m;
    s.f.settings.spray_density = 0.35f;
}

static void a_pool_with_waves_has_no_holes(void **state)
{
    (void)state;
    const double d = 0.02, low[3] = {-0.3, 0, -0.3};
    const uint32_t counts[3] = {30, 9, 30};
    open_turn(d);
    water_fixture_box(&s.f, low, counts, d, 0.1);
    for (uint32_t i = 0; i < s.f.count; i++) {
        float *p = s.f.particles[i].position;
        p[1] *= 1 + 0.25f * sinf(14 * p[0] + 5 * p[2]);
    }
    turn_around("a pool with waves", 1);
    look_along_crests();
    look_at_old_holes();
    shot_close(&s);
}

static void settled_frames_of_a_dam_break_have_no_holes(void **state)
{
    static const char *const names[] = {"dam_break_0100.ply", "dam_break_0120.ply"};
    particles frame = {0};
    (void)state;
    if (!test_particles_have("dam_break_0120.ply"))
        skip();
    open_turn(0.025);
    s.f.settings.volume_m3 = (float)(0.8 * 0.025 * 0.025 * 0.025);
    for (int i = 0; i < 2; i++) {
        char error[256];
        if (!particles_read(test_particles_path(names[i]), &frame, error, sizeof error))
            fail_msg("%s", error);
        s.f.count = 0;
        for (uint32_t k = 0; k < frame.count; k++)
            water_fixture_add(&s.f, (double)frame.position[k][0], (double)frame.position[k][1],
                              (double)frame.position[k][2]);
        turn_around(names[i], 2);
    }
    particles_free(&frame);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pool_with_waves_has_no_holes),
        cmocka_unit_test(settled_frames_of_a_dam_break_have_no_holes),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
