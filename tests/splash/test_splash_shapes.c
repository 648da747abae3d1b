/* test_splash_shapes.c - piles, crowns and disks in the picture while they live, near by and far away. */
#include "splash_picture_fixture.h"

/* ---- piles */

/* A droplet and its pile are two sprites, and a view has room for as many as there are droplets. */
static void sprites_that_have_no_room_are_counted(void **state)
{
    (void)state;
    enum { PILES = 200, ROOM = 256 };
    virga_splash_def def = splash_fixture_def();
    virga_droplet_gpu droplets[PILES];
    virga_splash_stats stats;
    shot s;
    def.max_droplets = ROOM;
    open_shot_of(&s, &def);
    aim_from(&s, 0.1);
    for (int style = 0; style < 2; style++) {
        s.f.settings.style = style ? VIRGA_SPLASH_STYLE_FILM : VIRGA_SPLASH_STYLE_PAPER;
        apply_settings(&s);
        put_pile(&s, 0);
        REQUIRE(drawn_alpha(&s) > 0);
        virga_splash_stats_get(s.f.splash, &stats);
        assert_int_equal(stats.sprites, 2);
        assert_int_equal(stats.sprites_dropped, 0);
        for (int i = 0; i < PILES; i++)
            droplets[i] = rising(0);
        splash_fixture_put(&s.f, droplets, PILES);
        splash_fixture_step(&s.f, 1);
        REQUIRE(drawn_alpha(&s) > 0);
        virga_splash_stats_get(s.f.splash, &stats);
        assert_int_equal(stats.sprites, ROOM);
        assert_int_equal(stats.sprites_dropped, 2 * PILES - ROOM);
        assert_int_equal(stats.sheets_dropped, 0);
    }
    close_shot(&s);
}

static const virga_sprite_gpu *sprite_of_kind(const shot *s, uint32_t kind)
{
    const virga_sprite_gpu *list = s->sprites.mapped;
    for (uint32_t i = 0; i < prepared(s)->sprites; i++)
        if (list[i].kind == kind)
            return &list[i];
    return NULL;
}

/* Coverage of what lies between two heights above the middle (m). */
static double covered_between(const shot *s, const float *pixels, double low_m, double high_m)
{
    double sum = 0, low[2], high[2];
    to_pixels(s, (const double[3]){0, low_m, 0}, low);
    to_pixels(s, (const double[3]){0, high_m, 0}, high);
    for (size_t i = 0; i < pixel_count(s); i++) {
        const double y = (double)(i / s->picture.width) + 0.5;
        sum += y > high[1] && y < low[1] ? (double)pixels[i * 4 + 3] : 0;
    }
    return sum;
}

/* Droplet and tip, where doubles put the droplet. */
static void check_tip(shot *s)
{
    double position[3], pixel[2];
    for (int i = -1; i <= 1; i++) {
        s->after_s = i * 0.004;
        draw_frame(s);
        const virga_sprite_gpu *pile = sprite_of_kind(s, VIRGA_SPRITE_PILE),
                               *droplet = sprite_of_kind(s, VIRGA_SPRITE_DROPLET);
        assert_non_null(pile);
        assert_non_null(droplet);
        droplet_at(s, s->after_s, position);
        to_pixels(s, position, pixel);
        for (int axis = 0; axis < 2; axis++) {
            assert_true(fabsf(pile->head[axis] - droplet->head[axis]) < 1e-6f);
            assert_true(fabs((0.5 + 0.5 * (double)pile->head[axis]) * SIDE - pixel[axis]) < 0.01);
        }
    }
    s->after_s = 0;
}

