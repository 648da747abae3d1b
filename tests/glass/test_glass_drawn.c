/* test_glass_drawn.c - what a drop does to light in closed form, and what is drawn where. */
#include "glass_ball_fixture.h"

/* ---- light */

static bool refract_ray(const double d[3], const double n[3], double ratio, double out[3])
{
    const double c = -(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]), k = 1 - ratio * ratio * (1 - c * c);
    for (int i = 0; i < 3; i++)
        out[i] = ratio * d[i] + (ratio * c - sqrt(fmax(k, 0))) * n[i];
    return k >= 0;
}

/* Where a ray from the camera through a pixel leaves the pane to, through one cap, as tangents; false: thrown back. */
static bool leaves(const double tangent[2], double side, const double slope[2], double out[2])
{
    const double length = sqrt(1 + tangent[0] * tangent[0] + tangent[1] * tangent[1]);
    const double d[3] = {tangent[0] / length, tangent[1] / length, -side / length};
    const double n = sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]);
    const double normal[3] = {-slope[0] / n, -slope[1] / n, 1 / n}, flat[3] = {0, 0, side};
    const double facing[3] = {side * normal[0], side * normal[1], side * normal[2]};
    double in_water[3], e[3];
    refract_ray(d, side > 0 ? facing : flat, 1 / WATER, in_water);
    const bool passes = refract_ray(in_water, side > 0 ? flat : facing, WATER, e);
    for (int i = 0; i < 2; i++)
        out[i] = e[i] / fabs(e[2]);
    return passes;
}

/* From both sides, straight on: to 4 % of the way and a pixel within 0.85 radii, where the map's texels show the
 * slope. Where the closed form is thrown back (a coated pane, seen from behind), so is the ray. */
static void compare_refraction(shot *s, double side, const ball *b, int *passed, int *thrown_back)
{
    shot_face(s, side, 30);
    const float *pixels = shot_draw(s, true);
    const double f = 0.5 * HEIGHT / tan(15 * M_PI / 180), away = fabs(s->camera.position_m[2]);
    for (int y = 0; y < HEIGHT; y += 2)
        for (int x = 0; x < WIDTH; x += 2) {
            const double right = (x + 0.5 - 0.5 * WIDTH) / f, up = -(y + 0.5 - 0.5 * HEIGHT) / f;
            const double tangent[2] = {right * side, up}; /* along u and v */
            const double p = (0.048 + tangent[0] * away - b->middle[0]) / b->radius;
            const double q = (0.032 + tangent[1] * away - b->middle[1]) / b->radius, r2 = p * p + q * q;
            const float *found = pixels + 4 * (y * WIDTH + x);
            if (r2 > 1.5)
                assert_float_equal(found[3], 0, 0);
            if (r2 > 0.72)
                continue;
            const double sag = 1 + b->sag[1] * q, steep = b->height / b->radius;
            const double slope[2] = {-2 * p * sag * steep, (-2 * q * sag + (1 - r2) * b->sag[1]) * steep};
            double out[2];
            if (!leaves(tangent, side, slope, out)) {
                if (hypot(slope[0], slope[1]) > 1.3)
                    assert_float_equal(hypot((double)found[0], (double)found[1]), 0, 0);
                *thrown_back += 1;
                continue;
            }
            const double way[2] = {(out[0] - tangent[0]) * side * f, -(out[1] - tangent[1]) * f};
            if (hypot(way[0], way[1]) > 500)
                continue; /* grazing: a texel's slope decides */
            *passed += 1;
            assert_float_equal(found[2], 1, 0);
            const double allowed = 1.5 + 0.04 * hypot(way[0], way[1]);
            if (hypot((double)found[0] - way[0], (double)found[1] - way[1]) > allowed)
                fail_msg("side %g at %d, %d: %g, %g px, expected %g, %g", side, x, y, (double)found[0],
                         (double)found[1], way[0], way[1]);
        }
}

