/* Foam: how much is made, against double precision; how it moves and dissolves, against closed forms. */
#include "water_fixture.h"

#include "../../shaders/shared/foam.h"

#define D       0.02
#define GRAVITY 9.81
#define STEP_S  (1.0 / 64) /* whole microseconds */

static water_fixture f;
static host_buffer down;
static const virga_foam_gpu *foam;
static const float *normals;          /* of sorted particles: x, y, z, approach */
static const uint32_t *emissions;     /* of sorted particles: number, potential, start, 0 */
static virga_water_state_gpu *counts; /* of the newest step */

static void set_up(uint32_t max_foam)
{
    virga_water_def def = water_fixture_def();
    def.max_foam = max_foam;
    water_fixture_open_with(&f, &def, false);
    f.settings.spacing_m = D;
    REQUIRE(host_buffer_create(&f.gpu.device,
                               f.water->foam.particles->size + f.water->foam.normals->size +
                                   f.water->foam.emissions->size + f.water->state->size,
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "foam down", &down, f.gpu.error,
                               sizeof f.gpu.error));
}

static void tear_down(void)
{
    host_buffer_destroy(&f.gpu.device, &down);
    water_fixture_close(&f);
}

/* A step, and a frame that reads foam back. */
static void step(double dt)
{
    VkDeviceSize offset = 0;
    f.time_s += dt;
    water_fixture_step(&f);
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    effect_fixture_transfers(cmd);
    foam = effect_fixture_copy(cmd, f.water->foam.particles->buffer, f.water->foam.particles->size, &down, &offset);
    normals = effect_fixture_copy(cmd, f.water->foam.normals->buffer, f.water->foam.normals->size, &down, &offset);
    emissions =
        effect_fixture_copy(cmd, f.water->foam.emissions->buffer, f.water->foam.emissions->size, &down, &offset);
    counts = (void *)effect_fixture_copy(cmd, f.water->state->buffer, f.water->state->size, &down, &offset);
    effect_fixture_complete(&f.gpu, f.context);
    host_buffer_invalidate(&f.gpu.device, &down);
}

static void random_cloud(uint32_t count, double side, double speed)
{
    uint32_t hash = 11;
    for (uint32_t i = 0; i < count; i++) {
        virga_particle_gpu *p = water_fixture_add(&f, water_random(&hash, 0, side), water_random(&hash, 0, side),
                                                  water_random(&hash, 0, side));
        for (int k = 0; k < 3; k++)
            p->velocity[k] = (float)water_random(&hash, -speed, speed);
    }
}

static uint32_t alive(void)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < f.water->def.max_foam; i++)
        sum += foam[i].life_s > 0;
    return sum;
}

/* ---- potentials */

typedef struct potentials {
    double normal[3], air, crest, energy;
    bool steep, doubtful; /* doubtful: at a threshold, where single precision may decide differently */
} potentials;

