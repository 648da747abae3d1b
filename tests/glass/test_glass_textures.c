/* test_glass_textures.c - drops as textures (Sato et al. 2002): each texel against a ray traced in doubles, the blend
 * of four, when textures are made anew, and the same bits every time. */
#include "glass_texture_fixture.h"

/* ---- texels against traced rays */

enum { POINTS = 4, TEXELS = 16 };

static void normalise(double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Snell's law; n faces the ray. False: thrown back. */
static bool bend(const double d[3], const double n[3], double ratio, double out[3])
{
    const double c = -dot(d, n), k = 1 - ratio * ratio * (1 - c * c);
    for (int i = 0; i < 3; i++)
        out[i] = ratio * d[i] + (ratio * c - sqrt(fmax(k, 0))) * n[i];
    return k >= 0;
}

/* The normal where the eye's ray meets the surface, by the equations in shaders/glass/draw/drop_path.glsl. */
static void surface_normal(const double at[2], const double d[3], double cap, double n[3])
{
    const double base[3] = {at[0], at[1], 0}, flat[3] = {0, 0, -1};
    double way[3] = {-d[0], -d[1], -d[2]};
    n[0] = 2 * cap * at[0];
    n[1] = 2 * cap * at[1];
    n[2] = 1;
    if (cap <= 0) { /* a hemisphere */
        if (d[2] > 0)
            bend(d, flat, 1 / WATER, way);
        const double along = dot(base, way), step = -along + sqrt(along * along + 1 - dot(base, base));
        for (int i = 0; i < 3; i++)
            n[i] = base[i] + step * way[i];
    }
    normalise(n);
}

/* The direction out of a pane that faces +z. */
static bool trace(const double at[2], const double d[3], double cap, double out[3])
{
    double n[3], back[3], water[3], flat[3] = {0, 0, d[2] > 0 ? -1 : 1};
    surface_normal(at, d, cap, n);
    for (int i = 0; i < 3; i++)
        back[i] = -n[i];
    if (d[2] > 0) {
        bend(d, flat, 1 / WATER, water);
        return bend(water, back, WATER, out);
    }
    const double facing = dot(n, d);
    if (facing > -0.02) /* the far side of a steep drop is not seen */
        for (int i = 0; i < 3; i++)
            n[i] -= d[i] * (facing + 0.02);
    normalise(n);
    bend(d, n, 1 / WATER, water);
    return bend(water, flat, WATER, out);
}

/* Where the ray through a lattice point and a texel ends on the picture, as shares of it. */
static bool expected_at(const shot *s, const double point[2], const double at[2], double cap, double shares[2])
{
    const host_camera *c = &s->camera;
    double d[3] = {point[0] - c->position_m[0], point[1] - c->position_m[1], -c->position_m[2]}, out[3], far[3];
    normalise(d);
    if (!trace(at, d, cap, out))
        return false;
    for (int i = 0; i < 3; i++)
        far[i] = c->position_m[i] + 1e7 * out[i];
    const double ahead = camera_pixel(c, far, shares);
    shares[0] /= WIDTH;
    shares[1] /= HEIGHT;
    return ahead > 0 && shares[0] > 0.06 && shares[0] < 0.94 && shares[1] > 0.06 && shares[1] < 0.94;
}

/* Compares the texels of one point's texture; returns how many could be. */
static int compare_texture(const shot *s, const float *texels, uint32_t column, uint32_t row, double cap)
{
    const double point[2] = {0.096 * column / (POINTS - 1), 0.064 * row / (POINTS - 1)};
    int compared = 0;
    for (int y = 0; y < TEXELS; y++)
        for (int x = 0; x < TEXELS; x++) {
            double at[2] = {(x + 0.5) * 2 / TEXELS - 1, (y + 0.5) * 2 / TEXELS - 1}, shares[2];
            const double radius = hypot(at[0], at[1]);
            for (int i = 0; i < 2; i++)
                at[i] *= fmin(1, 0.97 / radius);
            if (!expected_at(s, point, at, cap, shares))
                continue;
            /* blue is 1 in the plate, and in the texture the share of light that goes through */
            const float *found = texture_texel(texels, POINTS, TEXELS, column, row, 0, x, y);
            for (int i = 0; i < 2; i++)
                if (!(fabs((double)found[i] / (double)found[2] - shares[i]) < 2e-3))
                    fail_msg("point %u, %u, texel %d, %d: %g of the picture, expected %g", column, row, x, y,
                             (double)found[i] / (double)found[2], shares[i]);
            compared++;
        }
    return compared;
}

/* Both shapes of drops, askew. To 0.002 of the picture: half floats have steps of 0.0005, and the plate's copies are
 * filtered. `side` 1: from outside. */
static void check_flat(textured *t, double side)
{
    shot *const s = &t->shot;
    for (int hemisphere = 0; hemisphere < 2; hemisphere++) {
        int compared = 0;
        s->settings.texture_shape = hemisphere ? VIRGA_GLASS_TEXTURE_HEMISPHERE : VIRGA_GLASS_TEXTURE_CAP;
        shot_aim(s, (const double[3]){0.02, 0.05, side * 0.12}, (const double[3]){0.06, 0.02, 0}, 70);
        const float *texels = draw_and_read_textures(t);
        const double cap = hemisphere ? 0 : tan(glass_seen_deg(&s->settings) * M_PI / 360);
        for (uint32_t i = 0; i < POINTS * POINTS; i++)
            compared += compare_texture(s, texels, i % POINTS, i / POINTS, cap);
        REQUIRE(compared > 700);
    }
    s->settings.texture_shape = VIRGA_GLASS_TEXTURE_CAP;
}

static void textures_of_a_flat_pane_from_outside(void **state)
{
    check_flat(*state, 1);
}

static void textures_of_a_flat_pane_from_inside(void **state)
{
    check_flat(*state, -1);
}

/* ---- bent panes */

enum { SHAPE = 97 }; /* points of a bent shape a side; every 32nd is a point of the mesh of textures */

/* A point of a bent shape, and there the pane's directions along u and v and outwards. */
typedef struct bent_frame {
    double point[3], axes[3][3];
} bent_frame;

static bent_frame bent_at(const float *positions, uint32_t column, uint32_t row)
{
    bent_frame f;
    const uint32_t at = row * SHAPE + column;
    for (int i = 0; i < 3; i++) {
        f.point[i] = (double)positions[3 * at + (uint32_t)i];
        f.axes[0][i] = (double)positions[3 * (at + 1) + (uint32_t)i] - (double)positions[3 * (at - 1) + (uint32_t)i];
        f.axes[1][i] =
            (double)positions[3 * (at + SHAPE) + (uint32_t)i] - (double)positions[3 * (at - SHAPE) + (uint32_t)i];
    }
    normalise(f.axes[0]);
    normalise(f.axes[1]);
    for (int i = 0; i < 3; i++)
        f.axes[2][i] =
            f.axes[0][(i + 1) % 3] * f.axes[1][(i + 2) % 3] - f.axes[0][(i + 2) % 3] * f.axes[1][(i + 1) % 3];
    return f;
}

/* As expected_at. */
static bool bent_expected(const shot *s, const bent_frame *f, const double at[2], double cap, double shares[2])
{
    const host_camera *c = &s->camera;
    double d[3], local[3], out[3], far[3];
    for (int i = 0; i < 3; i++)
        d[i] = f->point[i] - c->position_m[i];
    normalise(d);
    for (int i = 0; i < 3; i++)
        local[i] = dot(d, f->axes[i]);
    if (!trace(at, local, cap, out))
        return false;
    for (int i = 0; i < 3; i++)
        far[i] = c->position_m[i] + 1e7 * (out[0] * f->axes[0][i] + out[1] * f->axes[1][i] + out[2] * f->axes[2][i]);
    const double ahead = camera_pixel(c, far, shares);
    shares[0] /= WIDTH;
    shares[1] /= HEIGHT;
    return ahead > 0 && shares[0] > 0.06 && shares[0] < 0.94 && shares[1] > 0.06 && shares[1] < 0.94;
}

/* The two by two inner points of the mesh; returns how many texels could be compared. */
static int compare_bent(const shot *s, const float *texels, const float *positions)
{
    const double cap = tan(glass_seen_deg(&s->settings) * M_PI / 360);
    int compared = 0;
    for (uint32_t i = 0; i < 4 * TEXELS * TEXELS; i++) {
        const uint32_t column = 1 + i / (TEXELS * TEXELS) % 2, row = 1 + i / (2 * TEXELS * TEXELS);
        const int x = (int)(i % TEXELS), y = (int)(i / TEXELS % TEXELS);
        const bent_frame f = bent_at(positions, 32 * column, 32 * row);
        double at[2] = {(x + 0.5) * 2 / TEXELS - 1, (y + 0.5) * 2 / TEXELS - 1}, shares[2];
        const double radius = hypot(at[0], at[1]);
        for (int k = 0; k < 2; k++)
            at[k] *= fmin(1, 0.97 / radius);
        if (!bent_expected(s, &f, at, cap, shares))
            continue;
        const float *found = texture_texel(texels, POINTS, TEXELS, column, row, 0, x, y);
        for (int k = 0; k < 2; k++)
            if (!(fabs((double)found[k] / (double)found[2] - shares[k]) < 3e-3))
                fail_msg("point %u, %u, texel %d, %d: %g of the picture, expected %g", column, row, x, y,
                         (double)found[k] / (double)found[2], shares[k]);
        compared++;
    }
    return compared;
}

/* The same shape from triangles, with the coordinates of the pane at their corners. */
static void fill_as_mesh(const float *positions, float *grid)
{
    static float uvs[2 * SHAPE * SHAPE];
    static uint32_t indices[6 * SHAPE * SHAPE];
    static uint8_t mask[SHAPE * SHAPE];
    uint32_t count = 0;
    for (uint32_t i = 0; i < SHAPE * SHAPE; i++) {
        uvs[2 * i] = 0.096f * (float)(i % SHAPE) / (SHAPE - 1);
        uvs[2 * i + 1] = 0.064f * (float)(i / SHAPE) / (SHAPE - 1);
        const uint32_t corners[6] = {i, i + 1, i + SHAPE, i + 1, i + SHAPE + 1, i + SHAPE};
        if (i % SHAPE == SHAPE - 1 || i / SHAPE == SHAPE - 1)
            continue;
        memcpy(indices + count, corners, sizeof corners);
        count += 6;
    }
    REQUIRE(virga_glass_fill_from_mesh(positions, uvs, SHAPE * SHAPE, indices, count, 0.096f, 0.064f, SHAPE, SHAPE,
                                       grid, mask) == VIRGA_OK);
}

/* A windshield, given as positions or as a mesh. To 0.003 of the picture: the shape has 33 nodes a side. */
static void check_bent(textured *t, bool mesh, double away_m)
{
    static float positions[3 * SHAPE * SHAPE], grid[3 * SHAPE * SHAPE];
    shot *const s = &t->shot;
    virga_glass_fill_windshield(0.096f, 0.064f, 25, 0.12f, SHAPE, SHAPE, positions);
    if (mesh)
        fill_as_mesh(positions, grid);
    virga_glass_shape shape = virga_default_glass_shape();
    shape.positions = mesh ? grid : positions;
    shape.columns = shape.rows = SHAPE;
    REQUIRE(virga_glass_shape_set(s->glass, &shape) == VIRGA_OK);
    shot_step(s, 1);
    shot_aim(s, (const double[3]){0.01, 0.04, away_m}, (const double[3]){0, 0.03, 0}, 70);
    REQUIRE(compare_bent(s, draw_and_read_textures(t), positions) > 300);
}

static void textures_of_a_bent_pane_from_outside(void **state)
{
    check_bent(*state, false, 0.13);
}

static void textures_of_a_bent_pane_from_inside(void **state)
{
    check_bent(*state, false, -0.15);
}

static void textures_of_a_mesh_pane_from_outside(void **state)
{
    check_bent(*state, true, 0.13);
}

static void textures_of_a_mesh_pane_from_inside(void **state)
{
    check_bent(*state, true, -0.15);
}

/* The pane of these six cases. */
static int open_traced(void **state)
{
    static textured t;
    *state = &t;
    open_textures(&t, POINTS, TEXELS);
    put_even_balls(&t.shot);
    memset(&t.shot.settings.lighting.environment_sh, 0, sizeof t.shot.settings.lighting.environment_sh);
    return 0;
}

static int close_traced(void **state)
{
    close_textures(*state);
    return 0;
}

/* ---- the blend */

static double mixed(double a, double b, double t)
{
    return a + (b - a) * t;
}

/* A texture at (x, y) radii from the drop's middle, filtered, red or green. */
static double filtered(const float *texels, uint32_t column, uint32_t row, uint32_t level, const double at[2], int c)
{
    const int side = TEXELS >> level;
    double t[2];
    int low[2];
    for (int i = 0; i < 2; i++) {
        const double texel = fmin(fmax((0.5 * at[i] + 0.5) * side - 0.5, 0), side - 1);
        low[i] = (int)fmin(texel, side - 2);
        t[i] = texel - low[i];
    }
    double rows[2];
    for (int y = 0; y < 2; y++)
        rows[y] =
            mixed((double)texture_texel(texels, POINTS, TEXELS, column, row, level, low[0], low[1] + y)[c],
                  (double)texture_texel(texels, POINTS, TEXELS, column, row, level, low[0] + 1, low[1] + y)[c], t[0]);
    return mixed(rows[0], rows[1], t[1]);
}

/* Where on the texture of a point of the mesh a drop finds what it shows at `at`, in radii: both turn the eye's ray by
 * 2 h (n - 1) times the distance from the middle, and the rays differ. */
static void find_on_texture(const shot *s, const double middle[2], const double point[2], const double at[2],
                            double found[2])
{
    const double turned = 2 * tan(glass_seen_deg(&s->settings) * M_PI / 360) * (WATER - 1);
    for (int i = 0; i < 2; i++)
        found[i] = at[i] + (point[i] - middle[i]) / fabs(s->camera.position_m[2]) / turned;
}

/* What a drop at (u, v) shows: bilinear between those of the four textures around it that show it. */
static double blended(const shot *s, const float *texels, const double middle[2], uint32_t level, const double at[2],
                      int c)
{
    const double grid[2] = {middle[0] / 0.096 * (POINTS - 1), middle[1] / 0.064 * (POINTS - 1)};
    const uint32_t low[2] = {(uint32_t)grid[0], (uint32_t)grid[1]};
    double sum = 0, weights = 0;
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t column = low[0] + i % 2, row = low[1] + i / 2;
        const double point[2] = {0.096 * column / (POINTS - 1), 0.064 * row / (POINTS - 1)};
        double found[2];
        find_on_texture(s, middle, point, at, found);
        const double weight = (1 - fabs(grid[0] - column)) * (1 - fabs(grid[1] - row)) *
                              fmin(fmax((1 - hypot(found[0], found[1])) / 0.25, 1e-3), 1);
        sum += weight * filtered(texels, column, row, level, found, c);
        weights += weight;
    }
    return sum / weights;
}

