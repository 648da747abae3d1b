/* Rain that drains to edges and falls as drops: against the law of a film in double precision, and counted to the
 * nanolitre. */
#include "splash_fixture.h"

#include <math.h>

#define SITES   256
#define TICK_S  (1.0 / 60)
#define RAIN    20.0f /* mm/h */
#define GRAVITY 9.80665

static splash_fixture f;
static virga_drip_site sites[SITES];

/* ---- edges that differ in everything */

static void choose_sites(void)
{
    for (uint32_t i = 0; i < SITES; i++) {
        const uint32_t hash = virga_hash2(5, i);
        const double part[4] = {(double)virga_unit(hash), (double)virga_unit(virga_hash1(hash)),
                                (double)virga_unit(virga_hash2(hash, 1)), (double)virga_unit(virga_hash2(hash, 2))};
        sites[i] = (virga_drip_site){.position_m = {1000 + 4 * part[0], 2.5 + part[1], -2000 + 4 * part[2]},
                                     .catch_m2 = (float)(0.003 * pow(30, part[3])),
                                     .width_m = (float)(0.02 + 0.04 * part[0]),
                                     .slope = (float)(0.02 + 0.5 * part[1])};
    }
}

static void begin_in(virga_splash_def def, bool wet)
{
    def.max_drips = SITES;
    splash_fixture_open(&f, &def);
    f.settings.drip_wet = wet;
    REQUIRE(virga_splash_set(f.splash, &f.settings) == VIRGA_OK);
    choose_sites();
    REQUIRE(virga_splash_set_drips(f.splash, sites, SITES) == VIRGA_OK);
    f.camera[0] = 1000, f.camera[2] = -2000;
    f.rain_mm_h = RAIN;
}

static void begin(bool wet, uint32_t max_handed)
{
    virga_splash_def def = splash_fixture_def();
    def.max_handed = max_handed;
    begin_in(def, wet);
}

static void play(uint32_t ticks, uint32_t per_step)
{
    for (uint32_t i = 0; i < ticks; i += per_step)
        splash_fixture_step(&f, per_step);
}

/* Water of all sites, in nl. */
static uint64_t on_surfaces(void)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < SITES; i++)
        sum += f.drips[i].film_nl + (uint64_t)f.drips[i].hang_nl;
    return sum;
}

/* nl/s over the edge from a film of n nl, see engine/splash/splash_drips.c. */
static double flow_of(const virga_drip_site *site, double film_nl)
{
    const double volume_m3 = film_nl * 1e-12, area = (double)site->catch_m2;
    return (double)site->width_m * GRAVITY * (double)site->slope / (3 * 1.0e-6) * pow(4 * volume_m3 / (3 * area), 3) *
           1e12;
}

static double inflow_of(const virga_drip_site *site)
{
    return (double)site->catch_m2 * (double)RAIN / 3600 * 1e9; /* nl/s */
}

/* ---- tests */

static void assert_counted(void)
{
    const uint64_t in = splash_fixture_count(&f, VIRGA_SPLASH_DRIP_IN),
                   out = splash_fixture_count(&f, VIRGA_SPLASH_DRIP_OUT);
    assert_int_equal(in, on_surfaces() + out + splash_fixture_count(&f, VIRGA_SPLASH_DRIP_LEFT));
    assert_int_equal(out, splash_fixture_count(&f, VIRGA_SPLASH_SPRAY_IN));
}

static void rain_that_drains_is_film_hanging_drops_and_drops_that_fell(void **state)
{
    (void)state;
    begin(true, 4096);
    for (uint32_t i = 0; i < 60; i++) {
        f.rain_mm_h = i % 20 < 10 ? 150 : 0;
        splash_fixture_step(&f, virga_hash2(3, i) % 9);
        assert_counted();
    }
    virga_splash_stats stats;
    virga_splash_stats_get(f.splash, &stats);
    assert_int_equal(stats.drip_rain_nl, splash_fixture_count(&f, VIRGA_SPLASH_DRIP_IN));
    assert_int_equal(stats.drip_nl, splash_fixture_count(&f, VIRGA_SPLASH_DRIP_OUT));
    assert_in_range(stats.drips, 1000, 100000);
    splash_fixture_close(&f);
}