static void a_pile_stands_until_its_droplet_leaves_and_then_sinks(void **state)
{
    (void)state;
    shot s;
    double position[3];
    open_shot(&s);
    s.f.settings.pile_max_s = 0.1f;
    s.f.settings.pile_max_m = 0.2f;
    apply_settings(&s);
    aim_from(&s, 0.1);
    put_pile(&s, -0.05f); /* has not risen yet */
    assert_true(drawn_alpha(&s) == 0);
    put_pile(&s, 0);
    droplet_at(&s, 0, position);
    double below = covered_between(&s, draw_frame(&s), -0.02, position[1] - 2e-3);
    assert_true(below > 20); /* 23 px high and 2 or more wide */
    assert_int_equal(prepared(&s)->sprites, 2);
    check_tip(&s);
    /* It leaves at 20 ms, and the pile is down again at 40 ms. */
    s.f.settings.pile_max_s = 0.02f;
    apply_settings(&s);
    splash_fixture_step(&s.f, 1);
    droplet_at(&s, 0, position);
    REQUIRE(s.f.droplets[0].kind & VIRGA_DROPLET_FREE);
    const double free_s = 0.02, since = 2.0 / 60 - free_s, left = 1 - since / free_s * (since / free_s);
    double tip[3], top[2];
    droplet_at(&s, -since, tip);
    tip[1] = -0.02 + left * (tip[1] + 0.02);
    to_pixels(&s, tip, top);
    below = covered_between(&s, draw_frame(&s), -0.02, position[1] - 2e-3);
    assert_true(below > 5);
    assert_true(covered_between(&s, draw_frame(&s), tip[1] + 1e-3, position[1] - 2e-3) < 1e-6);
    const virga_sprite_gpu *pile = sprite_of_kind(&s, VIRGA_SPRITE_PILE);
    assert_non_null(pile);
    assert_true(fabs((0.5 + 0.5 * (double)pile->head[1]) * SIDE - top[1]) < 0.1);
    splash_fixture_step(&s.f, 1);
    droplet_at(&s, 0, position);
    const float *pixels = draw_frame(&s);
    assert_int_equal(prepared(&s)->sprites, 1);
    assert_true(covered_between(&s, pixels, -0.03, position[1] - 2e-3) == 0);
    assert_true(sum_of(&s, pixels, 3) > 5);
    close_shot(&s);
}

/* ---- crowns, disks */

/* Pieces of what is covered: pixels that touch, also at corners. */
static uint32_t pieces(const shot *s, const float *pixels)
{
    const int w = (int)s->picture.width, h = (int)s->picture.height;
    int *stack = malloc(pixel_count(s) * sizeof *stack);
    bool *seen = calloc(pixel_count(s), sizeof *seen);
    uint32_t found = 0;
    for (int start = 0; start < w * h; start++) {
        int depth = 0;
        if (seen[start] || !(pixels[start * 4 + 3] > 0))
            continue;
        found++;
        seen[start] = true;
        stack[depth++] = start;
        while (depth) {
            const int at = stack[--depth];
            for (int i = 0; i < 9; i++) {
                const int x = at % w + i % 3 - 1, y = at / w + i / 3 - 1;
                if (x < 0 || y < 0 || x >= w || y >= h || seen[y * w + x] || !(pixels[(y * w + x) * 4 + 3] > 0))
                    continue;
                seen[y * w + x] = true;
                stack[depth++] = y * w + x;
            }
        }
    }
    free(stack);
    free(seen);
    return found;
}

/* Its life is 50 ms: three ticks. Nothing is left of it then, neither between ticks nor after some more of them. */
static void check_end(shot *s)
{
    splash_fixture_step(&s->f, 1);
    assert_true(drawn_alpha(s) > 20);
    s->after_s = 0.02; /* of age 53 ms */
    assert_true(drawn_alpha(s) == 0);
    assert_int_equal(prepared(s)->sprites, 0);
    s->after_s = 0;
    splash_fixture_step(&s->f, 2);
    assert_true(drawn_alpha(s) == 0);
    assert_int_equal(prepared(s)->sprites, 0);
}

