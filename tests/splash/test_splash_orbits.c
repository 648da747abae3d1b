/* Droplets against the law that they fly by, integrated in double precision: Mizukami et al., equations 2 to 4, as
 *   dV/dt = -3 rho_a / (4 rho_w d) Cd |u| u - g,  Cd = (0.55 + 4.8 / sqrt(Re))^2,  u = V - wind. */
#include "splash_fixture.h"

#include <math.h>

#define WATER_DENSITY 998.2
#define AIR_VISCOSITY 1.813e-5
#define GRAVITY       9.80665
#define PARTS         20 /* of a tick, of the reference; twice as many change it by less than 1e-6 of the way */
#define AIRS          5
#define PER_AIR       2000

static splash_fixture f;

/* What blows past the droplets of one run. */
typedef struct air {
    double density, wind[3];
} air;

typedef struct body {
    double position[3], velocity[3], path_m, diameter_m;
} body;

/* ---- the reference */

static void acceleration(const air *air, double diameter_m, const double velocity[3], double out[3])
{
    double u[3], speed = 0;
    for (int i = 0; i < 3; i++) {
        u[i] = velocity[i] - air->wind[i];
        speed += u[i] * u[i];
    }
    speed = fmax(sqrt(speed), 1e-12);
    const double reynolds = speed * diameter_m * air->density / AIR_VISCOSITY, root = 0.55 + 4.8 / sqrt(reynolds);
    const double k = 3 * air->density / (4 * WATER_DENSITY * diameter_m) * root * root * speed;
    for (int i = 0; i < 3; i++)
        out[i] = -k * u[i] - (i == 1 ? GRAVITY : 0);
}

/* Runge and Kutta of fourth order for position and velocity together. */
static void advance(const air *air, body *b, double dt)
{
    static const double reach[4] = {0, 0.5, 0.5, 1}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    double slope[3] = {0, 0, 0}, moved[3] = {0, 0, 0}, gained[3] = {0, 0, 0};
    for (int stage = 0; stage < 4; stage++) {
        double velocity[3];
        for (int i = 0; i < 3; i++)
            velocity[i] = b->velocity[i] + reach[stage] * dt * slope[i];
        acceleration(air, b->diameter_m, velocity, slope);
        for (int i = 0; i < 3; i++) {
            moved[i] += weight[stage] * dt * velocity[i];
            gained[i] += weight[stage] * dt * slope[i];
        }
    }
    b->path_m += sqrt(moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2]);
    for (int i = 0; i < 3; i++) {
        b->position[i] += moved[i];
        b->velocity[i] += gained[i];
    }
}

/* ---- droplets */

static double chance(uint32_t id, uint32_t stream)
{
    return (double)virga_unit(virga_hash2(id, stream));
}

/* 0.1 to 3 mm, 0.1 to 4 m/s, any upward direction; in the air already, and the ground is a kilometre below. */
static virga_droplet_gpu random_droplet(uint32_t id)
{
    const double speed = 0.1 + 3.9 * chance(id, 1), up = chance(id, 2), azimuth = 2 * M_PI * chance(id, 3);
    const double side = sqrt(1 - up * up);
    return (virga_droplet_gpu){
        .velocity = {(float)(speed * side * cos(azimuth)), (float)(speed * up), (float)(speed * side * sin(azimuth))},
        .diameter_m = (float)(0.1e-3 * pow(30, chance(id, 4))),
        .base = {0, -1000, 0},
        .kind = VIRGA_SPLASH_SCATTERING | VIRGA_DROPLET_ALIVE | VIRGA_DROPLET_FREE,
        .id = id,
        .water_nl = 1};
}

static body body_of(const virga_droplet_gpu *droplet)
{
    body b = {.diameter_m = (double)droplet->diameter_m};
    for (int i = 0; i < 3; i++) {
        b.position[i] = (double)droplet->position[i];
        b.velocity[i] = (double)droplet->velocity[i];
    }
    return b;
}

static void blow(const air *air)
{
    for (int i = 0; i < 3; i++)
        f.wind[i] = (float)air->wind[i];
    f.settings.air_density = (float)air->density;
    REQUIRE(virga_splash_set(f.splash, &f.settings) == VIRGA_OK);
}