/* Room for 16 drops in a step, where some hundred would fall. It is not always the same places that have it. */
static void drops_without_room_hang_until_there_is_some(void **state)
{
    (void)state;
    begin(true, 16);
    f.rain_mm_h = 150;
    splash_fixture_step(&f, 4); /* after this one there is room */
    for (uint32_t i = 0; i < 40; i++) {
        const uint64_t before = splash_fixture_count(&f, VIRGA_SPLASH_DRIPS);
        splash_fixture_step(&f, 4);
        assert_in_range(splash_fixture_count(&f, VIRGA_SPLASH_DRIPS) - before, 16, 16);
        assert_counted();
    }
    uint32_t dripped = 0;
    for (uint32_t i = 0; i < SITES; i++)
        dripped += f.drips[i].drops > 0;
    assert_in_range(dripped, SITES / 2, SITES);
    splash_fixture_close(&f);
}

/* ---- droplets everywhere */

#define CROWD_STEPS 24
#define CROWD_TICKS 4

/* Each tick brings more splashes than there is room for, and as their water takes all of the list of returns, nothing
 * leaves the air in a step's last ticks. From the second step on: the first one's drops say how much room is kept.
 * Without `crowd`: none. */
static void drip_among_splashes(bool crowd, uint64_t fell[CROWD_STEPS])
{
    enum { SPAWNS = 1000 };
    virga_splash_def def = splash_fixture_def();
    def.max_droplets = def.max_returned_droplets = def.max_handed = 4096;
    begin_in(def, true);
    for (uint32_t i = 0; i < CROWD_STEPS; i++) {
        const uint64_t before = i ? splash_fixture_count(&f, VIRGA_SPLASH_DRIPS) : 0;
        for (uint32_t k = 0; crowd && i && k < CROWD_TICKS * SPAWNS; k++)
            splash_fixture_spawn(&f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_WET)->tick = f.tick + k / SPAWNS;
        splash_fixture_step(&f, CROWD_TICKS);
        assert_counted();
        fell[i] = splash_fixture_count(&f, VIRGA_SPLASH_DRIPS) - before;
    }
    assert_int_equal(splash_fixture_count(&f, VIRGA_SPLASH_WITHOUT_DROPLETS) > 0, crowd);
    assert_int_equal(splash_fixture_count(&f, VIRGA_SPLASH_DRIPS_HELD), 0);
}

/* All drops fall when they are due, from the first step on: those of splashes go without. Drops of many places that
 * are not in step are at most as uneven as those of chance, of which the variance is the mean. */
static void a_pool_full_of_splashes_keeps_room_for_drips(void **state)
{
    (void)state;
    static virga_drip_gpu alone[SITES];
    uint64_t fell[2][CROWD_STEPS];
    double mean = 0, variance = 0;
    drip_among_splashes(false, fell[0]);
    memcpy(alone, f.drips, sizeof alone);
    splash_fixture_close(&f);
    drip_among_splashes(true, fell[1]);
    assert_memory_equal(fell[1], fell[0], sizeof fell[0]);
    assert_memory_equal(f.drips, alone, sizeof alone);
    splash_fixture_close(&f);
    for (uint32_t i = 0; i < CROWD_STEPS; i++)
        mean += (double)fell[1][i] / CROWD_STEPS;
    for (uint32_t i = 0; i < CROWD_STEPS; i++)
        variance += ((double)fell[1][i] - mean) * ((double)fell[1][i] - mean) / (CROWD_STEPS - 1);
    /* 4 standard deviations of a variance of 24 numbers: 4 sqrt(2 / 23) = 1.2. */
    assert_in_range(mean, 40, 400);
    assert_true(variance < 2.2 * mean);
}

static virga_handed_droplets_gpu handed_head(void)
{
    VkDeviceSize offset = 0;
    const VkCommandBuffer cmd = splash_fixture_begin(&f);
    effect_fixture_transfers(cmd);
    const virga_handed_droplets_gpu *head =
        effect_fixture_copy(cmd, f.splash->handed->buffer, sizeof *head, &f.download, &offset);
    splash_fixture_submit(&f);
    host_buffer_invalidate(&f.gpu.device, &f.download);
    return *head;
}