static void a_crown_near_by_is_a_sheet_while_it_lives(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    put_crown(&s);
    aim(&s, (const double[3]){0, 0.02, 0.06}, nowhere);
    assert_true(drawn_alpha(&s) > 20);
    assert_int_equal(prepared(&s)->crowns.index_count, VIRGA_CROWN_INDICES);
    assert_int_equal(prepared(&s)->crowns.instance_count, 1);
    assert_int_equal(prepared(&s)->sprites, 0);
    check_end(&s);
    assert_int_equal(prepared(&s)->crowns.instance_count, 0);
    close_shot(&s);
}

/* A drop of 2 mm on deep water, and its crown after 17 ms, on the left of the picture's middle. */
static void put_tall_crown(shot *s)
{
    splash_fixture_clear(&s->f);
    s->f.settings.droplet_range_m = 0; /* nothing but the crown */
    apply_settings(s);
    virga_spawn_gpu *spawn = splash_fixture_spawn(&s->f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_10);
    spawn->kind &= ~(255u << 16);
    spawn->kind |= VIRGA_SPLASH_CROWN_CONE << 16;
    spawn->water_nl = 0;
    splash_fixture_step(&s->f, 1);
    aim(s, (const double[3]){0, 0.015, 0.05}, (const double[3]){0.004, 0.004, 0});
    s->give_color = s->give_depth = true;
    s->scene_depth = stored_depth(s, 0.1);
}

/* What reflects and refracts light that is the same from everywhere can not be seen before it. */
static void a_crown_in_even_light_is_not_seen(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    put_tall_crown(&s);
    s.even = 1;
    memset(s.f.settings.lighting.environment_sh, 0, sizeof s.f.settings.lighting.environment_sh);
    for (int c = 0; c < 3; c++)
        s.f.settings.lighting.environment_sh[0][c] = (float)(2 * sqrt(M_PI));
    apply_settings(&s);
    const float *pixels = draw_frame(&s);
    double max_error = 0;
    for (size_t i = 0; i < pixel_count(&s); i++)
        max_error = fmax(max_error, fabs((double)pixels[i * 4] - (double)pixels[i * 4 + 3]));
    printf("alpha %.1f px, a pixel is off by up to %.1e\n", sum_of(&s, pixels, 3), max_error);
    assert_true(sum_of(&s, pixels, 3) > 300);
    assert_true(max_error < 1e-4);
    close_shot(&s);
}

/* A tall crown, seen from the side under a black sky, before a scene 0.1 m away. */
static void open_before_wall(shot *s, float even)
{
    open_shot(s);
    put_tall_crown(s);
    aim(s, (const double[3]){0, 0.003, 0.03}, (const double[3]){0, 0.003, 0});
    s->scene_depth = stored_depth(s, 0.1);
    s->even = even;
    memset(s->f.settings.lighting.environment_sh, 0, sizeof s->f.settings.lighting.environment_sh);
    apply_settings(s);
}

/* Just left of the middle, below the rim: there the scene has no green, but what the wall bends comes from beside. Of a
 * wall that bends nothing it was 3.5 px. */
static void a_crowns_wall_bends_what_is_behind_it(void **state)
{
    (void)state;
    shot s;
    open_before_wall(&s, 0);
    const float *pixels = draw_frame(&s);
    double kept = 0, bent = 0;
    for (size_t y = SIDE / 2 + 7; y < SIDE / 2 + 17; y++)
        for (size_t x = SIDE / 2 - 16; x < SIDE / 2; x++) {
            kept += (double)pixels[(y * SIDE + x) * 4];
            bent += (double)pixels[(y * SIDE + x) * 4 + 1];
        }
    printf("of 160 px: red %.1f px, green %.1f px\n", kept, bent);
    assert_true(kept > 50 && bent > 30);
    close_shot(&s);
}

/* Before white, under a black sky, a wall lacks what it mirrors: F = 0.0204 straight on, and of a film 2 F / (1 + F),
 * with what is mirrored between its faces. A part that faces the eye, to 15 %: the wall is not quite upright. */