static double clamped(double x, const float range[2])
{
    return fmin(fmax((x - (double)range[0]) / ((double)range[1] - (double)range[0]), 0), 1);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Of all neighbours in water at rest, the sum of 1 - r / h. */
static double rest_weight(void)
{
    const double n = (double)f.settings.kernel_spacings;
    return M_PI / 3 * n * n * n;
}

static double apart_of(uint32_t i, uint32_t j, double apart[3])
{
    for (int k = 0; k < 3; k++)
        apart[k] = (double)f.particles[i].position[k] - (double)f.particles[j].position[k];
    return sqrt(dot(apart, apart));
}

/* Equation 2 of Ihmsen et al. 2012, and the normal. `gradient`: the slope of the density, out of the water. */
static void find_slope(uint32_t i, potentials *out, double gradient[3])
{
    const double h = (double)f.settings.kernel_spacings * D;
    double apart[3], moved[3];
    *out = (potentials){.air = 0};
    memset(gradient, 0, 3 * sizeof *gradient);
    for (uint32_t j = 0; j < f.count; j++) {
        const double r = apart_of(i, j, apart);
        if (r >= h || i == j)
            continue;
        const double x = 1 - r * r / (h * h);
        for (int k = 0; k < 3; k++) {
            gradient[k] += 6 * 315 * D * D * D / (64 * M_PI * pow(h, 5)) * x * x * apart[k];
            moved[k] = (double)f.particles[i].velocity[k] - (double)f.particles[j].velocity[k];
        }
        const double speed = sqrt(dot(moved, moved));
        out->air += speed > 0 ? speed * (1 - dot(moved, apart) / (speed * r)) * (1 - r / h) : 0;
    }
    out->air /= rest_weight();
    const double steep = sqrt(dot(gradient, gradient));
    out->steep = steep * h > 0.3;
    out->doubtful = fabs(steep * h - 0.3) < 1e-4;
    for (int k = 0; k < 3; k++)
        out->normal[k] = out->steep ? gradient[k] / steep : 0;
}

static void find_air(uint32_t i, potentials *out)
{
    double gradient[3];
    find_slope(i, out, gradient);
}

/* Equations 3 and 4. */
static void find_crest(uint32_t i, const potentials *all, potentials *out)
{
    const double h = (double)f.settings.kernel_spacings * D;
    double velocity[3], apart[3];
    for (int k = 0; k < 3; k++)
        velocity[k] = (double)f.particles[i].velocity[k];
    const double speed2 = dot(velocity, velocity), along = dot(velocity, out->normal);
    out->energy =
        clamped(0.5 * speed2, (const float[2]){0.5f * f.settings.foam_speed_m_s[0] * f.settings.foam_speed_m_s[0],
                                               0.5f * f.settings.foam_speed_m_s[1] * f.settings.foam_speed_m_s[1]});
    out->doubtful |= fabs(along - 0.6 * sqrt(speed2)) < 1e-5;
    if (!out->steep || along < 0.6 * sqrt(speed2))
        return;
    for (uint32_t j = 0; j < f.count; j++) {
        const double r = apart_of(i, j, apart), below = dot(apart, out->normal);
        out->doubtful |= r < h && i != j && fabs(below) < 1e-7;
        if (i != j && r < h && below > 0 && all[j].steep)
            out->crest += (1 - dot(out->normal, all[j].normal)) * (1 - r / h);
    }
    out->crest /= rest_weight();
}

static void potentials_are_those_of_the_paper(void **state)
{
    (void)state;
    static potentials all[1500];
    double worst_air = 0, worst_normal = 0, worst_number = 0, crests = 0, airs = 0;
    set_up(65536);
    random_cloud(1500, 13 * D, 2);
    f.settings.foam_crest[0] = 0.05f;
    step(STEP_S);
    step(STEP_S);
    for (uint32_t i = 0; i < f.count; i++)
        find_air(i, &all[i]);
    for (uint32_t i = 0; i < f.count; i++)
        find_crest(i, all, &all[i]);
    uint32_t doubtful = 0, made = 0;
    for (uint32_t s = 0; s < f.stats.in_grid; s++) {
        const uint32_t i = f.sorted_indices[s];
        const potentials *p = &all[i];
        made += emissions[4 * s];
        worst_air = fmax(worst_air, fabs((double)normals[4 * s + 3] - p->air));
        if (p->doubtful) {
            doubtful++;
            continue;
        }
        for (int k = 0; k < 3; k++)
            worst_normal = fmax(worst_normal, fabs((double)normals[4 * s + (uint32_t)k] - p->normal[k]));
        const double air = clamped(p->air, f.settings.foam_air_m_s), crest = clamped(p->crest, f.settings.foam_crest);
        const double expected = p->energy * (600 * air + 600 * crest) * STEP_S;
        /* Rounded by a random number, so it may be off by one; its mean is checked below. */
        worst_number = fmax(worst_number, fabs((double)emissions[4 * s] - fmin(expected, 64)));
        airs += p->energy * air * 600 * STEP_S;
        crests += p->energy * crest * 600 * STEP_S;
    }
    printf("air within %g m/s, normals within %g; %u made, expected %g by air and %g by crests; %u doubtful\n",
           worst_air, worst_normal, made, airs, crests, doubtful);
    REQUIRE(worst_air < 2e-5 && worst_normal < 2e-4 && worst_number <= 1.001);
    REQUIRE(crests > 20 && airs > 1000 && doubtful < 15 && f.stats.foam_dropped == 0);
    REQUIRE(fabs(made - airs - crests) < 0.02 * (airs + crests));
    assert_int_equal(counts->foam_wanted, made);
    tear_down();
}

/* The sum of equation 2 over the space behind a wall, where particles are at rest, with the water at speed 1 into it:
 * (1 + cos) W, over rings around the normal. */
static double wall_air(double z)
{
    enum { PLANES = 200, RINGS = 200 };
    const double h = (double)f.settings.kernel_spacings * D, each = (h - z) / PLANES;
    double sum = 0;
    for (int i = 0; i < PLANES * RINGS && z < h; i++) {
        const double s = z + (i % PLANES + 0.5) * each, width = sqrt(h * h - s * s) / RINGS;
        const double x = (i / PLANES + 0.5) * width, r = sqrt(s * s + x * x);
        sum += 2 * M_PI * x * width * each * (1 + s / r) * (1 - r / h);
    }
    return sum / (D * D * D) / rest_weight();
}

/* At both walls of each axis; water that leaves a wall or slides along it traps nothing there. */
static void water_that_meets_a_wall_traps_air(void **state)
{
    (void)state;
    const double side = 6 * D;
    double worst = 0, most = 0;
    set_up(1024);
    random_cloud(200, side, 2);
    for (int axis = 0; axis < 3; axis++) {
        f.settings.foam_walls_low_m[axis] = 0;
        f.settings.foam_walls_high_m[axis] = (float)side;
    }
    step(STEP_S);
    for (uint32_t s = 0; s < f.stats.in_grid; s++) {
        const uint32_t i = f.sorted_indices[s];
        potentials p;
        double walls = 0;
        find_air(i, &p);
        for (int axis = 0; axis < 3; axis++) {
            const double v = (double)f.particles[i].velocity[axis], at = (double)f.particles[i].position[axis];
            walls += fabs(v) * wall_air(v < 0 ? at : side - at);
        }
        worst = fmax(worst, fabs((double)normals[4 * s + 3] - p.air - walls));
        most = fmax(most, walls);
    }
    printf("air within %.1e m/s, up to %.2f of it by walls\n", worst, most);
    REQUIRE(worst < 2e-3 && most > 1);
    tear_down();
}

/* The slope of the density that the water behind a plane would add, over rings, with h = 1. */
static double plane_slope(double u)
{
    enum { PLANES = 400 };
    double sum = 0;
    for (int i = 0; i < PLANES && u < 1; i++) {
        const double s = u + (i + 0.5) * (1 - u) / PLANES, rest = 1 - s * s;
        /* The integral of (1 - s^2 - x^2)^2 over the ring's plane is pi / 3 (1 - s^2)^3. */
        sum += s * M_PI / 3 * rest * rest * rest * (1 - u) / PLANES;
    }
    return 6 * 315 / (64 * M_PI) * sum;
}

/* A cloud beside a plane that moves; each particle has a share of its own. Some are far from any body. */
static void a_body_is_a_wall_that_moves(void **state)
{
    (void)state;
    const double out[3] = {0.6, 0.8, 0}, body_velocity[3] = {-0.7, 1.1, 0.4};
    host_buffer bodies;
    double worst_air = 0, worst_normal = 0, most = 0, turned = 0;
    uint32_t doubtful = 0;
    set_up(1024);
    random_cloud(300, 7 * D, 2);
    REQUIRE(host_buffer_create(&f.gpu.device, f.count * sizeof(virga_body_near_gpu), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                               HOST_BUFFER_UPLOAD, "bodies", &bodies, f.gpu.error, sizeof f.gpu.error));
    virga_body_near_gpu *near = bodies.mapped;
    for (uint32_t i = 0; i < f.count; i++) {
        const float *p = f.particles[i].position;
        near[i].distance_m = i % 7 ? (float)(out[0] * (double)p[0] + out[1] * (double)p[1] - 0.03) : 1e9f;
        near[i].share = 1 - 0.1f * (float)(i % 5);
        for (int k = 0; k < 3; k++) {
            near[i].normal[k] = (float)out[k];
            near[i].velocity[k] = (float)body_velocity[k];
        }
    }
    f.bodies = bodies.buffer;
    step(STEP_S);
    const double h = (double)f.settings.kernel_spacings * D;
    for (uint32_t s = 0; s < f.stats.in_grid; s++) {
        const uint32_t i = f.sorted_indices[s];
        const double z = fmax((double)near[i].distance_m, 0), share = (double)near[i].share;
        potentials p;
        double into = 0, gradient[3], steep = 0;
        find_slope(i, &p, gradient);
        for (int k = 0; k < 3; k++) {
            into -= ((double)f.particles[i].velocity[k] - body_velocity[k]) * out[k];
            gradient[k] += share * plane_slope(z / h) / h * out[k];
        }
        const double body = share * fmax(into, 0) * wall_air(z);
        worst_air = fmax(worst_air, fabs((double)normals[4 * s + 3] - p.air - body));
        most = fmax(most, body);
        steep = sqrt(dot(gradient, gradient));
        doubtful += fabs(steep * h - 0.3) < 1e-3;
        for (int k = 0; k < 3 && fabs(steep * h - 0.3) >= 1e-3; k++) {
            const double normal = steep * h > 0.3 ? gradient[k] / steep : 0;
            worst_normal = fmax(worst_normal, fabs((double)normals[4 * s + (uint32_t)k] - normal));
            turned = fmax(turned, fabs(normal - p.normal[k]));
        }
    }
    printf(
        "air within %.1e m/s, up to %.2f of it by the body; normals within %.1e, turned by up to %.2f; %u doubtful\n",
        worst_air, most, worst_normal, turned, doubtful);
    REQUIRE(worst_air < 2e-3 && most > 1);
    REQUIRE(worst_normal < 2e-3 && turned > 1 && doubtful < 5);
    host_buffer_destroy(&f.gpu.device, &bodies);
    f.bodies = VK_NULL_HANDLE;
    tear_down();
}

/* A block of water runs against the side of a body and along it: its outermost layer there is no surface. */
static void the_side_of_a_body_makes_no_crest(void **state)
{
    (void)state;
    host_buffer bodies;
    uint32_t surface[2] = {0}, made[2];
    set_up(65536);
    water_fixture_box(&f, (const double[3]){0.5 * D, 0, 0}, (const uint32_t[3]){10, 10, 10}, D, 0);
    for (uint32_t i = 0; i < f.count; i++)
        f.particles[i].velocity[0] = -2.5f;
    f.settings.foam_air_hz = 0;
    f.settings.foam_crest[0] = 0.01f;
    f.settings.foam_crest[1] = 0.1f;
    REQUIRE(host_buffer_create(&f.gpu.device, f.count * sizeof(virga_body_near_gpu), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                               HOST_BUFFER_UPLOAD, "bodies", &bodies, f.gpu.error, sizeof f.gpu.error));
    virga_body_near_gpu *near = bodies.mapped;
    for (uint32_t i = 0; i < f.count; i++)
        near[i] = (virga_body_near_gpu){
            .normal = {1}, .distance_m = f.particles[i].position[0], .velocity = {-2.5f}, .share = 1};
    for (int with = 0; with < 2; with++) {
        f.bodies = with ? bodies.buffer : VK_NULL_HANDLE;
        step(STEP_S);
        step(STEP_S);
        made[with] = counts->foam_wanted;
        for (uint32_t s = 0; s < f.stats.in_grid; s++)
            surface[with] += normals[4 * s] < -0.5f;
    }
    printf("%u particles have a surface towards the body without it, %u with it; %u and %u particles of foam\n",
           surface[0], surface[1], made[0], made[1]);
    REQUIRE(surface[0] >= 64 && surface[1] == 0);
    REQUIRE(made[0] > 50 && made[1] == 0);
    host_buffer_destroy(&f.gpu.device, &bodies);
    f.bodies = VK_NULL_HANDLE;
    tear_down();
}

/* ---- number and life times */

/* All potentials are 1 where there is any motion: each particle makes 80 in a second. */
static void saturate(void)
{
    f.settings.foam_speed_m_s[0] = f.settings.foam_air_m_s[0] = 0;
    f.settings.foam_speed_m_s[1] = f.settings.foam_air_m_s[1] = 1e-3f;
    f.settings.foam_crest_hz = 0;
    f.settings.foam_air_hz = 80;
}

static void the_number_of_foam_is_a_rate_times_time(void **state)
{
    (void)state;
    set_up(65536);
    random_cloud(2000, 14 * D, 1);
    saturate();
    step(0);
    assert_int_equal(f.stats.foam, 0);
    for (int i = 1; i <= 4; i++)
        step(STEP_S);
    /* Each rounds 1.25; the standard deviation of a rounding is 0.43. */
    const double expected = 4 * 2000 * 80 * STEP_S, deviation = 0.43 * sqrt(4 * 2000);
    REQUIRE(fabs((double)f.stats.foam - expected) < 5 * deviation);
    assert_int_equal(f.stats.foam, alive());
    tear_down();
}

/* The potentials are 1, so life times are spread evenly over 0.75 to 1.25 of the longest one. */
static void foam_dissolves_at_the_end_of_its_life(void **state)
{
    (void)state;
    set_up(65536);
    random_cloud(2000, 14 * D, 1);
    saturate();
    f.settings.foam_life_s[1] = 1;
    step(0);
    step(STEP_S);
    const double made = f.stats.foam;
    f.settings.foam_air_hz = 0;
    f.count = 0; /* without water all of it is spray, and ages */
    for (int i = 1; i <= 82; i++) {
        step(STEP_S);
        const double share = fmin(fmax((1.25 - i * STEP_S) / 0.5, 0), 1);
        if (fabs(f.stats.foam / made - share) > 0.03)
            fail_msg("after %g s %u of %g live, expected %g", i * STEP_S, f.stats.foam, made, share * made);
    }
    assert_int_equal(f.stats.foam, 0);
    tear_down();
}

static void a_full_pool_makes_no_more_and_says_so(void **state)
{
    (void)state;
    set_up(1000);
    random_cloud(2000, 14 * D, 1);
    saturate();
    step(0);
    step(STEP_S);
    assert_int_equal(f.stats.foam, 1000);
    REQUIRE(f.stats.foam_dropped > 1400 && f.stats.foam_dropped < 1600);
    assert_int_equal(alive(), 1000);
    tear_down();
}

static void a_jump_in_time_begins_anew(void **state)
{
    (void)state;
    set_up(65536);
    random_cloud(500, 10 * D, 1);
    saturate();
    step(0);
    step(STEP_S);
    REQUIRE(f.stats.foam > 400);
    step(10);
    assert_int_equal(f.stats.foam, 0);
    assert_int_equal(alive(), 0);
    tear_down();
}

/* ---- motion */

/* One particle of water far from all else makes foam; then it is taken away. */
static void make_one_burst(double vx, double vy, double vz)
{
    virga_particle_gpu *fast = water_fixture_add(&f, 0, 0, 0), *slow = water_fixture_add(&f, 0.01, 0, 0);
    fast->velocity[0] = (float)vx;
    fast->velocity[1] = (float)vy;
    fast->velocity[2] = (float)vz;
    slow->share = 0.01f;
    saturate();
    f.settings.foam_air_hz = 64 / STEP_S;
    step(0);
    step(STEP_S);
    f.settings.foam_air_hz = 0;
    f.count = 0;
}

/* The drag of a sphere in air, C_d = (0.55 + 4.8 / sqrt(Re))^2, and gravity; steps of 0.1 ms. */
static void fly(double p[3], double v[3], double diameter, double time_s)
{
    const int steps = (int)ceil(time_s * 1e4);
    for (int i = 0; i < steps; i++) {
        const double dt = time_s / steps, speed = fmax(sqrt(dot(v, v)), 1e-9);
        const double root = 0.55 + 4.8 / sqrt(1.204 / 1.813e-5 * speed * diameter);
        const double rate = 0.75 * 1.204 / 998.2 * root * root * speed / diameter;
        for (int k = 0; k < 3; k++) {
            const double a = -rate * v[k] - (k == 1 ? GRAVITY : 0);
            p[k] += dt * (v[k] + 0.5 * dt * a);
            v[k] += dt * a;
        }
    }
}

static void spray_flies_as_drops_in_air(void **state)
{
    (void)state;
    static virga_foam_gpu before[4096];
    double worst = 0;
    uint32_t flown = 0;
    set_up(4096);
    make_one_burst(3, 3, -1);
    memcpy(before, foam, sizeof before);
    for (int i = 0; i < 8; i++)
        step(STEP_S);
    for (uint32_t i = 0; i < 4096; i++) {
        if (!(before[i].life_s > 0))
            continue;
        double p[3], v[3];
        for (int k = 0; k < 3; k++) {
            p[k] = (double)before[i].position[k];
            v[k] = (double)before[i].velocity[k];
        }
        fly(p, v, 2 * (double)before[i].radius, 8 * STEP_S);
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs(p[k] - (double)foam[i].position[k]));
        assert_int_equal(foam[i].kind, VIRGA_FOAM_SPRAY);
        flown++;
    }
    printf("%u particles of spray: off their orbits by up to %g m after %g s\n", flown, worst, 8 * STEP_S);
    REQUIRE(flown >= 32 && worst < 0.004);
    tear_down();
}