/* Water that hands over droplets leaves slots for as many drops as fell before, and four standard deviations more. */
static void water_leaves_room_for_drips(void **state)
{
    (void)state;
    begin(true, 128);
    for (uint32_t i = 0; i < 10; i++) {
        const uint64_t before = i ? splash_fixture_count(&f, VIRGA_SPLASH_DRIPS) : 0;
        splash_fixture_step(&f, 1 + i % 4);
        const uint32_t fell = (uint32_t)(splash_fixture_count(&f, VIRGA_SPLASH_DRIPS) - before), ticks = 1 + i % 4;
        const virga_handed_droplets_gpu head = handed_head();
        const uint32_t kept = (head.drips * ticks) + head.drips * ticks / 4 + 16;
        assert_int_equal(head.drips, (fell + ticks - 1) / ticks);
        assert_int_equal(head.capacity, kept < 128 ? 128 - kept : 0);
    }
    REQUIRE(virga_splash_set_drips(f.splash, NULL, 0) == VIRGA_OK);
    splash_fixture_step(&f, 1);
    assert_int_equal(handed_head().capacity, 128);
    splash_fixture_close(&f);
}

/* Not even where all have as much water. */
static void edges_do_not_begin_in_step(void **state)
{
    (void)state;
    begin(true, 4096);
    for (uint32_t i = 0; i < SITES; i++)
        sites[i].catch_m2 = 0.03f;
    REQUIRE(virga_splash_set_drips(f.splash, sites, SITES) == VIRGA_OK);
    const double mean = SITES * inflow_of(&sites[0]) * TICK_S / (523.6 * 68);
    for (uint32_t i = 0; i < 30; i++) {
        const uint64_t before = i ? splash_fixture_count(&f, VIRGA_SPLASH_DRIPS) : 0;
        splash_fixture_step(&f, 1);
        assert_true(fabs((double)(splash_fixture_count(&f, VIRGA_SPLASH_DRIPS) - before) - mean) < 4 * sqrt(mean));
    }
    splash_fixture_close(&f);
}

/* For a second spray that does not land has all slots, and ends in one tick. What could not fall in the meantime does
 * not fall at once then, but by and by, and not at the beginnings of ticks. */
static void late_drops_do_not_fall_as_a_curtain(void **state)
{
    enum { HELD_TICKS = 60, TICKS = 60 };
    (void)state;
    static virga_droplet_gpu spray[16384];
    double due = 0, fell = 0, part = 0, new_ones = 0;
    for (uint32_t i = 0; i < 16384; i++)
        spray[i] = (virga_droplet_gpu){.position = {0, 1000, 0},
                                       .age_s = 3 - (HELD_TICKS - 0.5f) * (float)TICK_S,
                                       .diameter_m = 1e-3f,
                                       .kind = VIRGA_DROPLET_SPRAY | VIRGA_DROPLET_FREE | VIRGA_DROPLET_ALIVE,
                                       .water_nl = 1};
    begin(true, 4096);
    splash_fixture_put(&f, spray, 16384);
    f.rain_mm_h = 100;
    for (uint32_t i = 0; i < SITES; i++)
        due += inflow_of(&sites[i]) * (double)f.rain_mm_h / (double)RAIN * TICK_S / (523.6 * 68);
    for (uint32_t i = 1; i < HELD_TICKS; i++)
        splash_fixture_step(&f, 1);
    assert_int_equal(splash_fixture_count(&f, VIRGA_SPLASH_DRIPS), 0);
    assert_true((double)splash_fixture_count(&f, VIRGA_SPLASH_DRIPS_HELD) > due * HELD_TICKS);
    for (uint32_t i = 0; i < TICKS; i++) {
        const uint64_t before = splash_fixture_count(&f, VIRGA_SPLASH_DRIPS);
        splash_fixture_step(&f, 1);
        assert_counted();
        const double now = (double)(splash_fixture_count(&f, VIRGA_SPLASH_DRIPS) - before);
        assert_true(fabs(now - 1.25 * due) < 5 * sqrt(1.25 * due));
        fell += now;
        for (uint32_t k = 0; k < f.state->staying; k++)
            if ((double)f.droplets[k].age_s - 0.15 < TICK_S) {
                part += ((double)f.droplets[k].age_s - 0.15) / TICK_S;
                new_ones += 1;
            }
    }
    assert_float_equal(fell / (1.25 * due * TICKS), 1, 0.04);
    assert_float_equal(part / new_ones, 0.5, 0.02);
    splash_fixture_close(&f);
}