static void a_crowns_wall_mirrors_with_both_faces(void **state)
{
    (void)state;
    shot s;
    open_before_wall(&s, 1);
    const float *pixels = draw_frame(&s);
    double lacks = 0;
    for (size_t y = SIDE / 2 + 7; y < SIDE / 2 + 17; y++)
        for (size_t x = SIDE / 2 - 4; x < SIDE / 2 + 4; x++)
            lacks += ((double)pixels[(y * SIDE + x) * 4 + 3] - (double)pixels[(y * SIDE + x) * 4]) / 80;
    const double face = 0.0204;
    printf("%.4f mirrored\n", lacks);
    assert_float_equal(lacks / (2 * face / (1 + face)), 1, 0.15);
    close_shot(&s);
}

static void a_crown_of_the_paper_is_of_pyramids(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    s.f.settings.style = VIRGA_SPLASH_STYLE_PAPER;
    apply_settings(&s);
    put_crown(&s);
    aim(&s, (const double[3]){0, 0.04, 0.004}, nowhere); /* from above */
    const float *pixels = draw_frame(&s);
    const uint32_t count = pieces(&s, pixels);
    printf("%u pyramids\n", count);
    assert_int_equal(count, VIRGA_CROWN_PYRAMIDS);
    assert_int_equal(prepared(&s)->crowns.index_count, 12 * VIRGA_CROWN_PYRAMIDS);
    assert_int_equal(prepared(&s)->sprites, 0);
    check_end(&s);
    assert_int_equal(prepared(&s)->crowns.index_count, 0);
    close_shot(&s);
}

/* Width and height of what is covered. */
static void extent_of(const shot *s, const float *pixels, int extent[2])
{
    int low[2] = {INT_MAX, INT_MAX}, high[2] = {-1, -1};
    for (size_t i = 0; i < pixel_count(s); i++) {
        const int at[2] = {(int)(i % s->picture.width), (int)(i / s->picture.width)};
        for (int axis = 0; axis < 2 && pixels[i * 4 + 3] > 0.01f; axis++) {
            low[axis] = at[axis] < low[axis] ? at[axis] : low[axis];
            high[axis] = at[axis] > high[axis] ? at[axis] : high[axis];
        }
    }
    for (int axis = 0; axis < 2; axis++)
        extent[axis] = high[axis] < 0 ? 0 : high[axis] - low[axis] + 1;
}

static void put_disk(shot *s)
{
    splash_fixture_clear(&s->f);
    const virga_spawn_gpu *spawn = splash_fixture_spawn(&s->f, VIRGA_MATERIAL_STEEL, VIRGA_GROUND_DRY);
    REQUIRE((spawn->kind >> 16 & 255) == VIRGA_SPLASH_DISK);
    splash_fixture_step(&s->f, 1);
}

static void a_disk_lies_flat_and_stays_for_two_seconds(void **state)
{
    (void)state;
    shot s;
    int extent[2];
    open_shot(&s);
    put_disk(&s);
    for (int i = 0; i < 4; i++)
        splash_fixture_step(&s.f, 15); /* of age 61 / 60 s */
    const double weber = 998.2 * 6.5 * 6.5 * 2e-3 / 0.0728, radius = 0.5 * 2e-3 * pow(weber, 0.25) * 0.65;
    aim(&s, (const double[3]){0, 0.05, 0.001}, nowhere);
    const float *pixels = draw_frame(&s);
    const double early = sum_of(&s, pixels, 3), across = 2 * radius / pixel_m(&s, 0.05);
    extent_of(&s, pixels, extent);
    printf("from above a disk is %d x %d px, of %.1f\n", extent[0], extent[1], across);
    for (int axis = 0; axis < 2; axis++)
        assert_near(extent[axis], across, 0.15);         /* its rim is wavy by a tenth */
    aim(&s, (const double[3]){0, 0.01, 0.049}, nowhere); /* a fifth as high as far */
    extent_of(&s, draw_frame(&s), extent);
    printf("from the side %d x %d px\n", extent[0], extent[1]);
    assert_near(extent[0], across, 0.15);
    assert_true(fabs(extent[1] - 0.2 * across) < 2);
    aim(&s, (const double[3]){0, 0.05, 0.001}, nowhere);
    splash_fixture_step(&s.f, 15);
    assert_near(drawn_alpha(&s), early, 1e-3);
    for (int i = 0; i < 2; i++)
        splash_fixture_step(&s.f, 16);
    splash_fixture_step(&s.f, 8); /* of age 116 / 60 */
    const double late = drawn_alpha(&s);
    assert_true(late > 0 && late < 0.5 * early);
    splash_fixture_step(&s.f, 6);
    assert_true(drawn_alpha(&s) == 0);
    close_shot(&s);
}