static void a_drop_bends_light_by_snell(void **state)
{
    (void)state;
    shot s;
    open_small(&s);
    s.settings.thickness_mm = 0;
    for (int coated = 0; coated < 2; coated++) {
        int passed = 0, thrown_back = 0;
        s.settings.advancing_deg = coated ? 112 : 60;
        s.settings.receding_deg = coated ? 98 : 38;
        shot_forget(&s);
        const ball b = ball_of(&s, shot_drop(&s, 0.048, 0.032, shot_water(&s, 20e-3)));
        compare_refraction(&s, 1, &b, &passed, &thrown_back);
        REQUIRE(passed > 500 && !thrown_back);
        compare_refraction(&s, -1, &b, &passed, &thrown_back);
        REQUIRE(!coated == !thrown_back);
    }
    shot_close(&s);
}

/* A film of the same thickness everywhere is drawn, and shows what lies behind it. */
static void a_flat_film_does_not_bend(void **state)
{
    (void)state;
    shot s;
    open_small(&s);
    s.settings.thickness_mm = 0;
    shot_face(&s, -1, 30);
    put_film(&s, 80); /* 20 um */
    const float *pixels = shot_draw(&s, true);
    for (int y = 16; y < HEIGHT - 16; y++)
        for (int x = 16; x < WIDTH - 16; x++) {
            const float *found = pixels + 4 * (y * WIDTH + x);
            assert_float_equal(found[3], 1, 1e-6);
            assert_float_equal(hypot((double)found[0], (double)found[1]), 0, 0.02);
        }
    shot_close(&s);
}

/* Nothing is to be seen but what the pane shows of lights that a test adds. */
static void open_before_black(shot *s)
{
    open_small(s);
    float *black = calloc(4ull * WIDTH * HEIGHT, sizeof *black);
    shot_plate(s, black);
    free(black);
    memset(&s->settings.lighting.environment_sh, 0, sizeof s->settings.lighting.environment_sh);
}

/* Before a black plate under an even sky a flat film shows what it reflects: ((n - 1) / (n + 1))^2 straight on. */
static void water_reflects_by_fresnel(void **state)
{
    (void)state;
    shot s;
    open_before_black(&s);
    for (int i = 0; i < 3; i++)
        s.settings.lighting.environment_sh[0][i] = 1 / 0.282095f;
    put_film(&s, 80);
    const float *middle = shot_draw(&s, false) + 4 * (HEIGHT / 2 * WIDTH + WIDTH / 2);
    const double straight = (WATER - 1) / (WATER + 1);
    for (int i = 0; i < 3; i++)
        assert_float_equal(middle[i], straight * straight, 2e-4);
    shot_close(&s);
}

/* A lamp beside the eye, mirrored straight back by a thin film on what is not glass: spread over a disc of 0.15 rad, as
 * bumps would, Fresnel's 0.02 of I / (distance^2 2 pi 0.15^2). Over one of 0.02 rad it would be 56 times as bright. */
static void a_film_on_metal_mirrors_a_lamp_widely(void **state)
{
    (void)state;
    shot s;
    open_before_black(&s);
    s.settings.opaque = true;
    shot_face(&s, 1, 30);
    const double u = 0.5 * (double)s.glass->def.width_m, v = 0.5 * (double)s.glass->def.height_m;
    const double away = fmax(v, u * HEIGHT / WIDTH) / tan(15 * M_PI / 180);
    s.settings.lighting.light_count = 1;
    s.settings.lighting.lights[0] = (virga_light){.position_m = {u, v, away}, .intensity = {1, 1, 1}};
    put_film(&s, 40); /* 10 um */
    const float *middle = shot_draw(&s, false) + 4 * (HEIGHT / 2 * WIDTH + WIDTH / 2);
    const double straight = (WATER - 1) / (WATER + 1);
    const double spread = 1 / (away * away * 2 * M_PI * 0.15 * 0.15);
    assert_float_equal(middle[0] / (straight * straight * spread), 1, 0.02);
    shot_close(&s);
}

/* Surroundings with a radiance of 1 in all directions, before a plate that is grey all over. */
static void open_before_grey(shot *s, float grey)
{
    open_before_black(s);
    float *plate = malloc(16ull * WIDTH * HEIGHT);
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        plate[i] = grey;
    shot_plate(s, plate);
    free(plate);
    for (int i = 0; i < 3; i++)
        s->settings.lighting.environment_sh[0][i] = 1 / 0.282095f;
    s->settings.opaque = true;
    shot_face(s, 1, 30);
}

