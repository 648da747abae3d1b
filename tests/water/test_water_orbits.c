/* Spray in the physical style: pieces of a particle, their orbits in air against double precision, how they break. */
#include "water_fixture.h"

#define WATER_DENSITY   998.2
#define AIR_DENSITY     1.204
#define AIR_VISCOSITY   1.813e-5
#define SURFACE_TENSION 0.0728
#define GRAVITY         9.80665

static water_fixture f;

static void set_up(void)
{
    water_fixture_open(&f);
    f.settings.spacing_m = 0.02f;
    f.settings.spray_density = 0.45f;
}

static void add_drop(double x, double y, double speed)
{
    water_fixture_add(&f, x, y, 0.5)->velocity[0] = (float)speed;
}

static double volume_of(double radius)
{
    return 4 * M_PI / 3 * radius * radius * radius;
}

/* Volume (m^3), and volume times velocity and position, of all droplets. */
static double sum_droplets(double momentum[3], double center[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        momentum[k] = center[k] = 0;
    for (uint32_t i = 0; i < f.stats.droplets; i++) {
        const double volume = volume_of((double)f.droplets[i].radius);
        sum += volume;
        for (int k = 0; k < 3; k++) {
            momentum[k] += volume * (double)f.droplets[i].velocity[k];
            center[k] += volume * (double)f.droplets[i].position[k];
        }
    }
    return sum;
}

static void pieces_have_volume_momentum_and_center_of_the_particle(void **state)
{
    (void)state;
    for (int i = 0; i < 12; i++) {
        const double speed = 0.5 * i, particle = pow(0.02, 3), apart = 0.1 * speed;
        double momentum[3], center[3];
        set_up();
        add_drop(0.3, 0.2, speed);
        water_fixture_step(&f);
        const double whole = 12 * SURFACE_TENSION / (WATER_DENSITY * fmax(apart * apart, 1e-12));
        const double count = fmin(fmax(6 * particle / M_PI / (whole * whole * whole), 1), 25);
        assert_int_equal(f.stats.droplets, (uint32_t)count);
        assert_float_equal(sum_droplets(momentum, center) / particle, 1, 1e-5);
        assert_float_equal(momentum[0] / particle, speed, 1e-5 * speed + 1e-9);
        assert_float_equal(momentum[1] / particle, 0, 1e-6 * speed + 1e-9);
        assert_float_equal(center[0] / particle, 0.3, 1e-5);
        assert_float_equal(center[1] / particle, 0.2, 1e-5);
        water_fixture_close(&f);
    }
}

/* Volumes of many pieces: an exponential distribution has a standard deviation as large as its mean, ours 1 / 1.1. */
static void pieces_have_many_sizes(void **state)
{
    (void)state;
    double squares = 0;
    set_up();
    for (int i = 0; i < 200; i++)
        add_drop(0.1 * (i % 20), 0.1 * (i / 20), 4);
    f.settings.spray_pieces = 32;
    water_fixture_step(&f);
    REQUIRE(f.stats.droplets == 200 * 32);
    for (uint32_t i = 0; i < f.stats.droplets; i++)
        squares += pow(volume_of((double)f.droplets[i].radius) / (pow(0.02, 3) / 32) - 1, 2);
    const double deviation = sqrt(squares / f.stats.droplets);
    if (deviation < 0.8 || deviation > 0.95)
        fail_msg("deviation of the volumes %g of their mean", deviation);
    water_fixture_close(&f);
}

typedef struct orbit {
    double position[3], velocity[3];
} orbit;

/* Gravity, and the drag of a sphere: C_d = (0.55 + 4.8 / sqrt(Re))^2. */
static void accelerate(const double velocity[3], double diameter, double out[3])
{
    double speed = 0;
    for (int k = 0; k < 3; k++)
        speed += velocity[k] * velocity[k];
    speed = sqrt(speed);
    const double root = 0.55 + 4.8 / sqrt(AIR_DENSITY * speed * diameter / AIR_VISCOSITY);
    for (int k = 0; k < 3; k++)
        out[k] = -0.75 * root * root * AIR_DENSITY / WATER_DENSITY / diameter * speed * velocity[k];
    out[1] -= GRAVITY;
}

/* The midpoint rule with steps of 20 microseconds. */
static void fly(orbit *drop, double diameter, double time_s)
{
    const int steps = (int)(time_s / 2e-5 + 0.5);
    const double step_s = time_s / steps;
    for (int i = 0; i < steps; i++) {
        double a[3], middle[3];
        accelerate(drop->velocity, diameter, a);
        for (int k = 0; k < 3; k++)
            middle[k] = drop->velocity[k] + 0.5 * step_s * a[k];
        accelerate(middle, diameter, a);
        for (int k = 0; k < 3; k++) {
            drop->position[k] += step_s * middle[k];
            drop->velocity[k] += step_s * a[k];
        }
    }
}

/* Moves the particle as a simulation without air would. */
static void throw_particle(const double velocity[3], double time_s)
{
    for (int k = 0; k < 3; k++) {
        const double fall = k == 1 ? GRAVITY : 0;
        f.particles[0].position[k] = (float)(velocity[k] * time_s - 0.5 * fall * time_s * time_s);
        f.particles[0].velocity[k] = (float)(velocity[k] - fall * time_s);
    }
    f.time_s = time_s;
    water_fixture_step(&f);
}

static void droplets_fly_as_drops_in_air(void **state)
{
    (void)state;
    static orbit orbits[32];
    const double velocity[3] = {3, 3.5, -1};
    double worst = 0, slowed = 0;
    set_up();
    add_drop(0, 0, 0);
    throw_particle(velocity, 0);
    const uint32_t droplets = f.stats.droplets;
    REQUIRE(droplets >= 10);
    for (uint32_t i = 0; i < droplets; i++)
        for (int k = 0; k < 3; k++) {
            orbits[i].position[k] = (double)f.droplets[i].position[k];
            orbits[i].velocity[k] = (double)f.droplets[i].velocity[k];
        }
    for (int frame = 1; frame <= 6; frame++) {
        throw_particle(velocity, frame / 60.0);
        assert_int_equal(f.stats.droplets, droplets);
        for (uint32_t i = 0; i < droplets; i++) {
            double lag = 0;
            fly(&orbits[i], 2 * (double)f.droplets[i].radius, 1 / 60.0);
            for (int k = 0; k < 3; k++) {
                worst = fmax(worst, fabs(orbits[i].position[k] - (double)f.droplets[i].position[k]));
                lag += pow((double)f.particles[0].velocity[k] - orbits[i].velocity[k], 2);
            }
            slowed = fmax(slowed, sqrt(lag));
        }
    }
    printf("%u droplets: off their orbits by up to %g m after 0.1 s; slower than the particle by up to %g m/s\n",
           droplets, worst, slowed);
    REQUIRE(worst < 1e-5 && slowed > 0.2);
    water_fixture_close(&f);
}

static void no_droplet_gets_far_from_its_particle(void **state)
{
    (void)state;
    const double velocity[3] = {9, 6, 0};
    double farthest = 0;
    set_up();
    f.settings.spray_turbulence = 0.3f;
    add_drop(0, 0, 0);
    for (int frame = 0; frame <= 60; frame++) {
        throw_particle(velocity, frame / 60.0);
        for (uint32_t i = 0; i < f.stats.droplets; i++) {
            double r2 = 0;
            for (int k = 0; k < 3; k++)
                r2 += pow((double)f.droplets[i].position[k] - (double)f.particles[0].position[k], 2);
            farthest = fmax(farthest, sqrt(r2));
        }
    }
    REQUIRE(farthest > 0.079 && farthest < 0.0801);
    water_fixture_close(&f);
}

/* Weber numbers of 11 and 30 in air: the one stays whole, the other breaks until its pieces stay whole. */
static uint32_t pieces_after_flight(double weber)
{
    const double particle = pow(0.02, 3), diameter = cbrt(6 * particle / M_PI);
    const double speed = sqrt(weber * SURFACE_TENSION / (AIR_DENSITY * diameter));
    double momentum[3], center[3];
    set_up();
    f.settings.spray_turbulence = 0;
    add_drop(0, 0, speed);
    for (int frame = 0; frame < 120; frame++) {
        f.time_s = frame / 60.0;
        f.particles[0].position[0] = (float)(speed * f.time_s);
        water_fixture_step(&f);
        assert_float_equal(sum_droplets(momentum, center) / particle, 1, 1e-5);
    }
    const uint32_t pieces = f.stats.droplets;
    for (uint32_t i = 0; i < pieces; i++) {
        const double u = fabs((double)f.droplets[i].velocity[0]), d = 2 * (double)f.droplets[i].radius;
        REQUIRE(AIR_DENSITY * u * u * d / SURFACE_TENSION < 12);
    }
    water_fixture_close(&f);
    return pieces;
}

static void drops_break_above_a_weber_number_of_12(void **state)
{
    (void)state;
    assert_int_equal(pieces_after_flight(11), 1);
    REQUIRE(pieces_after_flight(30) >= 2);
}

/* A particle alone has the density 0.196. The surface keeps what the spray does not have. */
static void particles_become_spray_by_degrees(void **state)
{
    (void)state;
    double before = 0, largest_jump = 0, momentum[3], center[3];
    set_up();
    f.settings.level = 0.05f;
    add_drop(0, 0, 0);
    for (int i = 0; i <= 40; i++) {
        f.settings.spray_density = 0.16f + 0.002f * i;
        water_fixture_step(&f);
        const double part = sum_droplets(momentum, center) / pow(0.02, 3);
        const double density = 315 / (64 * M_PI * 8), threshold = (double)f.settings.spray_density;
        const double t = fmin(fmax((1.15 - density / threshold) / 0.3, 0), 1), expected = t * t * (3 - 2 * t);
        assert_float_equal(part, expected, 1e-4);
        largest_jump = fmax(largest_jump, fabs(part - before));
        before = part;
        for (uint32_t k = 0; k < f.stats.in_grid; k++)
            assert_float_equal((double)f.centers[4 * k + 3], 1 - expected, 1e-4);
    }
    REQUIRE(before > 0.99 && largest_jump < 0.1);
    water_fixture_close(&f);
}

static void the_same_particles_give_the_same_orbits(void **state)
{
    (void)state;
    static virga_spray_gpu first[4096];
    uint32_t droplets = 0;
    for (int run = 0; run < 2; run++) {
        set_up();
        for (int i = 0; i < 100; i++)
            add_drop(0.1 * (i % 10), 0.1 * (i / 10), 0.3 * (i % 20));
        for (int frame = 0; frame < 6; frame++) {
            f.time_s = 0.03 * frame;
            water_fixture_step(&f);
            for (uint32_t i = 0; i < f.count; i++) {
                const uint32_t other = run ? virga_hash2(i, (uint32_t)frame) % f.count : i;
                const virga_particle_gpu swapped = f.particles[i];
                f.particles[i] = f.particles[other];
                f.particles[other] = swapped;
            }
            for (uint32_t i = 0; i < f.count; i++)
                f.particles[i].position[0] += f.particles[i].velocity[0] * 0.001f;
        }
        REQUIRE(f.stats.droplets > 800 && f.stats.droplets < 4096);
        if (!run)
            memcpy(first, f.droplets, f.stats.droplets * sizeof *first);
        else
            assert_memory_equal(first, f.droplets, droplets * sizeof *first);
        droplets = f.stats.droplets;
        water_fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_have_volume_momentum_and_center_of_the_particle),
        cmocka_unit_test(pieces_have_many_sizes),
        cmocka_unit_test(droplets_fly_as_drops_in_air),
        cmocka_unit_test(no_droplet_gets_far_from_its_particle),
        cmocka_unit_test(drops_break_above_a_weber_number_of_12),
        cmocka_unit_test(particles_become_spray_by_degrees),
        cmocka_unit_test(the_same_particles_give_the_same_orbits),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