/* Summed coverage from a distance, 30 degrees above the level: the mean over positions between pixels. It shows as
 * `max` pieces at most; 0: any number. */
static double blob_alpha(shot *s, double distance_m, uint32_t max)
{
    const double pixel = pixel_m(s, distance_m);
    double sum = 0;
    for (int i = 0; i < BLOB_POSITIONS * BLOB_POSITIONS; i++) {
        const double right = (double)(i % BLOB_POSITIONS) / BLOB_POSITIONS * pixel,
                     up = (double)(i / BLOB_POSITIONS) / BLOB_POSITIONS * pixel;
        aim(s, (const double[3]){right, 0.5 * distance_m + up, 0.8660254 * distance_m},
            (const double[3]){right, up, 0});
        const float *pixels = draw_frame(s);
        const uint32_t count = pieces(s, pixels);
        sum += sum_of(s, pixels, 3) / (BLOB_POSITIONS * BLOB_POSITIONS);
        assert_true(!max || (count > max / 3 && count <= max));
        assert_int_equal(prepared(s)->sprites, 1);
        assert_int_equal(prepared(s)->crowns.instance_count, 0);
    }
    return sum;
}

/* Times the square of the distance it stays the same, from blobs of 9 pixels to those of less than one. */
static void check_blob(shot *s, double first_m, uint32_t max)
{
    const double at_first = blob_alpha(s, first_m, max) * first_m * first_m;
    double max_error = 0;
    for (int i = 1; i < 5; i++) {
        const double distance = ldexp(first_m, i),
                     share = blob_alpha(s, distance, max) * distance * distance / at_first;
        printf("from %.2f m: %.3f of the blob\n", distance, share);
        max_error = fmax(max_error, fabs(share - 1));
    }
    assert_true(max_error < 0.1);
}

static void a_crown_far_away_is_a_blob_that_covers_what_its_size_gives(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    s.f.settings.parts_px = 10000;
    apply_settings(&s);
    put_crown(&s);
    check_blob(&s, 0.25, 1);
    close_shot(&s);
}

/* Ring and droplets near by, a spot farther away. */
static void a_small_crown_covers_the_same_with_its_parts_and_as_a_spot(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    put_crown(&s);
    check_blob(&s, 0.25, 0);
    close_shot(&s);
}

static void a_disk_far_away_is_a_blob_that_covers_what_its_size_gives(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    put_disk(&s);
    splash_fixture_step(&s.f, 15);
    check_blob(&s, 0.25, 1);
    close_shot(&s);
}

/* They cover what as many would one by one. */
static void a_splash_that_stands_for_several_shows_them_side_by_side(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    put_crown(&s);
    const double one = blob_alpha(&s, 2, 1);
    for (uint32_t weight = 3; weight <= 12; weight += 3) {
        put_crowns(&s, (float)weight);
        const double share = blob_alpha(&s, 2, weight) / (weight * one);
        printf("%u drops: %.3f of what each covers\n", weight, share);
        assert_true(fabs(share - 1) < 0.1);
    }
    close_shot(&s);
}

/* ---- the light of small water */

static double smooth(double low, double high, double x)
{
    const double t = fmin(fmax((x - low) / (high - low), 0), 1);
    return t * t * (3 - 2 * t);
}