/* Drops as wide as the first and the second level have texels, anywhere on the pane: each pixel to 0.003. */
static void a_drop_blends_the_four_textures_around_it(void **state)
{
    (void)state;
    textured t;
    shot *const s = &t.shot;
    open_textures(&t, POINTS, TEXELS);
    put_even_balls(s);
    shot_face(s, -1, 30);
    const double px_m = 0.096 / WIDTH, alpha = 64 / (64 + 1.0 / 12);
    for (uint32_t level = 0; level < 2; level++)
        for (uint32_t k = 0; k < 12; k++) {
            const double middle[2] = {0.01 + 0.075 * (double)virga_unit(virga_hash2(k, 1)),
                                      0.01 + 0.043 * (double)virga_unit(virga_hash2(k, 2))};
            const double radius = px_m * (8 >> level) * 0.999;
            shot_forget(s);
            shot_drop(s, middle[0], middle[1], shot_water(s, radius));
            const float *texels = draw_and_read_textures(&t);
            uint32_t used = 0;
            for (int i = 0; i < WIDTH * HEIGHT; i++) {
                /* seen from behind: u goes to the left */
                const double at[2] = {(0.096 - (i % WIDTH + 0.5) * px_m - middle[0]) / radius,
                                      (0.064 - (i / WIDTH + 0.5) * px_m - middle[1]) / radius};
                if (hypot(at[0], at[1]) > 0.75)
                    continue;
                for (int c = 0; c < 2; c++)
                    assert_float_equal((double)t.pixels[4 * i + c] / alpha, blended(s, texels, middle, level, at, c),
                                       level ? 5e-3 : 3e-3);
                used++;
            }
            REQUIRE(used > (level ? 20u : 90u));
        }
    close_textures(&t);
}

