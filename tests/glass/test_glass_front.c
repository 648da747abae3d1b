/* test_glass_front.c - drops on the camera's front element: the share of the opening that each covers against its
 * closed form in doubles, the energy, and the picture against the mean of pinholes all over the opening. */
#include "glass_ball_fixture.h"

#define AWAY_M  0.03
#define FOV_DEG 60.0
#define PI      3.14159265358979323846

/* Pixels of a tangent of 1. */
static const double per_tangent = 0.5 * HEIGHT / 0.57735026918962576;

typedef struct opening {
    double radius_m, focus_m; /* focus_m 0: far away */
} opening;

static double two_discs(double a, double b, double t)
{
    const double small = fmin(a, b);
    if (t >= a + b)
        return 0;
    if (t <= fabs(a - b))
        return PI * small * small;
    const double at_a = acos((t * t + a * a - b * b) / (2 * t * a)), at_b = acos((t * t + b * b - a * a) / (2 * t * b));
    return a * a * (at_a - 0.5 * sin(2 * at_a)) + b * b * (at_b - 0.5 * sin(2 * at_b));
}

/* The camera looks from behind the pane through the point (0.048, 0.032) + `shift`. */
static void look(shot *s, const double shift[2])
{
    const double at[3] = {0.048 + shift[0], 0.032 + shift[1], -AWAY_M}, to[3] = {at[0], at[1], 0};
    shot_aim(s, at, to, FOV_DEG);
}

static const float *draw_front(shot *s, opening lens)
{
    VkCommandBuffer cmd;
    REQUIRE(virga_glass_set(s->glass, &s->settings) == VIRGA_OK);
    virga_view view = shot_view(s);
    view.aperture_m = (float)(2 * lens.radius_m);
    view.focus_m = (float)lens.focus_m;
    shot_begin(s, &cmd);
    shot_put(s, cmd);
    shot_record_plate(s, cmd);
    REQUIRE(virga_glass_prepare(s->glass, cmd, &view, &s->pose, virga_glass_time(s->glass)) == VIRGA_OK);
    host_target_begin_layer(&s->picture, cmd);
    REQUIRE(virga_glass_draw(s->glass, cmd, s->layer) == VIRGA_OK);
    host_target_end_layer(&s->picture, cmd);
    host_target_copy_out(&s->picture, cmd, 1u << HOST_LAYER);
    shot_submit(s);
    return host_target_floats(&s->gpu.device, &s->picture, HOST_LAYER);
}

static void open_front(shot *s)
{
    shot_open(s, NULL, WIDTH, HEIGHT, false);
    s->settings.style = VIRGA_GLASS_STYLE_FRONT;
    look(s, (const double[2]){0, 0});
    put_even_balls(s);
}

/* ---- the share */

static double expected_share(const ball *b, opening lens, int column, int row)
{
    const double w[2] = {(column + 0.5 - 0.5 * WIDTH) / per_tangent, (row + 0.5 - 0.5 * HEIGHT) / per_tangent};
    const double k = lens.focus_m > 0 ? fabs(1 - AWAY_M / lens.focus_m) : 1;
    const double radius = fmax(k * lens.radius_m, 0.5 * AWAY_M / per_tangent);
    /* seen from behind, u runs to the left; the picture's rows run down */
    const double x = 0.048 - b->middle[0], y = 0.032 - b->middle[1];
    return two_discs(b->radius, radius, hypot(AWAY_M * w[0] - x, AWAY_M * w[1] - y)) / (PI * radius * radius);
}

/* A pinhole, a phone's, one in which drop and opening are of a size, a fast lens, and one with a near focus. */
static const opening openings[] = {{0, 0}, {0.0009, 0}, {0.002, 0}, {0.006, 0}, {0.004, 0.12}};