/* What record_plate draws at a place of the picture. */
static void scene_at(const double pixel[2], double rgb[3])
{
    rgb[0] = pixel[0] < SIDE / 2;
    rgb[1] = 1 - rgb[0];
    rgb[2] = pixel[1] < SIDE / 2;
}

/* Light from above, under a white sky, of a splash at `at` before the level camera at `eye`: three heights over the
 * horizon, with the shares of small_water.glsl. The picture shows a direction where a point there is; towards its edges
 * it counts less, and the sky more, which `behind` hides where it is darker. */
static void light_above(const shot *s, const double eye[3], const double at[3], const double behind[3], double rgb[3])
{
    static const double heights[3] = {0.1, 0.3, 0.6}, shares[3] = {0.4, 0.35, 0.25};
    const double x = at[0] - eye[0], z = at[2] - eye[2], length = hypot(x, z);
    double pixel[2], shown[3];
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int i = 0; i < 3; i++) {
        to_pixels(s, (const double[3]){eye[0] + x / length, eye[1] + heights[i], eye[2] + z / length}, pixel);
        const double aside = fabs(pixel[0] / (SIDE / 2) - 1), up = fabs(pixel[1] / (SIDE / 2) - 1);
        const double inside = fmin(fmax(8 - 8 * fmax(aside, up), 0), 1), sky = smooth(-0.2, 0.4, heights[i]);
        scene_at(pixel, shown);
        for (int c = 0; c < 3; c++)
            rgb[c] += shares[i] * (inside * shown[c] + (1 - inside) * (sky + (1 - sky) * fmin(behind[c], 1)));
    }
}

/* The ground behind the splash is red and what stands on it violet. Torn as a puff is, it shows 0.4 + 0.4 * 0.8 of what
 * is above. */
static void small_water_shows_what_is_behind_and_above_it(void **state)
{
    (void)state;
    static const double eye[3] = {0.05, 0.05, 0.5}, above_share = 0.72;
    shot s;
    double behind[3], above[3], max_error = 0;
    int pixels_seen = 0;
    open_shot(&s);
    put_crown(&s);
    s.give_color = true;
    memset(s.f.settings.lighting.environment_sh, 0, sizeof s.f.settings.lighting.environment_sh);
    for (int c = 0; c < 3; c++)
        s.f.settings.lighting.environment_sh[0][c] = (float)(2 * sqrt(M_PI));
    apply_settings(&s);
    aim(&s, eye, (const double[3]){eye[0], eye[1], 0});
    const float *pixels = draw_frame(&s);
    scene_at((const double[2]){0, SIDE - 1}, behind);
    light_above(&s, eye, nowhere, behind, above);
    for (size_t i = 0; i < pixel_count(&s); i++) {
        const double alpha = (double)pixels[i * 4 + 3];
        if (alpha < 0.01)
            continue;
        pixels_seen++;
        for (int c = 0; c < 3; c++) {
            const double light = (1 - above_share) * behind[c] + above_share * above[c];
            max_error = fmax(max_error, fabs((double)pixels[i * 4 + (size_t)c] / alpha - light));
        }
    }
    printf("above: %.3f %.3f %.3f; %d pixels, off by up to %.1e\n", above[0], above[1], above[2], pixels_seen,
           max_error);
    assert_true(pixels_seen >= 4);
    assert_true(max_error < 1e-3);
    assert_int_equal(prepared(&s)->sprites, 1);
    close_shot(&s);
}

/* ---- sheets of feet */

/* How wide and high a picture is covered, in pixels. */
static void extent(const shot *s, const float *pixels, double wide_high[2])
{
    uint32_t low[2] = {UINT32_MAX, UINT32_MAX}, high[2] = {0, 0};
    for (size_t i = 0; i < pixel_count(s); i++) {
        if (!(pixels[i * 4 + 3] > 0.004f))
            continue;
        const uint32_t at[2] = {(uint32_t)(i % s->picture.width), (uint32_t)(i / s->picture.width)};
        for (int axis = 0; axis < 2; axis++) {
            low[axis] = at[axis] < low[axis] ? at[axis] : low[axis];
            high[axis] = at[axis] > high[axis] ? at[axis] : high[axis];
        }
    }
    for (int axis = 0; axis < 2; axis++)
        wide_high[axis] = high[axis] >= low[axis] ? high[axis] - low[axis] + 1 : 0;
}