/* A thousand drops of at most about half a pixel cover as much of the picture as they have area, to 2.5 %: those that
 * just have a rim are sampled by few pixels. */
static void drops_smaller_than_a_pixel_keep_their_area(void **state)
{
    (void)state;
    textured t;
    shot *const s = &t.shot;
    double area = 0;
    open_textures(&t, POINTS, TEXELS);
    shot_face(s, -1, 30);
    const double px_m = 0.096 / WIDTH;
    for (uint32_t k = 0; k < 1000; k++) {
        const double radius = px_m * (0.05 + 0.5 * (double)virga_unit(virga_hash2(k, 5)));
        const double u = 0.002 + 0.092 * (k % 40 + 0.9 * (double)virga_unit(virga_hash2(k, 6))) / 40;
        const virga_glass_drop_gpu *drop =
            shot_drop(s, u, 0.002 + 0.06 * (k / 40 + 0.9 * (double)virga_unit(virga_hash2(k, 7))) / 25,
                      shot_water(s, radius) + 1);
        area += M_PI * pow(ball_of(s, drop).radius / px_m, 2);
    }
    draw_and_read_textures(&t);
    assert_float_equal(sum_of_alpha(t.pixels, 0, WIDTH) / area, 1, 0.025);
    close_textures(&t);
}