/* From a dry surface, for a minute: Euler's method with the same ticks, in double precision. The passes round to whole
 * nanolitres at random. */
static void a_film_grows_and_drains_as_in_double_precision(void **state)
{
    (void)state;
    double film[SITES] = {0};
    begin(false, 4096);
    for (uint32_t tick = 0; tick < 3600; tick++)
        for (uint32_t i = 0; i < SITES; i++) {
            film[i] += (tick < 2400 ? inflow_of(&sites[i]) : 0) * TICK_S;
            film[i] -= fmin(flow_of(&sites[i], film[i]) * TICK_S, film[i]);
        }
    play(2400, 15);
    f.rain_mm_h = 0;
    play(1200, 15);
    for (uint32_t i = 0; i < SITES; i++)
        assert_float_equal((double)f.drips[i].film_nl / film[i], 1, 2e-3);
    splash_fixture_close(&f);
}

static void in_steady_rain_an_edge_drips_what_it_gets(void **state)
{
    (void)state;
    const double time_s = 20, largest_nl = 523.6 * 125;
    begin(true, 4096);
    play(1200, 15);
    for (uint32_t i = 0; i < SITES; i++) {
        const virga_drip_gpu *drip = &f.drips[i];
        const double steady = cbrt(inflow_of(&sites[i]) / flow_of(&sites[i], 1));
        assert_float_equal((double)drip->film_nl / steady, 1, 0.01);
        /* Drops of 3 to 5 mm have (3^4 - 5^4) / (4 (3 - 5)) = 68 mm^3 pi / 6 in the mean. */
        const double drops = inflow_of(&sites[i]) * time_s / (523.6 * 68);
        assert_true(fabs(drip->drops - drops) < 1 + 4 * sqrt(drops) * 0.45);
        assert_true((double)drip->hang_nl < largest_nl);
    }
    splash_fixture_close(&f);
}

/* Below a bridge the film that was there runs off, as after rain; half a shelter halves what comes. */
static void what_is_sheltered_gets_less_rain(void **state)
{
    (void)state;
    double film[SITES], caught = 0;
    begin(true, 4096);
    play(600, 15);
    for (uint32_t i = 0; i < SITES; i++) {
        film[i] = f.drips[i].film_nl;
        sites[i].shelter = 0.5f * (float)(i % 3);
    }
    REQUIRE(virga_splash_set_drips(f.splash, sites, SITES) == VIRGA_OK);
    const uint64_t before_nl = splash_fixture_count(&f, VIRGA_SPLASH_DRIP_IN);
    for (uint32_t tick = 0; tick < 600; tick++)
        for (uint32_t i = 0; i < SITES; i++) {
            const double came = inflow_of(&sites[i]) * (1 - (double)sites[i].shelter) * TICK_S;
            film[i] += came;
            caught += came;
            film[i] -= fmin(flow_of(&sites[i], film[i]) * TICK_S, film[i]);
        }
    play(600, 15);
    for (uint32_t i = 0; i < SITES; i++)
        assert_float_equal((double)f.drips[i].film_nl / film[i], 1, 5e-3);
    assert_float_equal((double)(splash_fixture_count(&f, VIRGA_SPLASH_DRIP_IN) - before_nl) / caught, 1, 1e-3);
    assert_counted();
    splash_fixture_close(&f);
}

/* Every drop in the air is below a site of its own, as far as it falls in its age, and has the speed of that. Air takes
 * less than 4 % of the speed in 0.25 s. */
static void drops_fall_from_their_edges(void **state)
{
    (void)state;
    begin(true, 4096);
    uint32_t found = 0;
    for (uint32_t step = 0; step < 16; step++) {
        splash_fixture_step(&f, 1 + step % 5);
        for (uint32_t i = 0; i < f.state->staying; i++) {
            const virga_droplet_gpu *drop = &f.droplets[i];
            const double fell_s = (double)drop->age_s - 0.15;
            double nearest = 1e9, below = 0;
            for (uint32_t k = 0; k < SITES; k++) {
                const double x = (double)drop->position[0] + f.splash->anchor_m[0] - sites[k].position_m[0],
                             z = (double)drop->position[2] + f.splash->anchor_m[2] - sites[k].position_m[2];
                if (hypot(x, z) < nearest) {
                    nearest = hypot(x, z);
                    below = sites[k].position_m[1] - (double)drop->position[1] - f.splash->anchor_m[1];
                }
            }
            REQUIRE(nearest < 2e-3);
            if (fell_s > 0.25)
                continue;
            assert_float_equal(below, 0.5 * (double)drop->diameter_m + 0.5 * GRAVITY * fell_s * fell_s, 0.02);
            assert_float_equal((double)-drop->velocity[1], GRAVITY * fell_s, 0.04 * GRAVITY * 0.25 + 1e-3);
            REQUIRE(drop->diameter_m >= 3e-3f && drop->diameter_m <= 5e-3f);
            found++;
        }
    }
    assert_true(found > 500);
    splash_fixture_close(&f);
}

