/* test_glass_paths.c - what a wet path does to the drops that come upon it: it eases them, pulls them to its middle and
 * leads them. A drop's own trail does not. */
#include "glass_even_fixture.h"

#define PUSH  10.0  /* m/s^2, of the pane upwards: small drops run, too */
#define LINES 20000 /* of the front, in the sum that stands for its integral */

static const virga_glass_drop_gpu *drop_of(uint32_t id)
{
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (f.drops[i].id == id && glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP)
            return &f.drops[i];
    return NULL;
}

/* Rows of the pane from `low` to `high` become paths in these columns: passed so many ticks ago. */
typedef struct path {
    int column, low, high;
    uint32_t ago;
} path;

static void put_paths(const path *paths, uint32_t count)
{
    uint32_t *cells = f.upload.mapped;
    memset(cells, 0, f.glass->passed->size);
    for (uint32_t i = 0; i < count; i++)
        for (int row = paths[i].low; row <= paths[i].high; row++)
            cells[paths[i].column + row * (int)f.glass->columns] = f.tick - paths[i].ago;
    const VkCommandBuffer cmd = glass_fixture_begin(&f);
    const VkBufferCopy all = {0, 0, f.glass->passed->size};
    effect_fixture_transfers(cmd);
    vkCmdCopyBuffer(cmd, f.upload.buffer, f.glass->passed->buffer, 1, &all);
    glass_fixture_submit(&f);
}

/* ---- the forces at the front */

typedef struct front {
    double wet, aside; /* as in forces.glsl, here as sums over the front's half circle */
} front;

/* `wet` of the paths to the left of the way, on it, and to its right, each as wide as the drop. */
static front sum_front(const double wet[3], double radius_m, double cell_m)
{
    front sum = {0, 0};
    for (int i = 0; i < LINES; i++) {
        const double angle = M_PI * ((i + 0.5) / LINES - 0.5), left_m = radius_m * sin(angle);
        double here = 0;
        for (int path = 0; path < 3; path++)
            if (fabs(left_m - (1 - path) * cell_m) <= radius_m)
                here = fmax(here, wet[path]);
        sum.wet += here * cos(angle) * M_PI / LINES / 2;
        sum.aside += here * sin(angle) * M_PI / LINES / 2;
    }
    return sum;
}

/* The velocity of a drop at rest after one tick, with u to the left as seen by a drop that runs down. */
static void first_velocity(front front, double radius_m, double velocity[2])
{
    const virga_glass_settings *s = &f.settings;
    const double hold = glass_hold(s) * radius_m, ease = (double)s->path_ease;
    const double mass = water_of(radius_m) * 0.9982e-9, drag = glass_drag(s) * radius_m;
    const double left = ease * hold * front.aside, down = mass * (VIRGA_GRAVITY + PUSH), all = hypot(left, down);
    const double held = hold * (1 - ease * front.wet), share = 1 - exp(-drag * f.glass->def.tick_s / mass);
    const double speed = fmax((all - held) * share / drag, 0);
    velocity[0] = speed * left / all;
    velocity[1] = -speed * down / all;
}

/* Columns to the left, the middle and the right of a drop that comes down, seen from outside: left is +u. A path of
 * less than 0 s is dry. */
static void check_front(double radius_m, double left_s, double middle_s, double right_s)
{
    const double ago_s[3] = {left_s, middle_s, right_s};
    const int column = 40, row = 40;
    double wet[3] = {0, 0, 0}, expected[2];
    path paths[3];
    uint32_t count = 0;
    open_even(NULL);
    f.info.acceleration_m_s2[1] = (float)PUSH;
    for (int i = 0; i < 8; i++) /* so that there is a time when old paths were wet */
        glass_fixture_step(&f, 60, false);
    const uint32_t id = glass_fixture_land(&f, (column + 0.5) * 2e-3, (row + 0.5) * 2e-3, water_of(radius_m))->id;
    glass_fixture_step(&f, 1, true);
    for (int i = 0; i < 3; i++)
        if (ago_s[i] >= 0) {
            const uint32_t ago = (uint32_t)(ago_s[i] * 60);
            paths[count++] = (path){.column = column + 1 - i, .low = 10, .high = row, .ago = ago};
            wet[i] = exp(-(double)ago / 60 / (double)f.settings.path_dry_s);
        }
    put_paths(paths, count);
    glass_fixture_step(&f, 1, true);
    const virga_glass_drop_gpu *drop = drop_of(id);
    REQUIRE(drop);
    first_velocity(sum_front(wet, radius_m, 2e-3), radius_m, expected);
    print_message("radius %.1f mm: velocity %.6f %.6f, expected %.6f %.6f\n", radius_m * 1e3, (double)drop->velocity[0],
                  (double)drop->velocity[1], expected[0], expected[1]);
    for (int axis = 0; axis < 2; axis++)
        assert_true(fabs((double)drop->velocity[axis] - expected[axis]) < 1e-3 * hypot(expected[0], expected[1]));
    glass_fixture_close(&f);
}

