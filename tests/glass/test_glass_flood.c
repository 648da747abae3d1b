/* Simulated water that strikes a pane: the cells that it touches and its speed there, in double precision; the film
 * that it leaves where it recedes; what joins it; and all of it to the nanolitre. */
#include "glass_fixture.h"

#include <virga/shared/particle.h>

#include <math.h>

#define MOST      512    /* particles */
#define SPACING_M 0.013f /* no multiple of a cell */
#define RECEDE    4      /* ticks after which what nothing touches is no more under water */

static glass_fixture f;
static host_buffer water;
static virga_particle_gpu *particles;

static void open_with(virga_glass_def def)
{
    def.water = true;
    glass_fixture_open(&f, &def);
    f.settings.evaporation_mm_h = 0;
    REQUIRE(host_buffer_create(&f.gpu.device, MOST * sizeof *particles, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                               HOST_BUFFER_UPLOAD, "water", &water, f.gpu.error, sizeof f.gpu.error));
    particles = water.mapped;
    f.info.water_spacing_m = SPACING_M;
}

static void open_water(void)
{
    open_with(glass_fixture_def());
}

static void close_water(void)
{
    host_buffer_destroy(&f.gpu.device, &water);
    glass_fixture_close(&f);
}

static void step(uint32_t count, uint32_t ticks)
{
    f.info.water = count ? water.buffer : VK_NULL_HANDLE;
    f.info.water_count = count;
    glass_fixture_step(&f, ticks, true);
}

static uint32_t word_of(uint32_t cell)
{
    return f.occupants[f.glass->columns * f.glass->rows + cell];
}

static uint32_t phase_of(uint32_t cell)
{
    return word_of(cell) >> VIRGA_GLASS_PHASE;
}

static double random_in(uint32_t *hash, double low, double high)
{
    *hash = virga_hash1(*hash);
    return low + (high - low) * (double)virga_unit(*hash);
}

/* ---- geometry in double precision */

typedef struct pose {
    double position[3], axes[3][3], velocity[3], spin[3];
    double rake, bend; /* of a windshield; a bend of 0: flat, from its lower left corner */
} pose;

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Any rotation, from three angles; and a motion. */
static pose random_pose(uint32_t *hash)
{
    pose p = {.bend = 0};
    double angle[3];
    for (int i = 0; i < 3; i++) {
        p.position[i] = 5000 + random_in(hash, -3, 3);
        p.velocity[i] = random_in(hash, -2, 2);
        p.spin[i] = random_in(hash, -2, 2);
        angle[i] = random_in(hash, -3, 3);
    }
    const double x[3] = {cos(angle[0]) * cos(angle[1]), sin(angle[1]), sin(angle[0]) * cos(angle[1])};
    const double side[3] = {cos(angle[2]), sin(angle[2]), 0.3};
    double z[3], y[3];
    cross(x, side, z);
    const double length = sqrt(dot(z, z));
    for (int i = 0; i < 3; i++)
        z[i] /= length;
    cross(z, x, y);
    for (int i = 0; i < 3; i++) {
        p.axes[0][i] = x[i];
        p.axes[1][i] = y[i];
        p.axes[2][i] = z[i];
    }
    for (int i = 0; i < 9; i++)
        f.info.world_from_pane[i] = (float)p.axes[i / 3][i % 3];
    for (int i = 0; i < 3; i++) {
        f.info.position_m[i] = p.position[i];
        f.info.water_origin_m[i] = p.position[i] + 0.5 - i;
        f.info.velocity_m_s[i] = (float)p.velocity[i];
        f.info.angular_velocity_rad_s[i] = (float)p.spin[i];
    }
    return p;
}

/* Where a point of the pane's frame is over the surface: u, v and outward; and the normal there. */
static void below(const pose *p, const double at[3], double uv[2], double *outward, double normal[3])
{
    const double s = sin(p->rake), c = cos(p->rake), r = p->bend;
    if (!(r > 0)) {
        memcpy(uv, at, 2 * sizeof *uv);
        *outward = at[2];
        memcpy(normal, (const double[3]){0, 0, 1}, 3 * sizeof *normal);
        return;
    }
    const double back = -(at[1] * s + at[2] * c), angle = atan2(at[0], r - back);
    uv[0] = r * angle + 0.5 * (double)f.glass->def.width_m;
    uv[1] = at[1] * c - at[2] * s;
    *outward = hypot(at[0], r - back) - r;
    memcpy(normal, (const double[3]){sin(angle), cos(angle) * s, cos(angle) * c}, 3 * sizeof *normal);
}