/* Water that moves as a whole, over the place where foam was made. */
static void flowing_water(double x, double speed, double low_y, uint32_t rows)
{
    const double low[3] = {x - 6 * D, low_y, -6 * D};
    const uint32_t size[3] = {13, rows, 13};
    f.count = 0;
    water_fixture_box(&f, low, size, D, 0);
    for (uint32_t i = 0; i < f.count; i++)
        f.particles[i].velocity[0] = (float)speed;
}

static void bubbles_rise_through_the_water(void **state)
{
    (void)state;
    static virga_foam_gpu before[4096];
    const double low_y = -6 * D, time_s = 4 * STEP_S;
    double worst = 0;
    uint32_t risen = 0;
    set_up(4096);
    make_one_burst(0.5, 0, 0);
    flowing_water(0, 0, low_y, 20);
    step(STEP_S); /* now they are bubbles */
    memcpy(before, foam, sizeof before);
    for (int i = 0; i < 4; i++)
        step(STEP_S);
    const double rate = (double)f.settings.foam_drag_hz, kept = exp(-rate * time_s);
    for (uint32_t i = 0; i < 4096; i++) {
        if (!(before[i].life_s > 0))
            continue;
        assert_int_equal(foam[i].kind, VIRGA_FOAM_BUBBLE);
        assert_true(foam[i].life_s == before[i].life_s);
        for (int k = 0; k < 3; k++) {
            const double end = k == 1 ? 0.25 : 0, gap = (double)before[i].velocity[k] - end;
            worst = fmax(worst, fabs(end + gap * kept - (double)foam[i].velocity[k]));
            worst = fmax(worst, fabs((double)before[i].position[k] + end * time_s + gap * (1 - kept) / rate -
                                     (double)foam[i].position[k]));
        }
        risen++;
    }
    REQUIRE(risen >= 32 && worst < 2e-5);
    tear_down();
}

