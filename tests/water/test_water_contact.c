/* The contact line: where water of particles meets a wall, and where it ends on a floor, against closed forms. */
#include "water_picture_fixture.h"

#define SIDE   160
#define D      0.02 /* spacing */
#define WALL_X (-0.2)

static shot s;

/* All of it is turned around y. */
static double turned_rad;

static void turn(const double from[3], double by, double to[3])
{
    const double x = from[0], z = from[2];
    to[0] = x * cos(by) + z * sin(by);
    to[1] = from[1];
    to[2] = z * cos(by) - x * sin(by);
}

/* A floor at y = 0, whose red changes along x, and a black wall. */
#define SLOPE 2.0 /* of red per metre */

static double room(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of;
    const double floor = direction[1] < 0 ? -eye[1] / direction[1] : INFINITY;
    const double wall = direction[0] < 0 ? (WALL_X - eye[0]) / direction[0] : INFINITY;
    rgb[0] = rgb[1] = rgb[2] = 0;
    if (floor < wall)
        rgb[0] = 1 + SLOPE * (eye[0] + floor * direction[0]), rgb[1] = 1;
    return fmin(floor, wall);
}

/* The wall is a pane of glass, which a host has drawn into its depth: the floor is seen through it. */
static double room_with_pane(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    double at[3], along[3], black[3];
    turn(eye, -turned_rad, at);
    turn(direction, -turned_rad, along);
    const double floor = along[1] < 0 ? -at[1] / along[1] : INFINITY;
    rgb[0] = rgb[1] = rgb[2] = isfinite(floor) ? 0.4 : 1.2;
    return room(of, at, along, black);
}

/* Where a point of the world is in the picture (px). */
static void pixel_of(const double at[3], double pixel[2])
{
    const float *m = s.camera.view_from_world, *p = s.camera.clip_from_view;
    double v[3];
    for (int i = 0; i < 3; i++)
        v[i] = (double)m[i] * at[0] + (double)m[4 + i] * at[1] + (double)m[8 + i] * at[2] + (double)m[12 + i];
    pixel[0] = (0.5 - 0.5 * (double)p[0] * v[0] / v[2]) * SIDE;
    pixel[1] = (0.5 - 0.5 * (double)p[5] * v[1] / v[2]) * SIDE;
}

/* Mean height of the flat part of the surface: that of its surfels. */
static double surface_height(void)
{
    double sum = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < s.f.stats.surfels; i++) {
        const float *at = s.f.surfels[i].position;
        if (fabs((double)at[0]) < 0.08 && fabs((double)at[2]) < 0.08 && (double)at[1] > 2 * D) {
            sum += (double)at[1];
            count++;
        }
    }
    REQUIRE(count > 50);
    return sum / count;
}

/* Water stands in a corner: its particles begin half a spacing before wall and floor. */
static void fill_pool(void)
{
    s.f.settings.spacing_m = (float)D;
    s.f.settings.kernel = VIRGA_WATER_KERNEL_ANISOTROPIC;
    memset(&s.f.settings.lighting, 0, sizeof s.f.settings.lighting);
    s.f.count = 0;
    water_fixture_box(&s.f, (const double[3]){WALL_X + 0.5 * D, 0.5 * D, -0.3}, (const uint32_t[3]){24, 6, 30}, D, 0);
    water_fixture_step(&s.f);
}

/* The first row from above in a column that water covers by half, with the part of it. */
static double edge_of_column(uint32_t x)
{
    for (uint32_t y = 1; y < SIDE; y++) {
        const double above = (double)shot_pixel(&s, x, y - 1)[3], here = (double)shot_pixel(&s, x, y)[3];
        if (here >= 0.5)
            return y + 0.5 - (here - 0.5) / fmax(here - above, 1e-6);
    }
    return SIDE;
}

#define CAPILLARY_M 0.0027 /* of contact.glsl */
#define CONTACT_RAD 0.35