/* Puts a particle at (u, v, outward) of the surface, in the world. */
static void put(const pose *p, uint32_t i, double u, double v, double outward, const double velocity[3])
{
    const double s = sin(p->rake), c = cos(p->rake), r = p->bend;
    double at[3] = {u, v, outward};
    if (r > 0) {
        const double angle = (u - 0.5 * (double)f.glass->def.width_m) / r, back = r - (r + outward) * cos(angle);
        at[0] = (r + outward) * sin(angle);
        at[1] = v * c - back * s;
        at[2] = -v * s - back * c;
    }
    particles[i] = (virga_particle_gpu){.share = 1, .id = i};
    for (int axis = 0; axis < 3; axis++) {
        double world = p->position[axis] - f.info.water_origin_m[axis];
        for (int k = 0; k < 3; k++)
            world += at[k] * p->axes[k][axis];
        particles[i].position[axis] = (float)world;
        particles[i].velocity[axis] = (float)velocity[axis];
    }
}

/* The speed along the pane (m/s) of a particle that touches a cell; below 0: it does not. `sure`: rounding does not
 * matter, nor that a bent surface is straight between its nodes: it is off by 0.04 mm, and its normal by 0.03 rad. */
static double touching_speed(const pose *p, const virga_particle_gpu *particle, uint32_t cell, bool *sure)
{
    const double side = (double)f.glass->def.cell_m, d = (double)SPACING_M;
    const double eps = p->bend > 0 ? 1e-4 : 2e-6, eps_along = p->bend > 0 ? 5e-4 : 2e-6;
    double world[3], at[3], uv[2], outward, normal[3], out[3], moves[3];
    for (int axis = 0; axis < 3; axis++)
        world[axis] = (double)particle->position[axis] + f.info.water_origin_m[axis] - p->position[axis];
    for (int k = 0; k < 3; k++)
        at[k] = dot(world, p->axes[k]);
    below(p, at, uv, &outward, normal);
    const double off[2] = {((cell % f.glass->columns) + 0.5) * side - uv[0],
                           ((cell / f.glass->columns) + 0.5) * side - uv[1]};
    const double away = hypot(off[0], off[1]), own = fmax(fabs(off[0]), fabs(off[1]));
    *sure = away > d || own > d ||
            (fabs(outward - d) > eps && fabs(outward + d / 4) > eps && fabs(away - 0.75 * d) > eps_along &&
             fabs(own - side / 2) > eps_along);
    if (outward >= d || outward <= -d / 4 || (away > 0.75 * d && own > side / 2))
        return -1;
    cross(p->spin, world, out);
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (double)particle->velocity[axis] - p->velocity[axis] - out[axis];
    for (int k = 0; k < 3; k++)
        moves[k] = dot(out, p->axes[k]);
    const double along = dot(moves, normal);
    for (int k = 0; k < 3; k++)
        moves[k] -= along * normal[k];
    return fmin(sqrt(dot(moves, moves)), 4.095);
}

static void check_cells(const pose *p, uint32_t count)
{
    uint32_t touched = 0, open = 0;
    for (uint32_t cell = 0; cell < f.glass->columns * f.glass->rows; cell++) {
        double fastest = -1;
        bool all_sure = true;
        for (uint32_t i = 0; i < count; i++) {
            bool sure;
            fastest = fmax(fastest, touching_speed(p, &particles[i], cell, &sure));
            all_sure = all_sure && sure;
        }
        open += !all_sure;
        if (!all_sure)
            continue;
        touched += fastest >= 0;
        assert_int_equal(phase_of(cell), fastest >= 0 ? VIRGA_GLASS_UNDER : VIRGA_GLASS_DRY);
        if (fastest >= 0) /* mm/s; the normal of a bent pane is that of a facet */
            assert_float_equal((word_of(cell) & 0xfff), fastest * 1000, p->bend > 0 ? 90 : 2);
    }
    printf("%u cells touched, %u too close to tell\n", touched, open);
    assert_true(touched > 200 && open < 600);
}

static void scatter(const pose *p, uint32_t *hash, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const double velocity[3] = {random_in(hash, -1, 1), random_in(hash, -1, 1), random_in(hash, -1, 1)};
        put(p, i, random_in(hash, -0.03, 0.19), random_in(hash, -0.03, 0.15), random_in(hash, -0.02, 0.03), velocity);
    }
    particles[0].share = 0;
    particles[1].position[1] = NAN;
}