/* To 0.001, and the sum of a disc to 0.1 % of the drop's own area on the picture. */
static void the_share_is_that_of_two_discs(void **state)
{
    (void)state;
    shot s;
    open_front(&s);
    for (size_t i = 0; i < sizeof openings / sizeof openings[0]; i++) {
        shot_forget(&s);
        const ball b = ball_of(&s, shot_drop(&s, 0.0493, 0.0311, shot_water(&s, 0.002)));
        const float *pixels = draw_front(&s, openings[i]);
        double worst = 0, sum = 0;
        for (int p = 0; p < WIDTH * HEIGHT; p++) {
            const double found = (double)pixels[4 * p + 3];
            worst = fmax(worst, fabs(found - expected_share(&b, openings[i], p % WIDTH, p / WIDTH)));
            sum += found;
        }
        const double area = PI * b.radius * b.radius * per_tangent * per_tangent / (AWAY_M * AWAY_M);
        print_message("opening %g m: share off by %.2g, sum %.6f of the area\n", openings[i].radius_m, worst,
                      sum / area);
        assert_true(worst < 1e-3);
        assert_true(fabs(sum / area - 1) < (openings[i].radius_m > 0 ? 1e-3 : 2e-3)); /* a rim of one pixel */
    }
    shot_close(&s);
}

/* ---- an opening with blades */

enum { ANGLES = 720 };

/* The share by rays from the opening's middle: the part of each that is before the drop, against all of it. */
static double share_with_blades(const virga_glass_settings *s, const ball *b, opening lens, int column, int row)
{
    const double w[2] = {(column + 0.5 - 0.5 * WIDTH) / per_tangent, (row + 0.5 - 0.5 * HEIGHT) / per_tangent};
    const double k = lens.focus_m > 0 ? fabs(1 - AWAY_M / lens.focus_m) : 1, blade = 2 * PI / s->opening_blades;
    const double radius = fmax(k * lens.radius_m, 0.5 * AWAY_M / per_tangent);
    const double e[2] = {AWAY_M * w[0] - 0.048 + b->middle[0], AWAY_M * w[1] - 0.032 + b->middle[1]};
    double common = 0, all = 0;
    for (int i = 0; i < ANGLES; i++) {
        const double angle = 2 * PI * (i + 0.5) / ANGLES, from_first = angle - (double)s->opening_deg * PI / 180;
        const double straight = cos(0.5 * blade) / cos(remainder(from_first, blade));
        const double end = radius * (straight + (double)s->opening_roundness * (1 - straight));
        const double along = e[0] * cos(angle) + e[1] * sin(angle);
        const double root = along * along - e[0] * e[0] - e[1] * e[1] + b->radius * b->radius;
        all += end * end;
        if (root > 0) {
            const double low = fmin(fmax(-along - sqrt(root), 0), end), high = fmin(fmax(-along + sqrt(root), 0), end);
            common += high * high - low * low;
        }
    }
    return common / all;
}

/* Five and three straight blades to 0.001; blades that are half round stand as four straight parts each, to 0.003. The
 * sum is the drop's own area. With an odd number of blades a disc that is upside down would be seen. */
static void with_blades_the_share_is_that_of_their_opening(void **state)
{
    (void)state;
    static const struct {
        uint32_t blades;
        float roundness, deg;
    } shapes[] = {{5, 0, 20}, {3, 0, -7}, {6, 0.5f, 0}};
    shot s;
    open_front(&s);
    for (size_t i = 0; i < 9; i++) {
        const opening lens = openings[1 + i % 3];
        s.settings.opening_blades = shapes[i / 3].blades;
        s.settings.opening_roundness = shapes[i / 3].roundness;
        s.settings.opening_deg = shapes[i / 3].deg;
        shot_forget(&s);
        const ball b = ball_of(&s, shot_drop(&s, 0.0493, 0.0311, shot_water(&s, 0.002)));
        const float *pixels = draw_front(&s, lens);
        double worst = 0, sum = 0;
        for (int p = 0; p < WIDTH * HEIGHT; p++) {
            const double found = (double)pixels[4 * p + 3];
            sum += found;
            if (found > 0 || p % 7 == 0)
                worst = fmax(worst, fabs(found - share_with_blades(&s.settings, &b, lens, p % WIDTH, p / WIDTH)));
        }
        const double area = PI * b.radius * b.radius * per_tangent * per_tangent / (AWAY_M * AWAY_M);
        print_message("%u blades, opening %g m: share off by %.2g, sum %.6f of the area\n", shapes[i / 3].blades,
                      lens.radius_m, worst, sum / area);
        assert_true(worst < (shapes[i / 3].roundness > 0 ? 3e-3 : 1e-3));
        assert_true(fabs(sum / area - 1) < 1e-3);
    }
    shot_close(&s);
}