/* Paint with an index of 1.5 reflects 0.04 under air, and ((1.5 - 1.333) / (1.5 + 1.333))^2 under water. What a film
 * shows of it, straight on, lacks the difference, but of what is black already no more than six tenths. */
static void water_takes_the_gloss_off_paint(void **state)
{
    (void)state;
    const float greys[] = {0.2f, 0.02f};
    for (int i = 0; i < 2; i++) {
        shot s;
        open_before_grey(&s, greys[i]);
        put_film(&s, 80);
        const float *middle = shot_draw(&s, false) + 4 * (HEIGHT / 2 * WIDTH + WIDTH / 2);
        const double air = 0.5 / 2.5, coat = (1.5 - WATER) / (1.5 + WATER), water = (WATER - 1) / (WATER + 1);
        const double color = fmax((double)greys[i] - air * air + coat * coat, 0.4 * (double)greys[i]);
        assert_float_equal(middle[0], color * (1 - water * water) + water * water, 3e-4);
        shot_close(&s);
    }
}

/* On a black surface a drop shows what it mirrors alone: where it leans by up to 35 degrees, the surroundings, which
 * are white, by Fresnel; where it leans by more than 50, the surface beside it, as its rays go down to that. */
static void the_rim_of_a_drop_on_metal_mirrors_the_metal(void **state)
{
    (void)state;
    shot s;
    open_before_grey(&s, 0);
    s.settings.advancing_deg = 110;
    s.settings.receding_deg = 100;
    const ball b = ball_of(&s, shot_drop(&s, 0.048, 0.032, shot_water(&s, 8e-3)));
    const float *pixels = shot_draw(&s, false);
    const double f = 0.5 * HEIGHT / tan(15 * M_PI / 180), away = fabs(s.camera.position_m[2]);
    int gentle = 0, steep = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const double right = (i % WIDTH + 0.5 - 0.5 * WIDTH) / f, up = -(i / WIDTH + 0.5 - 0.5 * HEIGHT) / f;
        const double p = 0.048 + right * away - b.middle[0], q = 0.032 + up * away - b.middle[1];
        const double r = hypot(p, q) / b.radius;
        if (r > 0.9)
            continue;
        const double x = p / b.radius, y = q / b.radius, sag = 1 + b.sag[1] * y;
        const double slope = hypot(-2 * x * sag, -2 * y * sag + (1 - r * r) * b.sag[1]) * b.height / b.radius;
        if (slope < 0.7) {
            REQUIRE(pixels[4 * i] > 0.019f && pixels[4 * i] < 0.03f);
            gentle++;
        } else if (slope > 1.6) {
            assert_float_equal(pixels[4 * i], 0, 1e-4);
            steep++;
        }
    }
    REQUIRE(gentle > 50 && steep > 50);
    shot_close(&s);
}

/* A lamp before the pane is in the host's picture, where it is. A drop is a lens and shows it a second time; a sheet of
 * film lets it through, and has nothing to add: spread over a disc of 0.02 rad it would glow far around the lamp. */
static void only_lenses_show_a_lamp_again(void **state)
{
    (void)state;
    shot s;
    open_before_black(&s);
    shot_face(&s, -1, 30);
    const double u = 0.5 * (double)s.glass->def.width_m, v = 0.5 * (double)s.glass->def.height_m, away = 5;
    s.settings.lighting.light_count = 1;
    s.settings.lighting.lights[0] = (virga_light){.position_m = {u, v, away}, .intensity = {1, 1, 1}};
    double max[2] = {0};
    for (int drop = 0; drop < 2; drop++) {
        if (drop) {
            shot_forget(&s);
            shot_drop(&s, u, v, shot_water(&s, 3e-3));
        } else
            put_film(&s, 80); /* 20 um */
        const float *pixels = shot_draw(&s, false);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            max[drop] = fmax(max[drop], (double)pixels[4 * i]);
    }
    print_message("%g seen through a film, %g through a drop\n", max[0], max[1]);
    assert_float_equal(max[0], 0, 1e-3);
    REQUIRE(max[1] > 1);
    shot_close(&s);
}