/* ---- when textures are made anew */

static void put_plate(shot *s, float red)
{
    float *pixels = malloc(16ull * WIDTH * HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        pixels[4 * i] = red * (float)(i % WIDTH) / WIDTH;
        pixels[4 * i + 1] = (float)(i / WIDTH) / HEIGHT;
        pixels[4 * i + 2] = pixels[4 * i + 3] = 1;
    }
    shot_plate(s, pixels);
    free(pixels);
}

static bool same_textures(const textured *t, const float *a, const float *b)
{
    return !memcmp(a, b, texture_bytes(t));
}

/* Five of the sixteen a frame: after four frames they are those that are made all at once, and not before. */
static void in_turn_they_end_up_the_same_as_at_once(void **state)
{
    (void)state;
    textured t;
    shot *const s = &t.shot;
    open_textures(&t, POINTS, TEXELS);
    shot_face(s, -1, 30);
    put_plate(s, 0.5f);
    float *whole = keep_textures(&t, draw_and_read_textures(&t));
    put_plate(s, 1);
    s->settings.textures_per_frame = 5;
    for (int frame = 1; frame <= 4; frame++) {
        put_plate(s, frame == 4 ? 0.5f : 1);
        const float *texels = draw_and_read_textures(&t);
        assert_false(same_textures(&t, texels, whole));
    }
    for (int frame = 1; frame <= 3; frame++)
        assert_int_equal(same_textures(&t, draw_and_read_textures(&t), whole), frame == 3);
    free(whole);
    close_textures(&t);
}