/* ---- energy */

/* Light of 1 from everywhere: through drops, by reflection, beyond the picture. */
static void surround(shot *s)
{
    float *pixels = malloc(16ull * WIDTH * HEIGHT);
    REQUIRE(pixels);
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        pixels[i] = 1;
    shot_plate(s, pixels);
    free(pixels);
    memset(&s->settings.lighting.environment_sh, 0, sizeof s->settings.lighting.environment_sh);
    for (int c = 0; c < 3; c++)
        ((float *)&s->settings.lighting.environment_sh)[c] = 3.5449077f;
    s->settings.gain = 4; /* a reflection from inside counts a quarter */
}

static void an_even_scene_stays_even(void **state)
{
    (void)state;
    shot s;
    ball balls[BALLS];
    open_front(&s);
    surround(&s);
    s.settings.advancing_deg = 20; /* no total reflection */
    s.settings.receding_deg = 15;
    put_balls(&s, balls, 20);
    for (s.settings.opening_blades = 0; s.settings.opening_blades < 10; s.settings.opening_blades += 5) {
        const float *pixels = draw_front(&s, (opening){0.004, 0});
        double most = 0;
        for (int p = 0; p < WIDTH * HEIGHT; p++) {
            most = fmax(most, (double)pixels[4 * p + 3]);
            for (int c = 0; c < 3; c++)
                if (!(fabs((double)pixels[4 * p + c] - (double)pixels[4 * p + 3]) < 1e-3))
                    fail_msg("pixel %d: %g of %g", p, (double)pixels[4 * p + c], (double)pixels[4 * p + 3]);
        }
        assert_true(most > 0.2);
    }
    shot_close(&s);
}

/* Over all of the picture by the same share, with and without drops, and it takes as much light as it gives. */
static void a_veil_covers_its_share_evenly(void **state)
{
    (void)state;
    shot s;
    open_front(&s);
    surround(&s);
    s.settings.advancing_deg = 20;
    s.settings.receding_deg = 15;
    s.settings.veil = 0.25f;
    shot_forget(&s);
    for (int drops = 0; drops < 2; drops++) {
        const float *pixels = draw_front(&s, (opening){0.004, 0});
        for (int p = 0; p < WIDTH * HEIGHT; p++) {
            const double alpha = (double)pixels[4 * p + 3], light = (double)pixels[4 * p];
            if (!(drops ? alpha >= 0.2499 : fabs(alpha - 0.25) < 1e-4) || !(fabs(light - alpha) < 1e-3))
                fail_msg("pixel %d: %g of %g", p, light, alpha);
        }
        shot_drop(&s, 0.0493, 0.0311, shot_water(&s, 0.002));
    }
    shot_close(&s);
}

/* ---- starbursts */

/* A ray that leaves film inclined by `b` along the camera's axis: its angle to the axis before the pane, from sin b = n
 * sin i in the film and n sin(b - i) in the air. */
static double angle_before(double b)
{
    return asin(1.333 * sin(b - asin(sin(b) / 1.333)));
}

/* What a lamp on the axis gives to the pixels of such rays: what is not reflected, times the size of its picture there.
 * Along the ray that is the change of tan(angle_before) with that of the ray that leaves. Across it the parts of
 * directions stay, as both faces of the film lie along it, and a picture divides them by cos(angle_before). */
static double light_before(double b)
{
    const double i = asin(sin(b) / 1.333), w = angle_before(b), one = 1.333 * cos(i), other = 1.333 * cos(b);
    const double s = (one - cos(b)) / (one + cos(b)), p = (cos(i) - other) / (cos(i) + other);
    const double along = cos(b - i) * cos(b) / (cos(i) * cos(w)) / (cos(w) * cos(w));
    return (1 - 0.5 * (s * s + p * p)) * along / cos(w);
}