/* On water that flows as a whole foam keeps its position on it, and lies on the surface. */
static void foam_drifts_with_the_water(void **state)
{
    (void)state;
    static virga_foam_gpu before[4096];
    const double speed = 1.5;
    double worst = 0, off = 0;
    uint32_t drifting = 0;
    set_up(4096);
    make_one_burst(0.5, 0, 0);
    for (int i = 0; i < 30; i++) {
        flowing_water(speed * i * STEP_S, speed, -9.2 * D, 10);
        step(STEP_S);
        if (i == 14)
            memcpy(before, foam, sizeof before);
    }
    for (uint32_t i = 0; i < 4096; i++) {
        if (!(foam[i].life_s > 0) || foam[i].kind != VIRGA_FOAM_SURFACE || before[i].kind != VIRGA_FOAM_SURFACE)
            continue;
        const double at[3] = {(double)foam[i].position[0], (double)foam[i].position[1], (double)foam[i].position[2]};
        worst = fmax(worst, fabs(at[0] - (double)before[i].position[0] - speed * 15 * STEP_S));
        worst = fmax(worst, fabs(at[2] - (double)before[i].position[2]));
        off = fmax(off, fabs(water_reference(&f, at, NULL) - (double)f.settings.level));
        drifting++;
    }
    printf("%u drift, off the water's motion by up to %g m; density at them within %g of the surface's\n", drifting,
           worst, off);
    REQUIRE(drifting >= 32 && worst < 0.1 * D && off < 0.02);
    tear_down();
}