/* With still_behind they stay, although the plate changed, until the camera moves. */
static void before_a_photo_they_are_kept_until_the_camera_moves(void **state)
{
    (void)state;
    textured t;
    shot *const s = &t.shot;
    open_textures(&t, POINTS, TEXELS);
    s->settings.still_behind = true;
    shot_face(s, -1, 30);
    put_plate(s, 0.5f);
    float *first = keep_textures(&t, draw_and_read_textures(&t));
    put_plate(s, 1);
    assert_true(same_textures(&t, draw_and_read_textures(&t), first));
    s->camera.position_m[0] += 0.01;
    assert_false(same_textures(&t, draw_and_read_textures(&t), first));
    free(first);
    close_textures(&t);
}

/* The host throws away the frame that made them: the next makes all. */
static void textures_of_a_lost_frame_are_made_again(void **state)
{
    (void)state;
    textured t;
    shot *const s = &t.shot;
    open_textures(&t, POINTS, TEXELS);
    shot_face(s, -1, 30);
    s->settings.still_behind = true;
    put_plate(s, 0.5f);
    float *before = keep_textures(&t, draw_and_read_textures(&t));
    s->camera.position_m[0] += 0.01;
    lose_frame(&t);
    float *after = keep_textures(&t, draw_and_read_textures(&t));
    assert_false(same_textures(&t, after, before));
    s->settings.still_behind = false;
    assert_true(same_textures(&t, draw_and_read_textures(&t), after));
    free(before);
    free(after);
    close_textures(&t);
}