static double mirrored(double x)
{
    return 1 - fabs(1 - (x - 2 * floor(x / 2)));
}

/* What a drop on what is not glass adds to the light of an even white surface, over a ring around its middle from
 * radius to radius: towards the right, and towards the left. */
static void sum_ring(const shot *s, const float *pixels, const ball *b, const double radii[2], double sums[2])
{
    const double f = 0.5 * HEIGHT / tan(15 * M_PI / 180), away = fabs(s->camera.position_m[2]);
    sums[0] = sums[1] = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const double right = (i % WIDTH + 0.5 - 0.5 * WIDTH) / f, up = -(i / WIDTH + 0.5 - 0.5 * HEIGHT) / f;
        const double p = 0.048 + right * away - b->middle[0], q = 0.032 + up * away - b->middle[1];
        const double r = hypot(p, q) / b->radius;
        if (r > radii[0] && r < radii[1])
            sums[p < 0] += (double)pixels[4 * i] - (double)pixels[4 * i + 3];
    }
}

/* A lamp low to the right of a round drop on metal: what is beside the drop is darker there and brighter on the other
 * side, by as much, and untouched from 1.5 radii on: to 8 %, at 20 pixels a radius and with a drop that sags a little.
 * Under the drop the focus has what is missing elsewhere, to a tenth of all its light: Fresnel takes 2 % and at the rim
 * some more. */
static void a_drop_on_metal_has_a_shadow_and_a_focus_as_bright(void **state)
{
    (void)state;
    shot s;
    open_before_black(&s);
    float *white = malloc(16ull * WIDTH * HEIGHT);
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        white[i] = 1;
    shot_plate(&s, white);
    free(white);
    s.settings.opaque = true;
    s.settings.gain = 0;
    s.settings.advancing_deg = 70;
    s.settings.receding_deg = 60;
    s.settings.lighting.light_count = 1;
    s.settings.lighting.lights[0] = (virga_light){.position_m = {1.048f, 0.032f, 1}, .intensity = {1, 1, 1}};
    const ball b = ball_of(&s, shot_drop(&s, 0.048, 0.032, shot_water(&s, 8e-3)));
    const float *pixels = shot_draw(&s, false);
    double beside[2], far[2], under[2];
    sum_ring(&s, pixels, &b, (const double[2]){1.1, 1.5}, beside);
    sum_ring(&s, pixels, &b, (const double[2]){1.55, 3}, far);
    sum_ring(&s, pixels, &b, (const double[2]){0, 0.95}, under);
    const double scale = 0.5 * HEIGHT / tan(15 * M_PI / 180) / fabs(s.camera.position_m[2]), r = b.radius * scale;
    print_message("beside %.1f, %.1f; under %.1f, %.1f\n", beside[0], beside[1], under[0], under[1]);
    REQUIRE(beside[0] < -20 && fabs(beside[0] + beside[1]) < -0.08 * beside[0]);
    REQUIRE(under[0] < -100 && under[1] > 50 && fabs(under[0] + under[1]) < 0.1 * M_PI * r * r);
    REQUIRE(far[0] == 0 && far[1] == 0);
    shot_close(&s);
}

/* By Snell, beyond the borders: within them, mirrored and drawn together to at most a fifth of the picture. */
static double drawn_together(double x)
{
    const double within = fmin(fmax(x, 0), 1), beyond = x - within;
    return within - 0.2 * beyond / (0.2 + fabs(beyond));
}

/* How far a point is beyond the borders, in widths of the picture. */
static double beyond_borders(double x, double y)
{
    return hypot(fmax(fabs(x - 0.5) - 0.5, 0), fmax(fabs(y - 0.5) - 0.5, 0));
}

/* Whether a point that a drop shows by Snell is compared: well inside, or beyond one border only. Copies have no texels
 * beyond the borders; for a point just within a border the copy shows another point. */
static bool is_compared(double x, double y)
{
    const bool well_in_x = x > 0.16 && x<0.84, well_in_y = y> 0.16 && y < 0.84;
    return (well_in_x && well_in_y) || ((well_in_x || well_in_y) && beyond_borders(x, y) > 0.1);
}