/* Share of the light of streaks that is inclined by less than b; they meet the glass at angles from 0 to `full`. */
static double within(double b, double full)
{
    return (b + sin(b) * log(tan(full / 2) / tan(b / 2))) / full;
}

/* The same by the sum over 20,000 streaks: min(sin b / sin t, 1). */
static double within_by_sum(double b, double full)
{
    double sum = 0;
    for (int i = 0; i < 20000; i++)
        sum += fmin(sin(b) / sin((i + 0.5) / 20000 * full), 1) / 20000;
    return sum;
}

static void streaks_keep_an_even_scene_even(void **state)
{
    (void)state;
    shot s;
    open_front(&s);
    surround(&s);
    s.settings.advancing_deg = 20;
    s.settings.receding_deg = 15;
    s.settings.veil = 0.25f;
    s.settings.starburst = 0.4f;
    s.settings.starburst_rays = 8;
    shot_forget(&s);
    const float *pixels = draw_front(&s, (opening){0.004, 0});
    for (int p = 0; p < WIDTH * HEIGHT; p++) {
        const double alpha = (double)pixels[4 * p + 3], light = (double)pixels[4 * p];
        if (!(fabs(alpha - (1 - 0.75 * 0.6)) < 1e-4) || !(fabs(light - alpha) < 1e-3))
            fail_msg("pixel %d: %g of %g", p, light, alpha);
    }
    shot_close(&s);
}

#define STREAKED_DEG 35.0
#define LAMP         2 /* half its width, px */
#define LAMP_LIGHT   100.0f

/* A lamp in the picture's middle, so many pixels wide, and nothing else. */
static void put_lamp(shot *s, int side, float light)
{
    const int width = (int)s->picture.width, height = (int)s->picture.height;
    float *pixels = calloc(4ull * (size_t)width * (size_t)height, sizeof *pixels);
    REQUIRE(pixels);
    for (int i = 0; i < 4 * side * side; i++) {
        const int x = (width - side) / 2 + i / 4 % side, y = (height - side) / 2 + i / 4 / side;
        pixels[4 * (y * width + x) + i % 4] = i % 4 == 3 ? 1 : light;
    }
    shot_plate(s, pixels);
    free(pixels);
    memset(&s->settings.lighting.environment_sh, 0, sizeof s->settings.lighting.environment_sh);
}

/* Share of the lamp's light that comes to between two distances (px) from its middle, from all of its pixels. */
static double on_rays(double from_px, double to_px, double full)
{
    double sum = 0;
    for (int i = 0; i < 2000; i++) {
        const double low = full * i / 2000, high = full * (i + 1) / 2000, middle = 0.5 * (low + high);
        const double at = per_tangent * tan(angle_before(middle));
        const double light = (within(high, full) - (i ? within(low, full) : 0)) * light_before(middle);
        for (int k = 0; k < 6 * 4 * LAMP * LAMP; k++) {
            const double x = k / 6 % (2 * LAMP) + 0.5 - LAMP, y = (double)(k / 6 / (2 * LAMP)) + 0.5 - LAMP;
            const double r = hypot(x + at * cos(k % 6 * PI / 3), y + at * sin(k % 6 * PI / 3));
            sum += r >= from_px && r < to_px ? light / (6 * 4 * LAMP * LAMP) : 0;
        }
    }
    return sum;
}

/* Of the light between two distances from the lamp: all of it as a share of the lamp's, and the part near the rays. */
static double sum_ring(const float *pixels, double from_px, double to_px, bool near_rays)
{
    double sum = 0;
    for (int p = 0; p < WIDTH * HEIGHT; p++) {
        const double x = p % WIDTH + 0.5 - 0.5 * WIDTH, y = (double)(p / WIDTH) + 0.5 - 0.5 * HEIGHT, r = hypot(x, y);
        const double turn = remainder(atan2(y, x), PI / 3); /* six rays, the first along u */
        if (r >= from_px && r < to_px && (!near_rays || fabs(r * sin(turn)) < 3 * LAMP))
            sum += (double)pixels[4 * p];
    }
    return sum / (4 * LAMP * LAMP * (double)LAMP_LIGHT);
}

/* All light of the streaks, to 0.1 %. By distance to 2.5 %, as the pixels at a ring's edges are in it or not; none is
 * beside the rays. */