/* The sum over the front's half circle in double precision, to 0.1 %. Radii of more and of less than a cell. */
static void the_front_pulls_as_much_as_the_wet_part_of_it(void **unused)
{
    (void)unused;
    check_front(2.4e-3, -1, -1, -1);
    check_front(2.4e-3, -1, 0, -1);
    check_front(2.4e-3, 0, -1, -1);
    check_front(2.4e-3, -1, -1, 0);
    check_front(2.4e-3, 3, 0, 6);
    check_front(2.4e-3, 0, -1, 4);
    check_front(1.8e-3, -1, 2, 0);
    check_front(1.8e-3, 0, -1, -1);
}

/* How many cells a drop comes down in two seconds, from row 55. */
static uint32_t rows_down(double radius_m, const path *paths, uint32_t count)
{
    open_even(NULL);
    f.settings.path_dry_s = 600;
    glass_fixture_step(&f, 1, true);
    put_paths(paths, count);
    const uint32_t id = glass_fixture_land(&f, 0.081, 0.111, water_of(radius_m))->id;
    glass_fixture_step(&f, 60, true);
    glass_fixture_step(&f, 60, true);
    const virga_glass_drop_gpu *drop = drop_of(id);
    REQUIRE(drop);
    const uint32_t rows = 55 - drop->cell / f.glass->columns;
    glass_fixture_close(&f);
    return rows;
}

/* A drop of 1.6 mm is held by dry glass, also when it runs: below sqrt(0.6) 2.2 mm = 1.7 mm. A path of 30 rows leads it
 * so far, and at its speed not more than a cell farther. */
static void a_drop_runs_down_a_path_and_stops_where_it_ends(void **unused)
{
    (void)unused;
    const path rows = {.column = 40, .low = 25, .high = 59, .ago = 0};
    const uint32_t dry = rows_down(1.6e-3, NULL, 0), wet = rows_down(1.6e-3, &rows, 1);
    print_message("%u rows on dry glass, %u on the path\n", dry, wet);
    assert_int_equal(dry, 0);
    assert_true(wet == 30 || wet == 31);
}

/* Past a path that begins beside it and goes down, a drop comes to lie in the path's middle. */
static void a_path_beside_its_way_draws_a_drop_in(void **unused)
{
    (void)unused;
    uint32_t on_path = 0;
    for (uint32_t seed = 0; seed < 8; seed++) {
        virga_glass_def def = glass_fixture_def();
        def.seed = seed;
        open_even(&def);
        f.settings.path_dry_s = 600;
        f.settings.meander = 0;
        glass_fixture_step(&f, 1, true);
        put_paths(&(path){.column = 41, .low = 0, .high = 50, .ago = 0}, 1);
        const uint32_t id = glass_fixture_land(&f, 0.081, 0.111, water_of(2.4e-3))->id;
        const virga_glass_drop_gpu *drop = NULL;
        for (int i = 0; i < 60 && (!drop || drop->position[1] > 0.03f); i++) {
            glass_fixture_step(&f, 4, true);
            drop = drop_of(id);
            REQUIRE(drop);
        }
        on_path += drop->cell % f.glass->columns == 41;
        glass_fixture_close(&f);
    }
    print_message("%u of 8 on the path\n", on_path);
    assert_true(on_path >= 7);
}