static void particles_touch_the_cells_below_them(void **unused)
{
    (void)unused;
    uint32_t hash = 3;
    for (int i = 0; i < 4; i++) {
        open_water();
        const pose p = random_pose(&hash);
        scatter(&p, &hash, 40);
        step(40, 1);
        particles[0].share = 1; /* the others again in place of those that do not count */
        particles[0] = particles[1] = particles[2];
        check_cells(&p, 40);
        close_water();
    }
}

static void on_a_bent_pane_too(void **unused)
{
    (void)unused;
    static float positions[33 * 33 * 3];
    uint32_t hash = 8;
    for (int i = 0; i < 2; i++) {
        open_water();
        virga_glass_shape shape = virga_default_glass_shape();
        pose p = random_pose(&hash);
        p.bend = i ? 0.08 : 0.3; /* 115 degrees of a circle, and 31 */
        p.rake = 30 * 3.14159265358979 / 180;
        virga_glass_fill_windshield(0.16f, 0.12f, 30, (float)p.bend, 33, 33, positions);
        shape.positions = positions;
        shape.columns = shape.rows = 33;
        REQUIRE(virga_glass_shape_set(f.glass, &shape) == VIRGA_OK);
        scatter(&p, &hash, 40);
        particles[0] = particles[1] = particles[2];
        step(40, 1);
        check_cells(&p, 40);
        close_water();
    }
}

/* ---- the film */