/* Seen from its side and from its end, in the film's style: its widths are as its axes, 0.3 and 0.2 m, and it is as
 * high as what is thrown up at 1 m/s. Fingers reach up to 1.38 times the height, and the wall's radius there is 1.02
 * times the axis. */
static void the_sheet_of_a_foot_is_as_long_as_its_axes(void **state)
{
    (void)state;
    double seen[2][2];
    shot s;
    open_shot(&s);
    s.f.settings.style = VIRGA_SPLASH_STYLE_FILM;
    s.f.settings.hole_um = 0;
    apply_settings(&s);
    const double up_s = 1 / GRAVITY, high_m = 0.5 / GRAVITY, far_m = 1.5;
    for (int turned = 0; turned < 2; turned++) {
        splash_fixture_clear(&s.f);
        virga_spawn_gpu *spawn = splash_fixture_spawn(&s.f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_5);
        spawn->kind = VIRGA_GROUND_PUDDLE_5 | VIRGA_SPLASH_CROWN_CONE << 16 | VIRGA_SPAWN_SHEET;
        const float velocity[3] = {(float)(0.3 / up_s), -1, (float)(0.2 / up_s)}, along[3] = {!turned, 0, turned};
        memcpy(spawn->velocity, velocity, sizeof velocity);
        memcpy(spawn->normal, along, sizeof along);
        spawn->diameter_m = 0.02f;
        spawn->water_nl = 0;
        splash_fixture_step(&s.f, 1);
        aim(&s, (const double[3]){0, 0.03, far_m}, (const double[3]){0, 0.03, 0});
        s.after_s = up_s - s.f.splash->def.tick_s;
        extent(&s, draw_frame(&s), seen[turned]);
        assert_int_equal(prepared(&s)->crowns.instance_count, 1);
    }
    const double pixel = pixel_m(&s, far_m);
    printf("a sheet of 0.6 x 0.4 m, %.3f m high: %.3f m and %.3f m wide, %.3f m high\n", high_m, seen[0][0] * pixel,
           seen[1][0] * pixel, seen[0][1] * pixel);
    assert_true(seen[0][0] * pixel > 0.5 && seen[0][0] * pixel < 0.66);
    assert_near(seen[0][0] / seen[1][0], 1.5, 0.1);
    assert_true(seen[0][1] * pixel > high_m && seen[0][1] * pixel < 2.2 * high_m);
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sprites_that_have_no_room_are_counted),
        cmocka_unit_test(a_pile_stands_until_its_droplet_leaves_and_then_sinks),
        cmocka_unit_test(a_crown_near_by_is_a_sheet_while_it_lives),
        cmocka_unit_test(a_crown_in_even_light_is_not_seen),
        cmocka_unit_test(a_crowns_wall_bends_what_is_behind_it),
        cmocka_unit_test(a_crowns_wall_mirrors_with_both_faces),
        cmocka_unit_test(a_crown_of_the_paper_is_of_pyramids),
        cmocka_unit_test(a_disk_lies_flat_and_stays_for_two_seconds),
        cmocka_unit_test(a_crown_far_away_is_a_blob_that_covers_what_its_size_gives),
        cmocka_unit_test(a_small_crown_covers_the_same_with_its_parts_and_as_a_spot),
        cmocka_unit_test(a_disk_far_away_is_a_blob_that_covers_what_its_size_gives),
        cmocka_unit_test(small_water_shows_what_is_behind_and_above_it),
        cmocka_unit_test(the_sheet_of_a_foot_is_as_long_as_its_axes),
        cmocka_unit_test(a_splash_that_stands_for_several_shows_them_side_by_side),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