/* ---- the film on a path */

/* Film (nl) on the cell that a drop has just left, and the speed at which it ran: straight down, over dry glass. */
static bool look_at_film(uint32_t id, uint32_t *column, uint32_t *row, double *nl, double *speed_m_s)
{
    const uint32_t columns = f.glass->columns;
    const virga_glass_drop_gpu *drop = drop_of(id);
    if (!drop || drop->cell / columns >= *row)
        return false;
    *column = drop->cell % columns;
    *row = drop->cell / columns;
    *nl = f.film[*column + (*row + 1) * columns];
    *speed_m_s = -(double)drop->velocity[1];
    return true;
}

/* Landau, Levich and Derjaguin: three eighths of 0.94 l Ca^(2/3), or film_um (v / 0.1 m/s)^(2/3) to 2 %. One cell in
 * each look, left at the speed of that tick, to 5 % for the rounding of single cells to nanolitres; their sum to 1 %.
 */
static void a_running_drop_leaves_film_by_its_speed(void **unused)
{
    (void)unused;
    virga_glass_def def = glass_fixture_def();
    def.height_m = 0.4f;
    open_even(&def);
    virga_glass_apply_kind(VIRGA_GLASS_KIND_DIRTY, &f.settings);
    f.settings.affinity = f.settings.meander = f.settings.tail_max_radius_mm = 0;
    f.settings.drag = 2; /* a cell takes more than a tick */
    const double length = sqrt(VIRGA_SURFACE_TENSION / (VIRGA_WATER_DENSITY * VIRGA_GRAVITY));
    const double ca = 1.002e-3 * 0.1 / VIRGA_SURFACE_TENSION;
    assert_float_equal((double)f.settings.film_um * 1e-6 / (0.375 * 0.94 * length * pow(ca, 2.0 / 3)), 1, 0.02);
    const uint32_t id = glass_fixture_land(&f, 0.081, 0.391, water_of(3.4e-3))->id;
    uint32_t column = 0, row = f.glass->rows, looks = 0;
    double nl, speed_m_s, sum = 0, expected_sum = 0;
    glass_fixture_step(&f, 4, true);
    look_at_film(id, &column, &row, &nl, &speed_m_s);
    for (int i = 0; i < 120; i++) {
        glass_fixture_step(&f, 1, true);
        if (!look_at_film(id, &column, &row, &nl, &speed_m_s))
            continue;
        /* The film of a move is left in the tick's last round, at its speed. */
        const double expected =
            (double)f.settings.film_um * 1e-6 * pow(speed_m_s / 0.1, 2.0 / 3) * 2e-3 * 2e-3 * NL_OF_M3;
        assert_float_equal(nl / expected, 1, 0.05);
        sum += nl;
        expected_sum += expected;
        looks++;
    }
    print_message("%u cells, the last at %.3f m/s: %.1f nl, expected %.1f\n", looks, speed_m_s, sum, expected_sum);
    assert_true(looks > 20);
    assert_float_equal(sum / expected_sum, 1, 0.01);
    glass_fixture_close(&f);
}

/* On the paper's glass the contact line keeps up with drops slower than 9 cm/s. */
static void a_slow_drop_leaves_dry_glass(void **unused)
{
    (void)unused;
    for (int fast = 0; fast < 2; fast++) {
        open_even(NULL);
        f.settings.film_um = 12;
        f.settings.drag = fast ? 1 : 4;
        glass_fixture_land(&f, 0.081, 0.111, water_of(2.5e-3));
        glass_fixture_step(&f, 20, true);
        uint64_t film_nl = 0;
        for (uint32_t i = 0; i < f.glass->columns * f.glass->rows; i++)
            film_nl += f.film[i];
        assert_int_equal(film_nl > 0, fast);
        glass_fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_front_pulls_as_much_as_the_wet_part_of_it),
        cmocka_unit_test(a_drop_runs_down_a_path_and_stops_where_it_ends),
        cmocka_unit_test(a_path_beside_its_way_draws_a_drop_in),
        cmocka_unit_test(a_running_drop_leaves_film_by_its_speed),
        cmocka_unit_test(a_slow_drop_leaves_dry_glass),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