static void a_starburst_has_the_light_of_its_streaks(void **state)
{
    (void)state;
    shot s;
    const double full = STREAKED_DEG * PI / 180, share = 0.4, ends[4] = {6, 14, 22, 36};
    for (int i = 1; i < 10; i++)
        assert_true(fabs(within(full * i / 10, full) - within_by_sum(full * i / 10, full)) < 1e-4);
    open_front(&s);
    put_lamp(&s, 2 * LAMP, LAMP_LIGHT);
    s.settings.advancing_deg = 60;
    s.settings.receding_deg = (float)STREAKED_DEG;
    s.settings.starburst = (float)share;
    s.settings.starburst_deg = 0;
    shot_forget(&s);
    const float *pixels = draw_front(&s, (opening){0.004, 0});
    for (int i = 0; i + 1 < 4; i++) {
        const double found = sum_ring(pixels, ends[i], ends[i + 1], false) / share;
        const double expected = on_rays(ends[i], ends[i + 1], full);
        print_message("from %g to %g px: %.4f, expected %.4f\n", ends[i], ends[i + 1], found, expected);
        assert_true(fabs(found / expected - 1) < 0.025);
        assert_true(sum_ring(pixels, ends[i], ends[i + 1], true) > 0.97 * found * share);
    }
    const double all = sum_ring(pixels, 0, WIDTH, false) / share, expected = on_rays(0, WIDTH, full);
    print_message("all: %.4f, expected %.4f\n", all, expected);
    assert_true(fabs(all / expected - 1) < 1e-3);
    for (int p = 0; p < WIDTH * HEIGHT; p++)
        assert_true(fabs((double)pixels[4 * p + 3] - share) < 1e-4);
    shot_close(&s);
}

static void without_drops_nothing_is_drawn(void **state)
{
    (void)state;
    shot s;
    open_front(&s);
    shot_forget(&s);
    const float *pixels = draw_front(&s, (opening){0.004, 0});
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        assert_true(pixels[i] == 0);
    shot_close(&s);
}

/* ---- against pinholes all over the opening */

enum { PINHOLES = 96 };

/* Two lamps before a dark ground that gets lighter upwards. */
static void put_night(shot *s)
{
    float *pixels = malloc(16ull * WIDTH * HEIGHT);
    REQUIRE(pixels);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const double x = i % WIDTH, y = i / WIDTH;
        const bool lamp = hypot(x - 70, y - 60) < 4 || hypot(x - 170, y - 75) < 6;
        for (int c = 0; c < 4; c++)
            pixels[4 * i + c] = c == 3 ? 1 : lamp ? 20 : (float)(0.6 * (1 - y / HEIGHT));
    }
    shot_plate(s, pixels);
    free(pixels);
}

static void add_pinholes(shot *s, opening lens, double *sum)
{
    for (int i = 0; i < PINHOLES; i++) {
        const double radius = lens.radius_m * sqrt((i + 0.5) / PINHOLES), angle = 2.39996323 * i;
        look(s, (const double[2]){radius * cos(angle), radius * sin(angle)});
        const float *pixels = draw_front(s, (opening){0, 0});
        for (int p = 0; p < 4 * WIDTH * HEIGHT; p++)
            sum[p] += (double)pixels[p] / PINHOLES;
    }
}

/* What is far away looks the same from each pinhole, so the plate is still. Means over 8 x 8 pixels are compared. Two
 * lamps that are thirty times as bright as the ground are the worst for 32 samples a drop: 6 % of the sum and 14 % of
 * the brightest block. With 64 and 256 samples it is 0.6 % and 8 %, 0.9 % and 3 %. */
