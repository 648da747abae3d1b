/* test_settings.c - cookies, clamping and finite checks of settings, and the counted host memory. */
#include "check.h"
#include "core/memory.h"
#include "core/settings.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- settings ---- */

typedef struct captured {
    int lines;
    virga_log_id id;
    char text[VIRGA_LOG_LINE];
} captured;

static void capture(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)level;
    captured *line = user;
    line->lines++;
    line->id = id;
    snprintf(line->text, sizeof line->text, "%s", text);
}

static void cookies_differ(void **state)
{
    (void)state;
    static const char *const names[] = {
        "context_def",   "target_def",      "view",          "scene_def",       "rain_def",
        "ground_def",    "ground_settings", "splash_def",    "splash_settings", "glass_def",
        "fluid_def",     "glass_settings",  "lens_def",      "glass_shape",     "water_def",
        "rain_settings", "fluid_settings",  "lens_settings", "water_settings"};
    for (size_t a = 0; a < sizeof names / sizeof names[0]; a++) {
        const uint32_t cookie = virga_settings_cookie(names[a]);
        assert_true(cookie != 0 && cookie != UINT32_MAX); /* as uninitialised memory often is */
        for (size_t b = 0; b < a; b++)
            assert_true(cookie != virga_settings_cookie(names[b]));
    }
}

static void check_accepts_only_its_own(void **state)
{
    (void)state;
    captured line = {0};
    virga_log log = {capture, &line};
    const uint32_t good = virga_settings_cookie("rain_def"), other = virga_settings_cookie("view");
    assert_int_equal(virga_settings_check(&log, "rain_def", 64, 64, good), VIRGA_OK);
    assert_int_equal(line.lines, 0);
    assert_int_equal(virga_settings_check(&log, "rain_def", 64, 64, other), VIRGA_ERROR_INVALID);
    assert_int_equal(line.lines, 1);
    assert_int_equal(line.id, VIRGA_LOG_COOKIE);
    assert_non_null(strstr(line.text, "virga_default_rain_def"));
    assert_int_equal(virga_settings_check(&log, "rain_def", 60, 64, good), VIRGA_ERROR_INVALID);
    assert_int_equal(line.lines, 2);
    assert_int_equal(line.id, VIRGA_LOG_COOKIE);
    assert_non_null(strstr(line.text, "60"));
    assert_int_equal(virga_settings_check(NULL, "rain_def", 0, 64, 0), VIRGA_ERROR_INVALID);
}

static void clamp_moves_and_says_so(void **state)
{
    (void)state;
    captured line = {0};
    virga_log log = {capture, &line};
    bool changed = false;
    assert_near(virga_clamp_setting(&log, "rain.rate_mm_h", 200.0, 0.0, 200.0, &changed), 200.0, 0.0);
    assert_false(changed);
    assert_int_equal(line.lines, 0);
    assert_near(virga_clamp_setting(&log, "rain.rate_mm_h", 201.0, 0.0, 200.0, &changed), 200.0, 0.0);
    assert_true(changed);
    assert_int_equal(line.id, VIRGA_LOG_CLAMPED);
    assert_string_equal(line.text, "rain.rate_mm_h: 201 is outside [0; 200], 200 is used");
    assert_near(virga_clamp_setting_float(&log, "rain.soft_m", -1.0f, 0.5f, 1.0f, NULL), 0.5, 0.0);
    assert_near(virga_clamp_setting(&log, "rain.soft_m", NAN, 0.0, 1.0, NULL), 0.0, 0.0);
    changed = false;
    assert_int_equal(virga_clamp_setting_u32(&log, "rain.lighting.light_count", 17, 0, 16, &changed), 16);
    assert_int_equal(virga_clamp_setting_u32(&log, "rain.max_drops", 1, 1024, 4096, &changed), 1024);
    assert_true(changed);
    assert_int_equal(virga_clamp_setting_u32(&log, "rain.max_drops", 2000, 1024, 4096, NULL), 2000);
    assert_int_equal(line.lines, 5);
}