/* ---- memory */

/* A far window of a facade: of a hundred there is room for all where there is not for ten with a height map. */
static void a_far_window_takes_a_tenth_of_the_memory(void **state)
{
    (void)state;
    virga_glass_def near = virga_default_glass_def(), far;
    near.width_m = 1.2f;
    near.height_m = 1.5f;
    far = near;
    far.cell_m = 0.005f;
    far.max_drops = 2048;
    far.max_texels = 64;
    far.texture_columns = far.texture_rows = 5;
    far.texture_texels = 8;
    assert_true(10 * virga_glass_estimate(&far) < virga_glass_estimate(&near));
}

/* ---- from shapes to textures */

/* A bright sky over a dark street with lamps. */
static void put_street(shot *s)
{
    float *pixels = malloc(16ull * WIDTH * HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        const bool lamp = x % 40 < 6 && y > 60 && y < 66;
        for (int c = 0; c < 4; c++)
            pixels[4 * i + c] = c == 3 ? 1 : lamp ? 4.0f - (float)c : y < 80 ? 0.8f : 0.1f;
    }
    shot_plate(s, pixels);
    free(pixels);
}

/* The camera backs away. Drops of 0.6 to 1 mm: all are larger than 8 px in the first frame and smaller than 5.6 in the
 * last. */
static void look_from(shot *s, int frame)
{
    const double away = 0.045 * pow(1.02, frame);
    shot_aim(s, (const double[3]){0.048, 0.032, -away}, (const double[3]){0.048, 0.032, 0}, 40);
}

static double mean_apart(const float *a, const float *b)
{
    double sum = 0;
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        sum += fabs((double)a[i] - (double)b[i]);
    return sum / (4 * WIDTH * HEIGHT);
}

static double largest_apart(const float *a, const float *b)
{
    double most = 0;
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        most = fmax(most, fabs((double)a[i] - (double)b[i]));
    return most;
}

enum { ZOOM_FRAMES = 72 };

/* A zoom of 2 % a frame. With the exact drops alone pixels change by so much from frame to frame, on average and at
 * most; where drops turn into textures on the way they change by no more. */