static void it_is_the_mean_of_pinholes(void **state)
{
    (void)state;
    shot s;
    const opening lens = {0.003, 0};
    double *mean = calloc(4ull * WIDTH * HEIGHT, sizeof *mean), worst = 0, brightest = 0, sums[2] = {0};
    REQUIRE(mean);
    open_front(&s);
    put_night(&s);
    shot_forget(&s);
    shot_drop(&s, 0.046, 0.034, shot_water(&s, 0.0016));
    shot_drop(&s, 0.054, 0.029, shot_water(&s, 0.0010));
    add_pinholes(&s, lens, mean);
    look(&s, (const double[2]){0, 0});
    const float *pixels = draw_front(&s, lens);
    for (int block = 0; block < WIDTH / 8 * HEIGHT / 8; block++) {
        double a = 0, b = 0;
        for (int i = 0; i < 64; i++) {
            const int p = (block / (WIDTH / 8) * 8 + i / 8) * WIDTH + block % (WIDTH / 8) * 8 + i % 8;
            a += (double)pixels[4 * p] / 64;
            b += mean[4 * p] / 64;
        }
        worst = fmax(worst, fabs(a - b));
        brightest = fmax(brightest, b);
        sums[0] += a;
        sums[1] += b;
    }
    print_message("off by %.4f of %.4f, sums %.4f\n", worst, brightest, sums[0] / sums[1]);
    assert_true(worst < 0.18 * brightest);
    assert_true(fabs(sums[0] / sums[1] - 1) < 0.07);
    free(mean);
    shot_close(&s);
}

/* ---- the disc of a lamp */

enum { WIDE = 720, HIGH = 400, LAMP_PX = 3 };

/* A cap of the height h, in radii of its base, turns a ray that crosses it x radii from its middle by 2 h (n - 1) x
 * towards the middle. Where the opening sees all of the drop, a pixel in the direction d shows a lamp in the direction
 * L at x = (d - L) / (2 h (n - 1)): once, if that is on the drop. So the lamp becomes a disc of one light, with a
 * radius of 2 h (n - 1) rad. Over the inner two thirds of it the light must not vary by more than 12 % (standard
 * deviation); it was 18 % when the parts of the picture that samples show did not meet. A part is wider than it is
 * tall, so up to a fifth of the light comes to lie beside that. */
static void the_disc_of_a_lamp_has_no_stripes(void **state)
{
    (void)state;
    shot s;
    shot_open(&s, NULL, WIDE, HIGH, false);
    s.settings.style = VIRGA_GLASS_STYLE_FRONT;
    s.settings.advancing_deg = 11;
    s.settings.receding_deg = 10;
    look(&s, (const double[2]){0, 0});
    put_lamp(&s, LAMP_PX, 1000);
    shot_forget(&s);
    shot_drop(&s, 0.048, 0.032, shot_water(&s, 0.002));
    const float *pixels = draw_front(&s, (opening){0.006, 0});
    const double px_of_rad = 0.5 * HIGH / 0.57735026918962576, h = tan(glass_seen_deg(&s.settings) * PI / 360);
    const double disc = 2 * h * 0.333 * px_of_rad;
    double sum = 0, squares = 0, number = 0;
    for (int p = 0; p < WIDE * HIGH; p++) {
        if (hypot(p % WIDE + 0.5 - 0.5 * WIDE, p / WIDE + 0.5 - 0.5 * HIGH) > 2.0 / 3 * disc)
            continue;
        const double light = (double)pixels[4 * p] / (double)pixels[4 * p + 3];
        sum += light;
        squares += light * light;
        number++;
    }
    const double mean = sum / number, varies = sqrt(fmax(squares / number - mean * mean, 0)) / mean;
    const double expected = 1000.0 * LAMP_PX * LAMP_PX / (PI * disc * disc);
    print_message("disc of %.1f px: %.3f, expected %.3f, varies by %.3f\n", disc, mean, expected, varies);
    assert_true(varies < 0.12);
    assert_true(fabs(mean / expected - 1) < 0.2);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_share_is_that_of_two_discs),
        cmocka_unit_test(an_even_scene_stays_even),
        cmocka_unit_test(a_veil_covers_its_share_evenly),
        cmocka_unit_test(without_drops_nothing_is_drawn),
        cmocka_unit_test(it_is_the_mean_of_pinholes),
        cmocka_unit_test(the_disc_of_a_lamp_has_no_stripes),
        cmocka_unit_test(a_starburst_has_the_light_of_its_streaks),
        cmocka_unit_test(streaks_keep_an_even_scene_even),
        cmocka_unit_test(with_blades_the_share_is_that_of_their_opening),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