/* ---- the same bits, and frames that are thrown away */

static void the_same_water_makes_the_same_foam(void **state)
{
    (void)state;
    static virga_foam_gpu first[65536];
    uint32_t made = 0;
    for (int run = 0; run < 2; run++) {
        set_up(65536);
        random_cloud(2000, 14 * D, 2);
        for (int frame = 0; frame < 5; frame++) {
            step(STEP_S);
            for (uint32_t i = 0; i < f.count && run; i++) { /* in another order */
                const uint32_t other = virga_hash2(i, (uint32_t)frame) % f.count;
                const virga_particle_gpu swapped = f.particles[i];
                f.particles[i] = f.particles[other];
                f.particles[other] = swapped;
            }
        }
        REQUIRE(f.stats.foam > 2000);
        if (run)
            assert_memory_equal(first, foam, sizeof first);
        memcpy(first, foam, sizeof first);
        made = f.stats.foam;
        tear_down();
    }
    printf("%u particles of foam are the same\n", made);
}

static void a_frame_that_is_thrown_away_is_made_up_for(void **state)
{
    (void)state;
    double position[2][3];
    for (int lost = 0; lost < 2; lost++) {
        set_up(4096);
        make_one_burst(0, 0, 3);
        if (lost) {
            f.time_s += STEP_S;
            water_fixture_throw_away(&f);
            f.time_s -= STEP_S;
        } else {
            step(STEP_S);
            f.time_s -= STEP_S;
        }
        step(2 * STEP_S);
        for (int k = 0; k < 3; k++)
            position[lost][k] = (double)foam[0].position[k];
        tear_down();
    }
    for (int k = 0; k < 3; k++)
        assert_float_equal(position[0][k], position[1][k], 2e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(potentials_are_those_of_the_paper),
        cmocka_unit_test(water_that_meets_a_wall_traps_air),
        cmocka_unit_test(a_body_is_a_wall_that_moves),
        cmocka_unit_test(the_side_of_a_body_makes_no_crest),
        cmocka_unit_test(the_number_of_foam_is_a_rate_times_time),
        cmocka_unit_test(foam_dissolves_at_the_end_of_its_life),
        cmocka_unit_test(a_full_pool_makes_no_more_and_says_so),
        cmocka_unit_test(a_jump_in_time_begins_anew),
        cmocka_unit_test(spray_flies_as_drops_in_air),
        cmocka_unit_test(bubbles_rise_through_the_water),
        cmocka_unit_test(foam_drifts_with_the_water),
        cmocka_unit_test(the_same_water_makes_the_same_foam),
        cmocka_unit_test(a_frame_that_is_thrown_away_is_made_up_for),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