static uint32_t hash_of_waters(uint32_t per_step)
{
    uint32_t hash = 0;
    begin(true, 4096);
    play(240, per_step);
    const uint32_t *words = (const uint32_t *)f.drips;
    for (uint32_t i = 0; i < SITES * sizeof *f.drips / 4; i++)
        hash = virga_hash2(hash, words[i]);
    splash_fixture_close(&f);
    return hash;
}

static void steps_of_any_length_give_the_same_bits(void **state)
{
    (void)state;
    const uint32_t one = hash_of_waters(1);
    assert_int_equal(hash_of_waters(1), one);
    assert_int_equal(hash_of_waters(4), one);
    assert_int_equal(hash_of_waters(15), one);
}

static void sites_may_move_and_become_fewer(void **state)
{
    (void)state;
    begin(true, 4096);
    play(16, 4);
    for (uint32_t i = 0; i < SITES; i++)
        sites[i].position_m[0] += 50;
    REQUIRE(virga_splash_set_drips(f.splash, sites, SITES / 2) == VIRGA_OK);
    const virga_drip_gpu last = f.drips[SITES - 1];
    play(60, 4);
    assert_counted();
    assert_memory_equal(&f.drips[SITES - 1], &last, sizeof last);
    uint32_t moved = 0;
    for (uint32_t i = 0; i < f.state->staying; i++)
        moved += (double)f.droplets[i].position[0] + f.splash->anchor_m[0] > 1040;
    assert_true(moved > 20);
    splash_fixture_close(&f);
}

/* Gives about a quarter of the indices to places 50 m away, with numbers of 0 to 7. Returns the nl that are gone. */
static uint64_t give_indices_to_others(uint32_t step)
{
    uint64_t gone_nl = 0;
    for (uint32_t i = 0; i < SITES; i++) {
        const uint32_t hash = virga_hash2(step, i);
        if (hash % 4)
            continue;
        sites[i].place = virga_hash1(hash) % 8;
        sites[i].position_m[0] = 1050 + 4 * (double)virga_unit(hash);
        sites[i].catch_m2 = 0.003f + 0.1f * virga_unit(virga_hash1(hash));
        gone_nl += sites[i].place + 1 != f.drips[i].owner ? f.drips[i].film_nl + (uint64_t)f.drips[i].hang_nl : 0;
    }
    REQUIRE(virga_splash_set_drips(f.splash, sites, SITES) == VIRGA_OK);
    return gone_nl;
}

static void water_of_places_that_lose_their_index_is_counted(void **state)
{
    (void)state;
    uint64_t left_nl = 0;
    begin(true, 4096);
    splash_fixture_step(&f, 4);
    for (uint32_t step = 0; step < 60; step++) {
        left_nl += give_indices_to_others(step);
        f.rain_mm_h = step % 20 < 10 ? 150 : 0;
        splash_fixture_step(&f, 1 + step % 8);
        assert_counted();
        assert_int_equal(splash_fixture_count(&f, VIRGA_SPLASH_DRIP_LEFT), left_nl);
    }
    assert_true(left_nl > 1000000);
    virga_splash_stats stats;
    virga_splash_stats_get(f.splash, &stats);
    assert_int_equal(stats.drip_left_nl, left_nl);
    splash_fixture_close(&f);
}

/* When the rain is over and another place, which is dry, gets an index, nothing falls there; others drip on, bit by bit
 * as if nothing had changed. With rain it begins with the film of that rain. */