static void not_finite_is_refused(void **state)
{
    (void)state;
    captured line = {0};
    virga_log log = {capture, &line};
    float wind[3] = {1.0f, -2.0f, 3.0f};
    assert_int_equal(virga_settings_check_finite(&log, "rain.wind_m_s", wind, 3), VIRGA_OK);
    wind[2] = NAN;
    assert_int_equal(virga_settings_check_finite(&log, "rain.wind_m_s", wind, 3), VIRGA_ERROR_INVALID);
    assert_int_equal(line.id, VIRGA_LOG_ARGUMENT);
    assert_non_null(strstr(line.text, "rain.wind_m_s[2]"));
    double dt = INFINITY;
    assert_int_equal(virga_settings_check_finite_double(&log, "dt_s", &dt, 1), VIRGA_ERROR_INVALID);
    assert_string_equal(line.text, "dt_s: is inf, expected a finite number");
    dt = 1.0;
    assert_int_equal(virga_settings_check_finite_double(&log, "dt_s", &dt, 1), VIRGA_OK);
    assert_int_equal(line.lines, 2);
}

/* ---- host memory ---- */

/* A host's allocator that counts its calls and fails from call `fail_at` on (0: never). */
typedef struct counting_allocator {
    int allocs, frees, fail_at;
} counting_allocator;

static void *counting_alloc(void *user, size_t size)
{
    counting_allocator *counts = user;
    counts->allocs++;
    if (counts->fail_at != 0 && counts->allocs >= counts->fail_at) {
        return NULL;
    }
    void *block = aligned_alloc(16, (size + 15) & ~(size_t)15);
    if (block != NULL) {
        memset(block, 0xa5, size); /* a host does not hand out zeros */
    }
    return block;
}

static void counting_free(void *user, void *pointer)
{
    counting_allocator *counts = user;
    assert_non_null(pointer);
    counts->frees++;
    free(pointer);
}

static void blocks_are_zero_aligned_and_counted(void **state)
{
    (void)state;
    counting_allocator counts = {0};
    virga_host_memory callbacks = {&counts, counting_alloc, counting_free};
    virga_host_heap heap;
    assert_int_equal(virga_host_heap_init(&heap, &callbacks), VIRGA_OK);
    unsigned char *blocks[20];
    size_t total = 0;
    for (size_t i = 0; i < 20; i++) {
        blocks[i] = virga_alloc(&heap, i * 7);
        assert_non_null(blocks[i]);
        assert_int_equal((uintptr_t)blocks[i] % 16, 0);
        for (size_t k = 0; k < i * 7; k++) {
            assert_int_equal(blocks[i][k], 0);
        }
        memset(blocks[i], 0xff, i * 7);
        total += i * 7;
    }
    assert_int_equal(heap.live_count, 20);
    assert_int_equal(heap.live_bytes, total);
    for (size_t i = 0; i < 20; i++) {
        virga_free(&heap, blocks[i]);
    }
    virga_free(&heap, NULL);
    assert_int_equal(heap.live_count, 0);
    assert_int_equal(heap.live_bytes, 0);
    assert_int_equal(counts.allocs, 20);
    assert_int_equal(counts.frees, 20);
}

static void copies_are_equal(void **state)
{
    (void)state;
    virga_host_heap heap;
    assert_int_equal(virga_host_heap_init(&heap, NULL), VIRGA_OK);
    char *text = virga_strdup(&heap, "drizzle");
    assert_string_equal(text, "drizzle");
    assert_int_equal(heap.live_bytes, 8);
    double numbers[3] = {1.0, 2.0, 3.0};
    double *copy = virga_memdup(&heap, numbers, sizeof numbers);
    assert_memory_equal(copy, numbers, sizeof numbers);
    assert_null(virga_strdup(&heap, NULL));
    assert_null(virga_memdup(&heap, NULL, 8));
    virga_free(&heap, text);
    virga_free(&heap, copy);
    assert_int_equal(heap.live_count, 0);
    assert_int_equal(heap.live_bytes, 0);
}

static void failing_allocator_gives_null(void **state)
{
    (void)state;
    counting_allocator counts = {.fail_at = 2};
    virga_host_memory callbacks = {&counts, counting_alloc, counting_free};
    virga_host_heap heap;
    assert_int_equal(virga_host_heap_init(&heap, &callbacks), VIRGA_OK);
    void *first = virga_alloc(&heap, 100);
    assert_non_null(first);
    assert_null(virga_alloc(&heap, 100));
    assert_null(virga_strdup(&heap, "no room"));
    assert_null(virga_memdup(&heap, "no room", 4));
    assert_null(virga_alloc_array(&heap, 4, 4));
    assert_int_equal(heap.live_count, 1);
    assert_int_equal(heap.live_bytes, 100);
    virga_free(&heap, first);
    assert_int_equal(heap.live_count, 0);
}