/* The picture's edge of the water at the wall against that of the meniscus; its pictures have this name. */
static void check_meniscus(double height, const char *name)
{
    static const double eyes[3][3] = {{0.35, 0.5, 0.1}, {0.2, 0.45, 0.25}, {0.6, 0.62, -0.1}};
    for (int i = 0; i < 3; i++) {
        double eye[3], to[3], worst = 0;
        char picture[32];
        turn(eyes[i], turned_rad, eye);
        turn((const double[3]){WALL_X, height, 0}, turned_rad, to);
        shot_aim(&s, eye, to);
        shot_draw(&s);
        snprintf(picture, sizeof picture, "%s%d", name, i);
        shot_save(&s, picture);
        for (int k = -5; k <= 5; k++) {
            double at[3], flat[2], up[2];
            turn((const double[3]){WALL_X, height, 0.015 * k}, turned_rad, at);
            const double away = sqrt(pow(eye[0] - at[0], 2) + pow(eye[1] - at[1], 2) + pow(at[2] - eye[2], 2));
            const double pixel_m = away * 2 * tan(FOV_DEG * M_PI / 360) / SIDE;
            const double angle = (M_PI / 2 - CONTACT_RAD) * CAPILLARY_M / (CAPILLARY_M + pixel_m);
            pixel_of(at, flat);
            at[1] += 2 * CAPILLARY_M * sin(0.5 * angle);
            pixel_of(at, up);
            /* Along the column of that pixel. */
            const double edge = edge_of_column((uint32_t)up[0]);
            worst = fmax(worst, fabs(edge - up[1]));
            printf("column %3.0f: flat water would end at %.2f, its meniscus at %.2f, the picture's at %.2f px\n",
                   up[0], flat[1], up[1], edge);
            for (uint32_t y = (uint32_t)ceil(edge + 1.5); y < (uint32_t)edge + 12; y++)
                REQUIRE(shot_pixel(&s, (uint32_t)up[0], y)[3] > 0.99f);
        }
        printf("off by up to %.2f px\n", worst);
        REQUIRE(worst < 1);
    }
}

static void water_meets_a_wall_at_the_height_of_a_meniscus(void **state)
{
    (void)state;
    fill_pool();
    check_meniscus(surface_height(), "wall");
}

static void water_meets_a_pane_in_the_depth_at_the_height_of_a_meniscus(void **state)
{
    (void)state;
    fill_pool();
    const double height = surface_height();
    turned_rad = 0.5;
    s.scene = room_with_pane;
    for (uint32_t i = 0; i < s.f.count; i++) {
        const float *p = s.f.particles[i].position;
        const double at[3] = {(double)p[0], (double)p[1], (double)p[2]};
        double to[3];
        turn(at, turned_rad, to);
        for (int axis = 0; axis < 3; axis++)
            s.f.particles[i].position[axis] = (float)to[axis];
    }
    check_meniscus(height, "pane");
    turned_rad = 0;
    s.scene = room;
}

/* Where on the floor the picture of a pixel comes from (x). */
static double seen_at(const float *pixel)
{
    return ((double)pixel[0] / (double)pixel[1] - 1) / SLOPE;
}

/* A disc of one layer of particles on the floor. Its border is a wedge, so it shows the floor where it is. */
static void the_border_of_a_thin_layer_is_a_wedge(void **state)
{
    (void)state;
    memset(s.f.settings.absorption_1_m, 0, sizeof s.f.settings.absorption_1_m);
    double border = 0, middle = 0;
    uint32_t pixels = 0;
    s.f.count = 0;
    for (int z = -12; z <= 12; z++)
        for (int x = -12; x <= 12; x++)
            if (x * x + z * z <= 110)
                water_fixture_add(&s.f, D * x + 0.1, 0.5 * D, D * z);
    shot_aim(&s, (const double[3]){0.75, 0.7, 0}, (const double[3]){0.1, 0, 0});
    shot_draw(&s);
    shot_save(&s, "disc");
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 1; x < SIDE; x++) {
            const float *here = shot_pixel(&s, x, y), *left = shot_pixel(&s, x - 1, y);
            const double shift = here[3] > 0.9f ? fabs(seen_at(here) - seen_at(&s.plate[4 * (y * SIDE + x)])) : 0;
            if (here[3] > 0.9f && left[3] < 0.5f) {
                border = fmax(border, shift);
                pixels++;
            }
            middle = fmax(middle, x == SIDE / 2 && y == SIDE / 2 ? shift : 0);
        }
    printf("%u pixels at the left border are shifted by up to %.2f mm, that in the middle by %.2f mm\n", pixels,
           1e3 * border, 1e3 * middle);
    REQUIRE(pixels > 20);
    REQUIRE(border < middle / 3);
}