static void another_place_begins_without_the_water_of_the_one_before(void **state)
{
    (void)state;
    virga_drip_gpu alone[SITES];
    for (uint32_t changed = 0;; changed++) {
        begin(true, 4096);
        play(60, 15);
        f.rain_mm_h = 0;
        for (uint32_t i = 0; i < SITES && changed; i += 2) {
            sites[i].place = 7 + i;
            sites[i].position_m[0] += 50;
        }
        REQUIRE(virga_splash_set_drips(f.splash, sites, SITES) == VIRGA_OK);
        play(60, 4);
        assert_counted();
        if (changed)
            break;
        memcpy(alone, f.drips, sizeof alone);
        splash_fixture_close(&f);
    }
    for (uint32_t i = 0; i < SITES; i += 2) {
        assert_true(alone[i].film_nl > 1000);
        assert_int_equal(f.drips[i].film_nl + f.drips[i].hang_nl + f.drips[i].drops, 0);
        assert_memory_equal(&f.drips[i + 1], &alone[i + 1], sizeof alone[0]);
    }
    for (uint32_t i = 0; i < f.state->staying; i++)
        assert_true((double)f.droplets[i].position[0] + f.splash->anchor_m[0] < 1040);
    f.rain_mm_h = RAIN;
    for (uint32_t i = 0; i < SITES; i++)
        sites[i].place = 1;
    REQUIRE(virga_splash_set_drips(f.splash, sites, SITES) == VIRGA_OK);
    splash_fixture_step(&f, 1);
    for (uint32_t i = 0; i < SITES; i++) {
        const double steady = cbrt(inflow_of(&sites[i]) / flow_of(&sites[i], 1));
        assert_float_equal((double)f.drips[i].film_nl / steady, 1, 0.01);
    }
    splash_fixture_close(&f);
}

/* Edges of a car at 30 m/s, the speed of which is theirs: while the air has hardly slowed them a drop is below its edge
 * as if both stood, however long a step is. */
static void an_edge_that_moves_takes_its_drops_along(void **state)
{
    (void)state;
    uint32_t found = 0;
    begin(true, 4096);
    f.rain_mm_h = 150;
    for (uint32_t step = 0, ticks = 0; step < 40; step++) {
        ticks += 1 + step % 5;
        choose_sites();
        for (uint32_t i = 0; i < SITES; i++) {
            sites[i].velocity_m_s[0] = 30;
            sites[i].position_m[0] += 30 * ticks * TICK_S;
            sites[i].moves = true;
        }
        REQUIRE(virga_splash_set_drips(f.splash, sites, SITES) == VIRGA_OK);
        splash_fixture_step(&f, 1 + step % 5);
        assert_counted();
        for (uint32_t i = 0; i < f.state->staying; i++) {
            const virga_droplet_gpu *drop = &f.droplets[i];
            const double fell_s = (double)drop->age_s - 0.15;
            double nearest = 1e9;
            for (uint32_t k = 0; k < SITES && fell_s < TICK_S; k++)
                nearest =
                    fmin(nearest, hypot((double)drop->position[0] + f.splash->anchor_m[0] - sites[k].position_m[0],
                                        (double)drop->position[2] + f.splash->anchor_m[2] - sites[k].position_m[2]));
            if (fell_s >= TICK_S)
                continue;
            /* Drag: 3/4 cd 1.2 / 1000 v^2 / d, at most 0.6 g 900 / 3 mm = 160 m/s^2: 2.7 m/s and 22 mm in a tick. */
            REQUIRE(nearest < 0.025);
            assert_float_equal((double)drop->velocity[0], 30, 3);
            found++;
        }
    }
    assert_true(found > 200);
    splash_fixture_close(&f);
}