static double distance(const float a[3], const double b[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += ((double)a[i] - b[i]) * ((double)a[i] - b[i]);
    return sqrt(sum);
}

/* Follows droplets for 1 s and returns the greatest distance from the reference, as a share of the way so far. */
static double max_error_of_a_second(const air *air, const virga_droplet_gpu *droplets, uint32_t count,
                                    double *max_speed_error)
{
    static body bodies[PER_AIR];
    double max_error = 0;
    blow(air);
    splash_fixture_put(&f, droplets, count);
    for (uint32_t i = 0; i < count; i++)
        bodies[i] = body_of(&droplets[i]);
    for (int tick = 0; tick < 60; tick++) {
        splash_fixture_step(&f, 1);
        for (uint32_t i = 0; i < count; i++) {
            for (int part = 0; part < PARTS; part++)
                advance(air, &bodies[i], f.splash->def.tick_s / PARTS);
            max_error = fmax(max_error, distance(f.droplets[i].position, bodies[i].position) / bodies[i].path_m);
            *max_speed_error = fmax(*max_speed_error, distance(f.droplets[i].velocity, bodies[i].velocity));
        }
    }
    return max_error;
}

/* ---- tests */

static void test_ten_thousand_droplets_fly_by_the_law(void **state)
{
    (void)state;
    static const air airs[AIRS] = {
        {0.6, {0, 0, 0}}, {0.8, {3, 0, -1}}, {1.0, {-8, 0.5, 4}}, {1.204, {0, 0, 0}}, {1.3, {12, -1, 5}}};
    static virga_droplet_gpu droplets[PER_AIR];
    double max_speed_error = 0;
    splash_fixture_open(&f, NULL);
    for (uint32_t run = 0; run < AIRS; run++) {
        for (uint32_t i = 0; i < PER_AIR; i++)
            droplets[i] = random_droplet(run * PER_AIR + i);
        const double max_error = max_error_of_a_second(&airs[run], droplets, PER_AIR, &max_speed_error);
        printf("air of %.3f kg/m^3: off by %.2e of the way at most\n", airs[run].density, max_error);
        assert_true(max_error < 1e-3);
    }
    printf("velocity: off by %.2e m/s at most\n", max_speed_error);
    splash_fixture_close(&f);
}

/* 8 s, which is longer than a droplet is followed: its age and position start again every 2 s. */
static void fly_for_long(virga_droplet_gpu *droplets, uint32_t count)
{
    for (int part = 0; part < 4; part++) {
        splash_fixture_put(&f, droplets, count);
        for (int step = 0; step < 8; step++)
            splash_fixture_step(&f, 15);
        assert_int_equal(f.state->staying, count);
        memcpy(droplets, f.droplets, count * sizeof *droplets);
        for (uint32_t i = 0; i < count; i++) {
            droplets[i].age_s = 0;
            memset(droplets[i].position, 0, sizeof droplets[i].position);
        }
    }
}

/* Speed at which drag holds gravity, by bisection. */
static double balance(double diameter_m)
{
    const air still = {1.204, {0, 0, 0}};
    double low = 0, high = 100;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high), velocity[3] = {0, -middle, 0};
        double out[3];
        acceleration(&still, diameter_m, velocity, out);
        if (out[1] > 0)
            high = middle;
        else
            low = middle;
    }
    return low;
}

static void test_in_the_end_droplets_fall_at_the_speed_of_the_balance(void **state)
{
    (void)state;
    enum { COUNT = 64 };
    virga_droplet_gpu droplets[COUNT];
    const air still = {1.204, {0, 0, 0}};
    splash_fixture_open(&f, NULL);
    blow(&still);
    for (uint32_t i = 0; i < COUNT; i++) {
        droplets[i] = random_droplet(i);
        droplets[i].diameter_m = (float)(0.1e-3 * pow(30, i / (COUNT - 1.0)));
    }
    fly_for_long(droplets, COUNT);
    for (uint32_t i = 0; i < COUNT; i++) {
        const double speed = balance((double)droplets[i].diameter_m);
        assert_true(fabs((double)-f.droplets[i].velocity[1] - speed) < 1e-3 * speed);
        assert_true(fabs((double)f.droplets[i].velocity[0]) < 1e-2);
    }
    splash_fixture_close(&f);
}

/* With a share of the wind, where the ground holds it back. */
static void assert_carried(float share)
{
    enum { COUNT = 16 };
    virga_droplet_gpu droplets[COUNT];
    const air windy = {1.204, {6, 0, -2}};
    splash_fixture_open(&f, NULL);
    f.settings.wind_share = share;
    blow(&windy);
    for (uint32_t i = 0; i < COUNT; i++) {
        droplets[i] = random_droplet(i);
        droplets[i].diameter_m = (float)(0.1e-3 * pow(5, i / (COUNT - 1.0)));
    }
    fly_for_long(droplets, COUNT);
    for (uint32_t i = 0; i < COUNT; i++)
        for (int axis = 0; axis < 3; axis += 2)
            assert_float_equal(f.droplets[i].velocity[axis], (double)share * windy.wind[axis],
                               1e-3 * fabs(windy.wind[axis]));
    splash_fixture_close(&f);
}

static void test_in_the_end_wind_carries_droplets_along(void **state)
{
    (void)state;
    assert_carried(1);
    assert_carried(0.4f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ten_thousand_droplets_fly_by_the_law),
        cmocka_unit_test(test_in_the_end_droplets_fall_at_the_speed_of_the_balance),
        cmocka_unit_test(test_in_the_end_wind_carries_droplets_along),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
