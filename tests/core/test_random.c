/* test_random.c - the hash that C and GLSL share: known answers, evenness, independence, avalanche. All sums are over
 * fixed inputs, so a limit that holds once holds always; limits are where a fair coin would be one time in 10,000. */
#include "check.h"
#include "shared/random.h"

/* Known answers. A change of any makes every seed rain other drops; they hold for GLSL too. */
static void answers_are_known(void **state)
{
    (void)state;
    assert_int_equal(virga_hash1(0), 0x6bab1153u);
    assert_int_equal(virga_hash1(1), 0x835481e3u);
    assert_int_equal(virga_hash1(0xffffffffu), 0x42f710e3u);
    assert_int_equal(virga_hash2(1, 2), 0xbd12271eu);
    assert_int_equal(virga_hash2(2, 1), 0x07cdb5f7u);
    assert_int_equal(virga_hash3(1, 2, 3), 0xc4a2dd6du);
    assert_int_equal(virga_hash4(1, 2, 3, 4), 0x336b7cadu);
    assert_int_equal(virga_hash4(0xdeadbeefu, 0, 1000000, 86400), 0xeef089fcu);
}

static void unit_is_half_open(void **state)
{
    (void)state;
    assert_true(virga_unit(0) == 0.0f);
    assert_true(virga_unit(0xffu) == 0.0f);
    assert_true(virga_unit(0x100u) == 1.0f / 16777216.0f);
    assert_true(virga_unit(0x80000000u) == 0.5f);
    assert_true(virga_unit(0xffffffffu) == 1.0f - 1.0f / 16777216.0f);
}

/* Chi-square over 1024 cells has mean 1023 and deviation 45.2. */
enum { cells = 1024, draws = 1 << 20 };

static void assert_even(const uint32_t counts[cells])
{
    double expected = (double)draws / cells;
    double chi_square = 0.0;
    for (int i = 0; i < cells; i++) {
        double miss = counts[i] - expected;
        chi_square += miss * miss / expected;
    }
    assert_near(chi_square, cells - 1, 4.0 * sqrt(2.0 * (cells - 1)));
}

static void values_are_even(void **state)
{
    (void)state;
    uint32_t high[cells] = {0};
    uint32_t low[cells] = {0};
    uint32_t middle[cells] = {0};
    for (uint32_t i = 0; i < draws; i++) {
        uint32_t hash = virga_hash4(7, 3, i / 1000, i % 1000);
        high[hash >> 22]++;
        low[hash & 1023u]++;
        middle[(uint32_t)(virga_unit(virga_hash2(5, i)) * cells)]++;
    }
    assert_even(high);
    assert_even(low);
    assert_even(middle);
}

/* Pairs of neighbours fill a 32 by 32 board evenly, too. */
static void pairs_are_even(void **state)
{
    (void)state;
    uint32_t steps[cells] = {0};
    uint32_t ids[cells] = {0};
    for (uint32_t i = 0; i < draws; i++) {
        steps[(virga_hash3(1, 9, 2 * i) >> 27) * 32 + (virga_hash3(1, 9, 2 * i + 1) >> 27)]++;
        ids[(virga_hash3(1, 2 * i, 9) >> 27) * 32 + (virga_hash3(1, 2 * i + 1, 9) >> 27)]++;
    }
    assert_even(steps);
    assert_even(ids);
}

/* Correlation of two columns of `count` fair draws has deviation 1/sqrt(count). */
static double correlation(uint32_t (*first)(uint32_t), uint32_t (*second)(uint32_t), uint32_t count)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        sum += ((double)virga_unit(first(i)) - 0.5) * ((double)virga_unit(second(i)) - 0.5);
    }
    return sum / count * 12.0;
}

static uint32_t at(uint32_t i)
{
    return virga_hash2(3, i);
}

static uint32_t next(uint32_t i)
{
    return virga_hash2(3, i + 1);
}

static uint32_t other_id(uint32_t i)
{
    return virga_hash2(4, i);
}

static uint32_t other_seed(uint32_t i)
{
    return virga_hash3(1, 3, i);
}

static void neighbours_are_independent(void **state)
{
    (void)state;
    double limit = 4.0 / sqrt(draws);
    assert_near(correlation(at, next, draws), 0.0, limit);
    assert_near(correlation(at, other_id, draws), 0.0, limit);
    assert_near(correlation(at, other_seed, draws), 0.0, limit);
    assert_near(correlation(at, at, draws), 1.0, 0.01); /* the measure itself works */
}

/* Streams whose states differ by a small number must not be copies of each other, shifted by that number. */
static uint32_t near_state(uint32_t i)
{
    return virga_hash_absorb(0x12345678u, i + 5);
}

static uint32_t far_state(uint32_t i)
{
    return virga_hash_absorb(0x12345678u + 5u, i);
}

static void near_streams_are_no_shifted_copies(void **state)
{
    (void)state;
    uint32_t equal = 0;
    for (uint32_t i = 0; i < draws; i++) {
        equal += near_state(i) == far_state(i);
    }
    assert_true(equal < 5);
    assert_near(correlation(near_state, far_state, draws), 0.0, 4.0 / sqrt(draws));
}

static uint32_t flip(uint32_t trial, int word, uint32_t bit)
{
    uint32_t words[4] = {trial, trial * 3u + 1u, trial / 7u, 5u};
    words[word] ^= bit;
    return virga_hash4(words[0], words[1], words[2], words[3]);
}

/* A flipped bit of any word flips every bit of the hash half of the time. */
static void avalanche_is_half(void **state)
{
    (void)state;
    enum { trials = 4096 };
    for (int word = 0; word < 4; word++) {
        for (int in = 0; in < 32; in++) {
            uint32_t flipped[32] = {0};
            uint32_t all = 0;
            for (uint32_t trial = 0; trial < trials; trial++) {
                uint32_t difference = flip(trial, word, 0) ^ flip(trial, word, 1u << in);
                for (int out = 0; out < 32; out++) {
                    flipped[out] += difference >> out & 1u;
                    all += difference >> out & 1u;
                }
            }
            assert_near((double)all / trials, 16.0, 0.5);
            for (int out = 0; out < 32; out++) {
                assert_near((double)flipped[out] / trials, 0.5, 0.06);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_are_known),
        cmocka_unit_test(unit_is_half_open),
        cmocka_unit_test(values_are_even),
        cmocka_unit_test(pairs_are_even),
        cmocka_unit_test(neighbours_are_independent),
        cmocka_unit_test(near_streams_are_no_shifted_copies),
        cmocka_unit_test(avalanche_is_half),
    };
    return cmocka_run_group_tests_name("core/random", tests, NULL, NULL);
}