/* How far apart the points are that the pixels beside this one look up, in widths of the picture: so coarse is the copy
 * that it is looked up in. */
static double spread_of(const float *vectors, int i)
{
    const int beside[4] = {i - 1, i + 1, i - WIDTH, i + WIDTH};
    double most = 0;
    for (int k = 0; k < 4; k++)
        if (beside[k] >= 0 && beside[k] < WIDTH * HEIGHT && vectors[4 * beside[k] + 2] == 1) {
            const float *here = vectors + 4 * i, *there = vectors + 4 * beside[k];
            most = fmax(most, hypot((double)here[0] - (double)there[0], (double)here[1] - (double)there[1]) / WIDTH);
        }
    return most;
}

/* In the style of the paper always, mirrored at the borders; by Snell until the environment is all that is left, which
 * is black here. To 3 % of the picture, as copies are coarse: where neighbours look up points a fifth of it apart, they
 * are coarser than that. */
static void compare_lookup(shot *s, int *compared, int *beyond)
{
    float *vectors = malloc(16ull * WIDTH * HEIGHT);
    memcpy(vectors, shot_draw(s, true), 16ull * WIDTH * HEIGHT);
    const float *colors = shot_draw(s, false);
    const bool paper = s->settings.style == VIRGA_GLASS_STYLE_PAPER;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const float *v = vectors + 4 * i, *c = colors + 4 * i;
        const double x = (i % WIDTH + 0.5 + (double)v[0]) / WIDTH, y = (i / WIDTH + 0.5 + (double)v[1]) / HEIGHT;
        if (v[2] < 1 || (v[0] == 0 && v[1] == 0))
            continue;
        if (!paper && beyond_borders(x, y) > 1.501)
            assert_float_equal(c[2], 0, 0);
        if (!paper && (!is_compared(x, y) || beyond_borders(x, y) > 1.4 || spread_of(vectors, i) > 0.2))
            continue;
        *compared += 1;
        *beyond += x < -0.1 || x > 1.1 || y < -0.1 || y > 1.1;
        assert_float_equal((double)c[0] / (double)c[2], paper ? mirrored(x) : drawn_together(x), 0.03);
        assert_float_equal((double)c[1] / (double)c[2], paper ? mirrored(y) : drawn_together(y), 0.03);
    }
    free(vectors);
}

static void the_picture_is_looked_up_where_the_vectors_say(void **state)
{
    (void)state;
    shot s;
    ball balls[BALLS];
    int compared = 0, beyond = 0;
    open_small(&s);
    put_even_balls(&s);
    put_balls(&s, balls, 20);
    shot_face(&s, -1, 30);
    s.settings.gain = 0;
    memset(&s.settings.lighting.environment_sh, 0, sizeof s.settings.lighting.environment_sh);
    compare_lookup(&s, &compared, &beyond);
    print_message("%d compared, %d of them beyond the borders\n", compared, beyond);
    REQUIRE(compared > 600 && beyond > 200);
    s.settings.style = VIRGA_GLASS_STYLE_PAPER;
    s.settings.paper_shift = 4;
    compared = beyond = 0;
    compare_lookup(&s, &compared, &beyond);
    REQUIRE(compared > 1000 && beyond > 200);
    shot_close(&s);
}

/* ---- where */

static void the_scene_hides_what_is_behind_it(void **state)
{
    (void)state;
    shot s;
    ball balls[BALLS];
    open_small(&s);
    put_balls(&s, balls, BALLS);
    s.give_depth = true;
    const double distance = fabs(s.camera.position_m[2]);
    const float *p = s.camera.clip_from_view;
    for (int nearer = 0; nearer < 2; nearer++) {
        s.scene_depth = (float)(-(double)p[10] + (double)p[14] / (distance * (nearer ? 0.95 : 1.05)));
        const double alpha = sum_of_alpha(shot_draw(&s, false), 0, WIDTH);
        REQUIRE(nearer ? alpha == 0 : alpha > 1000);
    }
    shot_close(&s);
}