static void a_zoom_does_not_show_where_drops_turn_into_textures(void **state)
{
    (void)state;
    textured t;
    shot *const s = &t.shot;
    float *before[2];
    double mean[2] = {0}, most[2] = {0};
    virga_glass_def def = shot_def();
    def.max_texels = 1024;
    open_textures_of(&t, &def, 11, TEXELS);
    put_street(s);
    for (uint32_t k = 0; k < 60; k++)
        shot_drop(s, 0.034 + 0.003 * (k % 10), 0.024 + 0.003 * (k / 10),
                  shot_water(s, 0.6e-3 + 0.4e-3 * (double)virga_unit(virga_hash2(k, 3))));
    s->settings.style = VIRGA_GLASS_STYLE_PHYSICAL;
    for (int way = 0; way < 2; way++) {
        before[way] = malloc(16ull * WIDTH * HEIGHT);
        s->settings.textured_px = way ? 8 : 0;
        for (int frame = 0; frame < ZOOM_FRAMES; frame++) {
            look_from(s, frame);
            draw_and_read_textures(&t);
            if (frame) {
                mean[way] = fmax(mean[way], mean_apart(t.pixels, before[way]));
                most[way] = fmax(most[way], largest_apart(t.pixels, before[way]));
            }
            memcpy(before[way], t.pixels, 16ull * WIDTH * HEIGHT);
        }
    }
    const double end = mean_apart(before[0], before[1]);
    if (!(mean[1] < 1.1 * mean[0] && most[1] < 1.1 * most[0]))
        fail_msg("from frame to frame %g on average and %g at most; exact %g and %g; at the end %g apart", mean[1],
                 most[1], mean[0], most[0], end);
    free(before[0]);
    free(before[1]);
    close_textures(&t);
}

/* ---- the same bits */

/* A frame's pixels, drops on top of each other too; to be freed. */
static float *whole_frame(const char *threads, bool reversed)
{
    textured t;
    shot *const s = &t.shot;
    ball balls[BALLS];
    effect_device_set_threads(threads);
    open_textures(&t, POINTS, TEXELS);
    put_even_balls(s);
    shot_face(s, 1, 30);
    put_balls(s, balls, BALLS);
    s->settings.style = VIRGA_GLASS_STYLE_PHYSICAL;
    s->settings.textured_px = 14;
    t.reversed = reversed;
    draw_and_read_textures(&t);
    float *pixels = malloc(16ull * WIDTH * HEIGHT);
    memcpy(pixels, t.pixels, 16ull * WIDTH * HEIGHT);
    close_textures(&t);
    return pixels;
}

static void any_number_of_threads_draws_the_same(void **state)
{
    (void)state;
    float *one = whole_frame("1", false), *four = whole_frame("4", false);
    assert_true(sum_of_alpha(one, 0, WIDTH) > 1000);
    assert_memory_equal(one, four, 16ull * WIDTH * HEIGHT);
    free(one);
    free(four);
}

/* Depth is only compared, so a reversed one shows the same. The matrices round differently. */
static void a_reversed_depth_draws_the_same(void **state)
{
    (void)state;
    float *one = whole_frame("4", false), *other = whole_frame("4", true);
    double sum = 0;
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        sum += fabs((double)one[i] - (double)other[i]);
    assert_true(sum / sum_of_alpha(one, 0, WIDTH) < 1e-3);
    free(one);
    free(other);
}

int main(void)
{
    const struct CMUnitTest traced[] = {
        cmocka_unit_test(textures_of_a_flat_pane_from_outside), cmocka_unit_test(textures_of_a_flat_pane_from_inside),
        cmocka_unit_test(textures_of_a_bent_pane_from_outside), cmocka_unit_test(textures_of_a_bent_pane_from_inside),
        cmocka_unit_test(textures_of_a_mesh_pane_from_outside), cmocka_unit_test(textures_of_a_mesh_pane_from_inside),
    };
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_drop_blends_the_four_textures_around_it),
        cmocka_unit_test(drops_smaller_than_a_pixel_keep_their_area),
        cmocka_unit_test(in_turn_they_end_up_the_same_as_at_once),
        cmocka_unit_test(before_a_photo_they_are_kept_until_the_camera_moves),
        cmocka_unit_test(textures_of_a_lost_frame_are_made_again),
        cmocka_unit_test(a_far_window_takes_a_tenth_of_the_memory),
        cmocka_unit_test(a_zoom_does_not_show_where_drops_turn_into_textures),
        cmocka_unit_test(any_number_of_threads_draws_the_same),
        cmocka_unit_test(a_reversed_depth_draws_the_same),
    };
    const int failed = cmocka_run_group_tests(traced, open_traced, close_traced);
    return effect_fixture_close(failed + cmocka_run_group_tests(tests, NULL, NULL));
}