static void draw_with(shot *of, uint32_t contact, float *pixels)
{
    of->f.settings.contact = (virga_water_contact)contact;
    shot_draw(of);
    memcpy(pixels, of->pixels, (size_t)of->width * of->height * 16);
}

/* How many pixels differ. */
static uint32_t differences(const shot *of, const float *one, const float *other)
{
    uint32_t count = 0;
    for (size_t i = 0; i < (size_t)of->width * of->height; i++)
        count += memcmp(one + 4 * i, other + 4 * i, 16) != 0;
    return count;
}

/* Water in a corner, a thin layer beside it, and drops: tiles of all kinds, some of them cut off by the edge. */
static void tiles_change_no_pixel(void **state)
{
    (void)state;
    static const double eyes[3][3] = {{0.35, 0.8, 0.1}, {1.0, 1.0, 0.6}, {0.3, 0.32, 0.5}};
    shot o;
    shot_open(&o, 203, 131);
    o.scene = room;
    o.f.settings = s.f.settings;
    o.f.count = 0;
    water_fixture_box(&o.f, (const double[3]){WALL_X + 0.5 * D, 0.5 * D, -0.3}, (const uint32_t[3]){16, 14, 20}, D, 0);
    water_fixture_box(&o.f, (const double[3]){WALL_X + 22 * D, 0.5 * D, -0.2}, (const uint32_t[3]){12, 1, 12}, D, 0);
    for (int i = 0; i < 8; i++)
        water_fixture_add(&o.f, 0.05 * i, 0.2 + 0.02 * i, 0.1);
    float *pixels[3];
    for (int i = 0; i < 3; i++)
        REQUIRE((pixels[i] = malloc((size_t)o.width * o.height * 16)));
    for (int i = 0; i < 6; i++) {
        o.reversed = i >= 3;
        shot_aim(&o, eyes[i % 3], (const double[3]){WALL_X + 0.2, 0.08, -0.1});
        for (uint32_t contact = 0; contact < 3; contact++)
            draw_with(&o, contact, pixels[contact]);
        shot_save(&o, (const char *[3]){"tiles0", "tiles1", "tiles2"}[i % 3]);
        const float *drawn = pixels[VIRGA_WATER_CONTACT_DRAW];
        const uint32_t anew = differences(&o, drawn, pixels[VIRGA_WATER_CONTACT_OFF]);
        const uint32_t wrong = differences(&o, drawn, pixels[VIRGA_WATER_CONTACT_PREPARE]);
        printf("%u pixels have contact lines; with tiles %u pixels differ\n", anew, wrong);
        REQUIRE(anew > 200);
        REQUIRE(wrong == 0);
    }
    for (int i = 0; i < 3; i++)
        free(pixels[i]);
    shot_close(&o);
}

int main(void)
{
    shot_open(&s, SIDE, SIDE);
    s.scene = room;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(water_meets_a_wall_at_the_height_of_a_meniscus),
        cmocka_unit_test(water_meets_a_pane_in_the_depth_at_the_height_of_a_meniscus),
        cmocka_unit_test(the_border_of_a_thin_layer_is_a_wedge),
        cmocka_unit_test(tiles_change_no_pixel),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    shot_close(&s);
    return effect_fixture_close(failed);
}