/* Vectors of what lies to the right of a pillar over the left columns: none points at it, to two pixels. */
static int count_open(shot *s, int post)
{
    const float *vectors = shot_draw(s, true);
    int bent = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        if (i % WIDTH <= post || vectors[4 * i + 3] == 0)
            continue;
        bent += vectors[4 * i] < -2;
        if (i % WIDTH + 0.5 + (double)vectors[4 * i] < post - 2)
            fail_msg("at %d, %d: %g px", i % WIDTH, i / WIDTH, (double)vectors[4 * i]);
    }
    return bent;
}

/* A white post over the left third, before a black scene far away. Beyond the pane drops show it, bent; a pillar on the
 * eye's side of it they can not: what they show instead is the scene beside it. */
static void drops_do_not_show_what_is_on_the_eyes_side(void **state)
{
    (void)state;
    const uint32_t post = WIDTH / 3;
    shot s;
    ball balls[BALLS];
    double light[2];
    open_before_black(&s);
    float *plate = calloc(4ull * WIDTH * HEIGHT, sizeof *plate);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 0; c < 4; c++)
            plate[4 * i + c] = i % WIDTH < post;
    shot_plate(&s, plate);
    free(plate);
    put_balls(&s, balls, BALLS);
    s.settings.gain = 0;
    s.give_depth = true;
    s.post_columns = post;
    const double distance = fabs(s.camera.position_m[2]);
    const float *p = s.camera.clip_from_view;
    s.scene_depth = (float)(-(double)p[10] + (double)p[14] / (distance * 20));
    for (int inside = 0; inside < 2; inside++) {
        s.post_depth = (float)(-(double)p[10] + (double)p[14] / (inside ? distance - 0.05 : distance * 20));
        const float *pixels = shot_draw(&s, false);
        light[inside] = 0;
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
            light[inside] += i % WIDTH > post ? (double)pixels[4 * i] : 0;
    }
    print_message("%.1f of a post beyond the pane, %.1f of one inside\n", light[0], light[1]);
    REQUIRE(light[0] > 100);
    REQUIRE(light[1] < 0.15 * light[0]); /* copies are coarse: next to the post they have some of it */
    REQUIRE(count_open(&s, (int)post) > 200);
    shot_close(&s);
}

static void nothing_is_drawn_where_there_is_no_glass(void **state)
{
    (void)state;
    static const uint8_t half[2] = {0, 1};
    shot s;
    ball balls[BALLS];
    open_small(&s);
    virga_glass_shape shape = virga_default_glass_shape();
    shape.mask = half;
    shape.mask_columns = 2;
    shape.mask_rows = 1;
    REQUIRE(virga_glass_shape_set(s.glass, &shape) == VIRGA_OK);
    shot_step(&s, 1);
    put_balls(&s, balls, BALLS);
    for (int style = 0; style < 2; style++) {
        s.settings.style = style ? VIRGA_GLASS_STYLE_PAPER : VIRGA_GLASS_STYLE_PHYSICAL;
        const float *pixels = shot_draw(&s, false);
        REQUIRE(sum_of_alpha(pixels, 0, WIDTH / 2 - 1) == 0);
        REQUIRE(sum_of_alpha(pixels, WIDTH / 2 + 1, WIDTH) > 1000);
    }
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_drop_bends_light_by_snell),
        cmocka_unit_test(a_flat_film_does_not_bend),
        cmocka_unit_test(water_reflects_by_fresnel),
        cmocka_unit_test(a_film_on_metal_mirrors_a_lamp_widely),
        cmocka_unit_test(water_takes_the_gloss_off_paint),
        cmocka_unit_test(the_rim_of_a_drop_on_metal_mirrors_the_metal),
        cmocka_unit_test(only_lenses_show_a_lamp_again),
        cmocka_unit_test(a_drop_on_metal_has_a_shadow_and_a_focus_as_bright),
        cmocka_unit_test(the_picture_is_looked_up_where_the_vectors_say),
        cmocka_unit_test(the_scene_hides_what_is_behind_it),
        cmocka_unit_test(drops_do_not_show_what_is_on_the_eyes_side),
        cmocka_unit_test(nothing_is_drawn_where_there_is_no_glass),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