static void absurd_sizes_never_reach_the_host(void **state)
{
    (void)state;
    counting_allocator counts = {0};
    virga_host_memory callbacks = {&counts, counting_alloc, counting_free};
    virga_host_heap heap;
    assert_int_equal(virga_host_heap_init(&heap, &callbacks), VIRGA_OK);
    assert_null(virga_alloc(&heap, SIZE_MAX));
    assert_null(virga_alloc(&heap, SIZE_MAX - 15));
    assert_null(virga_alloc_array(&heap, SIZE_MAX / 2 + 1, 2));
    assert_int_equal(counts.allocs, 0);
}

static void half_given_callbacks_are_refused(void **state)
{
    (void)state;
    virga_host_memory callbacks = {NULL, counting_alloc, NULL};
    virga_host_heap heap;
    assert_int_equal(virga_host_heap_init(&heap, &callbacks), VIRGA_ERROR_INVALID);
    callbacks = (virga_host_memory){NULL, NULL, counting_free};
    assert_int_equal(virga_host_heap_init(&heap, &callbacks), VIRGA_ERROR_INVALID);
    callbacks = (virga_host_memory){0};
    assert_int_equal(virga_host_heap_init(&heap, &callbacks), VIRGA_OK);
}

/* ---- positions, rotations, vectors ---- */

static void places_end_where_floats_are_coarse(void **state)
{
    (void)state;
    captured line = {0};
    const virga_log log = {capture, &line};
    const double edge[3] = {-VIRGA_MAX_COORDINATE_M, 0, VIRGA_MAX_COORDINATE_M}, beyond[3] = {0, 0, 1.0000001e9};
    const double endless[3] = {0, (double)INFINITY, 0};
    assert_int_equal(virga_settings_check_positions(&log, "camera_m", edge, 3), VIRGA_OK);
    assert_int_equal(line.lines, 0);
    assert_int_equal(virga_settings_check_positions(&log, "camera_m", beyond, 3), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_settings_check_positions(&log, "camera_m", endless, 3), VIRGA_ERROR_INVALID);
    assert_int_equal(line.lines, 2);
}

static void rotations_may_be_worn_but_not_bent(void **state)
{
    (void)state;
    captured line = {0};
    const virga_log log = {capture, &line};
    const float turned[9] = {0.6f, 0.8f, 0, -0.8f, 0.6f, 0, 0, 0, -1}; /* and mirrored */
    const float padded[12] = {1.005f, 0, 0, 9, 0, 1, 0.01f, 9, 0, 0, 1, 9};
    const float bent[9] = {1, 0, 0, 0.1f, 1, 0, 0, 0, 1}, long_[9] = {2, 0, 0, 0, 1, 0, 0, 0, 1};
    const float none[9] = {0}, nan_[9] = {1, 0, 0, 0, NAN, 0, 0, 0, 1};
    assert_int_equal(virga_settings_check_rotation(&log, "m", turned, 3), VIRGA_OK);
    assert_int_equal(virga_settings_check_rotation(&log, "m", padded, 4), VIRGA_OK);
    assert_int_equal(line.lines, 0);
    const float *const wrong[] = {bent, long_, none, nan_};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(virga_settings_check_rotation(&log, "m", wrong[i], 3), VIRGA_ERROR_INVALID);
        assert_int_equal(line.lines, i + 1);
    }
}

static void a_vector_is_clamped_with_one_line(void **state)
{
    (void)state;
    captured line = {0};
    const virga_log log = {capture, &line};
    float v[3] = {-5, 0.5f, 3e38f};
    bool changed = false;
    virga_clamp_vector(&log, "wind", v, 1, &changed);
    assert_true(changed && v[0] == -1 && v[1] == 0.5f && v[2] == 1);
    assert_int_equal(line.lines, 1);
    changed = false;
    virga_clamp_vector(&log, "wind", v, 1, &changed);
    assert_false(changed);
    assert_int_equal(line.lines, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cookies_differ),
        cmocka_unit_test(check_accepts_only_its_own),
        cmocka_unit_test(clamp_moves_and_says_so),
        cmocka_unit_test(not_finite_is_refused),
        cmocka_unit_test(blocks_are_zero_aligned_and_counted),
        cmocka_unit_test(copies_are_equal),
        cmocka_unit_test(failing_allocator_gives_null),
        cmocka_unit_test(absurd_sizes_never_reach_the_host),
        cmocka_unit_test(half_given_callbacks_are_refused),
        cmocka_unit_test(places_end_where_floats_are_coarse),
        cmocka_unit_test(rotations_may_be_worn_but_not_bent),
        cmocka_unit_test(a_vector_is_clamped_with_one_line),
    };
    return cmocka_run_group_tests_name("core/settings", tests, NULL, NULL);
}