/* A pipe: drops leave with its velocity, eight as one, and all water is counted. */
static void a_pipe_pours_with_its_velocity(void **state)
{
    (void)state;
    const float velocity[3] = {0.3f, -0.5f, 1.5f};
    begin(true, 4096);
    for (uint32_t i = 0; i < SITES; i++) {
        sites[i].catch_m2 = 1;
        sites[i].drops = i % 2 ? 8 : 0;
        memcpy(sites[i].velocity_m_s, velocity, sizeof velocity);
    }
    REQUIRE(virga_splash_set_drips(f.splash, sites, SITES) == VIRGA_OK);
    uint32_t as_one = 0, single = 0;
    for (uint32_t step = 0; step < 20; step++) {
        splash_fixture_step(&f, 1 + step % 3);
        assert_counted();
        for (uint32_t i = 0; i < f.state->staying; i++) {
            const virga_droplet_gpu *drop = &f.droplets[i];
            const double flown_s = (double)drop->age_s - 0.15, mm = 1e3 * (double)drop->diameter_m;
            const double drops = drop->water_nl / (M_PI / 6 * 1e3 * mm * mm * mm);
            if (flown_s > 0.1)
                continue;
            /* Air takes less than 4 % of 2 m/s in 0.1 s. */
            assert_float_equal((double)drop->velocity[0], (double)velocity[0], 0.03);
            assert_float_equal((double)drop->velocity[1], (double)velocity[1] - GRAVITY * flown_s, 0.08);
            assert_float_equal((double)drop->velocity[2], (double)velocity[2], 0.08);
            assert_true(fabs(drops - 8) < 0.01 || fabs(drops - 1) < 0.01);
            as_one += drops > 4;
            single += drops < 4;
        }
    }
    assert_true(as_one > 500 && single > 500);
    splash_fixture_close(&f);
}

static void wrong_sites_are_refused(void **state)
{
    (void)state;
    begin(true, 4096);
    virga_splash *splash = f.splash;
    assert_int_equal(virga_splash_set_drips(NULL, sites, 1), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_splash_set_drips(splash, NULL, 1), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_splash_set_drips(splash, sites, SITES + 1), VIRGA_ERROR_INVALID);
    sites[3].catch_m2 = 0;
    assert_int_equal(virga_splash_set_drips(splash, sites, SITES), VIRGA_ERROR_INVALID);
    sites[3].catch_m2 = NAN;
    assert_int_equal(virga_splash_set_drips(splash, sites, SITES), VIRGA_ERROR_INVALID);
    choose_sites();
    sites[3].drops = 65;
    assert_int_equal(virga_splash_set_drips(splash, sites, SITES), VIRGA_ERROR_INVALID);
    choose_sites();
    sites[3].shelter = 1.1f;
    assert_int_equal(virga_splash_set_drips(splash, sites, SITES), VIRGA_ERROR_INVALID);
    choose_sites();
    sites[3].velocity_m_s[2] = -21;
    assert_int_equal(virga_splash_set_drips(splash, sites, SITES), VIRGA_ERROR_INVALID);
    sites[3].moves = true;
    assert_int_equal(virga_splash_set_drips(splash, sites, SITES), VIRGA_OK);
    sites[3].velocity_m_s[2] = -101;
    assert_int_equal(virga_splash_set_drips(splash, sites, SITES), VIRGA_ERROR_INVALID);
    choose_sites();
    sites[3].place = UINT32_MAX;
    assert_int_equal(virga_splash_set_drips(splash, sites, SITES), VIRGA_ERROR_INVALID);
    choose_sites();
    sites[3].position_m[1] = INFINITY;
    assert_int_equal(virga_splash_set_drips(splash, sites, SITES), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_splash_set_drips(splash, NULL, 0), VIRGA_OK);
    splash_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rain_that_drains_is_film_hanging_drops_and_drops_that_fell),
        cmocka_unit_test(drops_without_room_hang_until_there_is_some),
        cmocka_unit_test(a_pool_full_of_splashes_keeps_room_for_drips),
        cmocka_unit_test(water_leaves_room_for_drips),
        cmocka_unit_test(edges_do_not_begin_in_step),
        cmocka_unit_test(late_drops_do_not_fall_as_a_curtain),
        cmocka_unit_test(a_film_grows_and_drains_as_in_double_precision),
        cmocka_unit_test(in_steady_rain_an_edge_drips_what_it_gets),
        cmocka_unit_test(what_is_sheltered_gets_less_rain),
        cmocka_unit_test(drops_fall_from_their_edges),
        cmocka_unit_test(steps_of_any_length_give_the_same_bits),
        cmocka_unit_test(sites_may_move_and_become_fewer),
        cmocka_unit_test(water_of_places_that_lose_their_index_is_counted),
        cmocka_unit_test(another_place_begins_without_the_water_of_the_one_before),
        cmocka_unit_test(an_edge_that_moves_takes_its_drops_along),
        cmocka_unit_test(a_pipe_pours_with_its_velocity),
        cmocka_unit_test(wrong_sites_are_refused),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