/* A row of particles that stand on the pane, each with its own speed; then they are gone. */
static void leave_film(uint32_t count, double fastest)
{
    const pose p = {.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (uint32_t i = 0; i < count; i++)
        put(&p, i, 0.02 + 0.03 * i, 0.06, 0.006, (const double[3]){0, -fastest * (i + 1) / count, 7});
    step(count, 1);
    assert_int_equal(glass_fixture_count(&f, VIRGA_GLASS_TOUCHED), 0);
    step(0, RECEDE - 1);
    assert_int_equal(glass_fixture_count(&f, VIRGA_GLASS_TOUCHED), 0);
    step(0, 1);
}

static void check_film(double speed, double u, double from_m_s)
{
    const double mu = 1.002e-3, sigma = VIRGA_SURFACE_TENSION, g = VIRGA_GRAVITY, side = (double)f.glass->def.cell_m;
    const double length = sqrt(sigma / (VIRGA_WATER_DENSITY * g));
    const double expected =
        speed < from_m_s ? 0 : 0.94 * length * pow(mu * speed / sigma, 2.0 / 3) * side * side * 1e12;
    const uint32_t cell = (uint32_t)(u / side) + (uint32_t)(0.06 / side) * f.glass->columns;
    assert_float_equal(f.film[cell], expected, 1 + expected * 1e-3);
    assert_int_equal(phase_of(cell), expected > 0 ? VIRGA_GLASS_BREAKS : VIRGA_GLASS_DRY);
}

static void film_is_as_thick_as_landau_and_levich_say(void **unused)
{
    (void)unused;
    static const struct {
        virga_glass_kind kind;
        double fastest;
    } cases[] = {{VIRGA_GLASS_KIND_CLEAN, 0.1}, {VIRGA_GLASS_KIND_PAPER, 0.2}, {VIRGA_GLASS_KIND_COATED, 4}};
    for (int i = 0; i < 3; i++) {
        open_water();
        virga_glass_apply_kind(cases[i].kind, &f.settings);
        f.settings.film_break_s = 60;
        leave_film(5, cases[i].fastest);
        const double t = (double)f.settings.receding_deg * 3.14159265358979 / 180;
        const double from = t * t * t / (9 * sqrt(3) * 15) * VIRGA_SURFACE_TENSION / 1.002e-3;
        uint64_t sum = 0;
        for (uint32_t k = 0; k < 5; k++)
            check_film(cases[i].fastest * (k + 1) / 5, 0.02 + 0.03 * k, from);
        for (uint32_t cell = 0; cell < f.glass->columns * f.glass->rows; cell++)
            sum += f.film[cell];
        printf("from %.3f m/s on; %llu nl left\n", from, (unsigned long long)sum);
        assert_int_equal(sum, glass_fixture_count(&f, VIRGA_GLASS_TOUCHED));
        assert_true(sum > 0);
        close_water();
    }
}

/* After film_break_s it is in drops of many sizes, but for a twentieth. The pane lies level, so that they stay. */
static void film_breaks_into_drops(void **unused)
{
    (void)unused;
    uint32_t smallest = UINT32_MAX, largest = 0;
    uint64_t in_drops = 0, in_film = 0;
    open_water();
    f.settings.film_break_s = 0.3f;
    f.settings.merge_distance = 0;
    const pose p = {.axes = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
    for (int i = 0; i < 9; i++)
        f.info.world_from_pane[i] = (float)p.axes[i / 3][i % 3];
    for (uint32_t i = 0; i < 130; i++)
        put(&p, i, 0.006 + 0.0123 * (i % 13), 0.006 + 0.0123 * (i / 13), 0.006, (const double[3]){0, 0, 1});
    step(130, 1);
    step(0, RECEDE);
    const uint64_t left = glass_fixture_count(&f, VIRGA_GLASS_TOUCHED);
    assert_true(left > 60 * 80 * 580);
    for (int i = 0; i < 3; i++)
        step(0, 20);
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP) {
            const uint32_t here = f.drops[i].water_nl;
            smallest = here < smallest ? here : smallest;
            largest = here > largest ? here : largest;
            in_drops += here;
        }
    for (uint32_t cell = 0; cell < f.glass->columns * f.glass->rows; cell++)
        in_film += f.film[cell];
    printf("%.1f ml in drops of %.1f to %.1f ul, %.1f ml in film\n", (double)in_drops * 1e-6, smallest * 1e-3,
           largest * 1e-3, (double)in_film * 1e-6);
    assert_int_equal(in_drops + in_film, left);
    assert_float_equal((double)in_film / (double)left, 0.05, 0.01);
    assert_true(largest > 6 * smallest && largest > 20000);
    close_water();
}

/* ---- what must hold */

static void assert_budget(void)
{
    virga_glass_stats s;
    virga_glass_stats_get(f.glass, &s);
    assert_int_equal(s.landed_nl + s.touched_nl, s.drops_nl + s.particles_nl + s.film_nl + s.run_off_nl + s.wiped_nl +
                                                     s.evaporated_nl + s.joined_nl);
    assert_int_equal(s.drops_nl + s.particles_nl + s.film_nl, glass_fixture_water(&f));
}

/* No drop that rests is under water, and no film. */
static void assert_clear(void)
{
    for (uint32_t cell = 0; cell < f.glass->columns * f.glass->rows; cell++) {
        if (phase_of(cell) < VIRGA_GLASS_UNDER)
            continue;
        assert_int_equal(f.film[cell], 0);
        const uint32_t slot = f.occupants[cell];
        REQUIRE(!slot || f.drops[slot - 1].age_s < 0.05f || (f.drops[slot - 1].kind & VIRGA_GLASS_RUNNING) ||
                (f.drops[slot - 1].kind & VIRGA_GLASS_CHANGED));
    }
}

static void wiper(void)
{
    f.settings.wiper_count = 1;
    f.settings.wipers[0].pivot_m[0] = 0.08f;
    f.settings.wipers[0].pivot_m[1] = -0.01f;
    f.settings.wipers[0].reach_m = 0.1f;
    f.settings.wipers[0].blade_m = 0.07f;
    f.settings.wipers[0].high_deg = 170;
}

/* Rain and a wiper, and water whose level sloshes up and down before the pane. */
static void slosh(uint32_t step_number, uint32_t ticks)
{
    const pose p = {.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    uint32_t hash = 100 + step_number, count = 0;
    const double time_s = step_number * 0.05, level = 0.06 + 0.07 * sin(3 * time_s);
    const double speed = 0.21 * cos(3 * time_s);
    for (uint32_t i = 0; i < 150; i++) {
        const double v = random_in(&hash, -0.01, 0.13);
        if (v < level)
            put(&p, count++, random_in(&hash, 0.02, 0.17), v, random_in(&hash, -0.01, 0.02),
                (const double[3]){random_in(&hash, -0.3, 0.3), speed, 0});
    }
    f.info.rate_mm_h = 150;
    f.info.velocity_m_s[2] = step_number % 40 < 20 ? 10 : 0;
    for (uint32_t i = 0; i < 4; i++)
        glass_fixture_land(&f, 0.16 * (double)virga_unit(virga_hash2(hash, i)),
                           0.12 * (double)virga_unit(virga_hash2(hash, 9 + i)), virga_hash2(hash, 20 + i) % 40000);
    step(count, ticks);
}

static void all_water_is_counted(void **unused)
{
    (void)unused;
    virga_glass_stats s;
    open_water();
    wiper();
    f.settings.evaporation_mm_h = 20;
    f.settings.film_break_s = 0.2f;
    for (uint32_t i = 0; i < 120; i++) {
        slosh(i, 3);
        assert_budget();
        assert_clear();
    }
    virga_glass_stats_get(f.glass, &s);
    printf("landed %.2f ml, touched %.2f, joined %.2f, run off %.2f, wiped %.2f\n", (double)s.landed_nl * 1e-6,
           (double)s.touched_nl * 1e-6, (double)s.joined_nl * 1e-6, (double)s.run_off_nl * 1e-6,
           (double)s.wiped_nl * 1e-6);
    assert_true(s.touched_nl > 1000000 && s.joined_nl > 1000000);
    close_water();
}

static uint64_t hash_of(const void *data, size_t bytes, uint64_t hash)
{
    const uint32_t *words = data;
    for (size_t i = 0; i < bytes / 4; i++)
        hash = (hash ^ words[i]) * 1099511628211u;
    return hash;
}

static uint64_t pane_hash(void)
{
    const size_t cells = (size_t)f.glass->columns * f.glass->rows;
    uint64_t hash = hash_of(f.drops, f.glass->def.max_drops * sizeof *f.drops, 1469598103934665603u);
    hash = hash_of(f.occupants, cells * 4, hash);
    hash = hash_of(f.film, cells * 4, hash);
    hash = hash_of(f.passed, cells * 4, hash);
    return hash_of(f.state->counts, sizeof f.state->counts, hash);
}

static uint64_t slosh_hash(const char *threads, virga_pass_variants variants)
{
    effect_device_set_threads(threads);
    effect_fixture_variants = variants;
    open_water();
    wiper();
    for (uint32_t i = 0; i < 30; i++)
        slosh(i, 4);
    uint64_t hash = pane_hash();
    for (uint32_t i = 0; i < f.glass->columns * f.glass->rows; i++)
        hash = hash * 31 + word_of(i);
    close_water();
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
    return hash;
}

static void same_bits_every_time(void **unused)
{
    (void)unused;
    const uint64_t first = slosh_hash("2", VIRGA_VARIANTS_SOFTWARE);
    assert_int_equal(first, slosh_hash("1", VIRGA_VARIANTS_SOFTWARE));
    assert_int_equal(first, slosh_hash("0", VIRGA_VARIANTS_GPU));
    effect_device_set_threads("0");
}

/* Saves the pane into a buffer, or loads it from there, in a frame of its own. */
static void keep_state(host_buffer *blob, bool load)
{
    virga_state_info info;
    const VkCommandBuffer cmd = glass_fixture_begin(&f);
    const virga_state_range range = {blob->buffer, 0, blob->size};
    const virga_state_source source = {blob->mapped, blob->size, blob->buffer, 0};
    REQUIRE((load ? virga_glass_load(f.glass, cmd, &source) : virga_glass_save(f.glass, cmd, &range)) == VIRGA_OK);
    glass_fixture_submit(&f);
    host_buffer_invalidate(&f.gpu.device, blob);
    REQUIRE(load || virga_state_seal(blob->mapped, blob->size, f.gpu.device.frame, &info) == VIRGA_OK);
}

static uint64_t slosh_on(uint32_t from, uint32_t to)
{
    for (uint32_t i = from; i < to; i++)
        slosh(i, 4);
    return pane_hash();
}

/* Loaded where water stands on half of the pane, and film waits on the other. */
static void it_goes_on_from_a_saved_state(void **unused)
{
    (void)unused;
    host_buffer blob;
    open_water();
    wiper();
    slosh_on(0, 24);
    REQUIRE(host_buffer_create(&f.gpu.device, virga_glass_state_bytes(f.glass),
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                               HOST_BUFFER_READBACK, "state", &blob, f.gpu.error, sizeof f.gpu.error));
    uint32_t phases[4] = {0};
    for (uint32_t i = 0; i < f.glass->columns * f.glass->rows; i++)
        phases[phase_of(i)]++;
    printf("%u cells dry, %u with film, %u under water\n", phases[0], phases[1], phases[2]);
    assert_true(phases[1] > 100 && phases[2] > 500);
    keep_state(&blob, false);
    const uint32_t tick = f.tick;
    const uint64_t hash = slosh_on(24, 40);
    virga_glass_destroy(&f.glass);
    virga_glass_def again = glass_fixture_def();
    again.water = true;
    REQUIRE(virga_glass_create(f.context, &again, &f.glass) == VIRGA_OK);
    REQUIRE(virga_glass_set(f.glass, &f.settings) == VIRGA_OK);
    keep_state(&blob, true);
    f.tick = tick;
    assert_int_equal(hash, slosh_on(24, 40));
    host_buffer_destroy(&f.gpu.device, &blob);
    close_water();
}

/* A pane that takes no water, and one that water never touches: it is inside, or far away. */
static uint64_t dry_hash(bool takes)
{
    virga_glass_def def = glass_fixture_def();
    const pose p = {.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    if (takes)
        open_with(def);
    else
        glass_fixture_open(&f, &def);
    f.settings.evaporation_mm_h = 0;
    wiper();
    f.info.rate_mm_h = 100;
    f.info.velocity_m_s[2] = 10;
    for (uint32_t i = 0; takes && i < 50; i++)
        put(&p, i, 0.003 * i, 0.06, i % 2 ? -0.01 : 0.0131, (const double[3]){0, -1, 0});
    for (uint32_t i = 0; i < 20; i++) {
        f.info.water = takes ? water.buffer : VK_NULL_HANDLE;
        f.info.water_count = takes ? 50 : 0;
        glass_fixture_step(&f, 6, true);
    }
    const uint64_t hash = pane_hash();
    if (takes)
        close_water();
    else
        glass_fixture_close(&f);
    return hash;
}

static void water_that_does_not_touch_changes_no_bit(void **unused)
{
    (void)unused;
    assert_int_equal(dry_hash(false), dry_hash(true));
}

/* A drop that is there joins the water, and so does one that lands. */
static void drops_join_the_water(void **unused)
{
    (void)unused;
    const pose p = {.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    open_water();
    glass_fixture_land(&f, 0.05, 0.05, 3000);
    glass_fixture_land(&f, 0.12, 0.05, 500);
    step(0, 1);
    assert_int_equal(f.state->drops, 2);
    put(&p, 0, 0.052, 0.052, 0.005, (const double[3]){0, 0, 0});
    glass_fixture_land(&f, 0.055, 0.05, 700);
    step(1, 1);
    assert_int_equal(f.state->drops, 1);
    assert_int_equal(glass_fixture_count(&f, VIRGA_GLASS_JOINED), 3700);
    assert_budget();
    close_water();
}

static void wrong_water_is_refused(void **unused)
{
    (void)unused;
    open_water();
    const VkCommandBuffer cmd = glass_fixture_begin(&f);
    virga_glass_step_info info = {.first_tick = 1, .ticks = 1, .water = water.buffer, .water_count = 4};
    info.water_spacing_m = NAN;
    assert_int_equal(virga_glass_step(f.glass, cmd, &info), VIRGA_ERROR_INVALID);
    info.water_spacing_m = 0.01f;
    info.water_offset = 1;
    assert_int_equal(virga_glass_step(f.glass, cmd, &info), VIRGA_ERROR_INVALID);
    info.water_offset = 0;
    info.position_m[2] = NAN;
    assert_int_equal(virga_glass_step(f.glass, cmd, &info), VIRGA_ERROR_INVALID);
    info.position_m[2] = 0;
    f.glass->def.water = false;
    assert_int_equal(virga_glass_step(f.glass, cmd, &info), VIRGA_ERROR_INVALID);
    f.glass->def.water = true;
    glass_fixture_submit(&f);
    close_water();
}

int main(void)
{
    effect_device_set_threads("0");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(particles_touch_the_cells_below_them),
        cmocka_unit_test(on_a_bent_pane_too),
        cmocka_unit_test(film_is_as_thick_as_landau_and_levich_say),
        cmocka_unit_test(film_breaks_into_drops),
        cmocka_unit_test(drops_join_the_water),
        cmocka_unit_test(all_water_is_counted),
        cmocka_unit_test(same_bits_every_time),
        cmocka_unit_test(it_goes_on_from_a_saved_state),
        cmocka_unit_test(water_that_does_not_touch_changes_no_bit),
        cmocka_unit_test(wrong_water_is_refused),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
