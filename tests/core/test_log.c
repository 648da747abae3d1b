/* test_log.c - names of results and ids, the version, and log lines. */
#include "check.h"
#include "core/log.h"

#include <stdio.h>
#include <string.h>

typedef struct captured {
    int lines;
    virga_log_level level;
    virga_log_id id;
    char text[1024];
} captured;

static void capture(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    captured *line = user;
    line->lines++;
    line->level = level;
    line->id = id;
    snprintf(line->text, sizeof line->text, "%s", text);
}

static void results_have_names(void **state)
{
    (void)state;
    assert_string_equal(virga_result_name(VIRGA_OK), "VIRGA_OK");
    assert_string_equal(virga_result_name(VIRGA_DEGRADED), "VIRGA_DEGRADED");
    for (int value = VIRGA_ERROR_VULKAN; value <= VIRGA_DEGRADED; value++) {
        assert_null(strstr(virga_result_name((virga_result)value), "UNKNOWN"));
    }
    assert_string_equal(virga_result_name((virga_result)-7), "VIRGA_UNKNOWN_RESULT");
    assert_string_equal(virga_result_name((virga_result)3), "VIRGA_UNKNOWN_RESULT");
}

static void ids_have_names_of_their_own(void **state)
{
    (void)state;
    assert_string_equal(virga_log_name(VIRGA_LOG_ARGUMENT), "argument");
    for (int a = VIRGA_LOG_ARGUMENT; a <= VIRGA_LOG_ENCODING; a++) {
        assert_string_not_equal(virga_log_name((virga_log_id)a), "unknown");
        for (int b = VIRGA_LOG_ARGUMENT; b < a; b++) {
            assert_string_not_equal(virga_log_name((virga_log_id)a), virga_log_name((virga_log_id)b));
        }
    }
    assert_string_equal(virga_log_name((virga_log_id)0), "unknown");
    assert_string_equal(virga_log_name((virga_log_id)1000), "unknown");
}

static void version_is_that_of_the_header(void **state)
{
    (void)state;
    char expected[64];
    snprintf(expected, sizeof expected, "%d.%d.%d", VIRGA_VERSION_MAJOR, VIRGA_VERSION_MINOR, VIRGA_VERSION_PATCH);
    assert_string_equal(virga_version(), expected);
}

static void line_arrives_whole(void **state)
{
    (void)state;
    captured line = {0};
    virga_log log = {capture, &line};
    virga_log_write(&log, VIRGA_LOG_WARNING, VIRGA_LOG_CLAMPED, "%s is %d", "drops", 7);
    assert_int_equal(line.lines, 1);
    assert_int_equal(line.level, VIRGA_LOG_WARNING);
    assert_int_equal(line.id, VIRGA_LOG_CLAMPED);
    assert_string_equal(line.text, "drops is 7");
}

static void long_line_is_cut_visibly(void **state)
{
    (void)state;
    char text[2000];
    memset(text, 'x', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    captured line = {0};
    virga_log log = {capture, &line};
    virga_log_write(&log, VIRGA_LOG_INFO, VIRGA_LOG_CREATED, "%s", text);
    assert_int_equal(strlen(line.text), VIRGA_LOG_LINE - 1);
    assert_string_equal(line.text + VIRGA_LOG_LINE - 5, "x...");
    virga_log_write(&log, VIRGA_LOG_INFO, VIRGA_LOG_CREATED, "%.511s", text); /* fits exactly */
    assert_string_equal(line.text + VIRGA_LOG_LINE - 5, "xxxx");
}

static void no_callback_is_silent(void **state)
{
    (void)state;
    virga_log log = {NULL, NULL};
    virga_log_write(&log, VIRGA_LOG_ERROR, VIRGA_LOG_ARGUMENT, "nobody hears %d", 1);
    virga_log_write(NULL, VIRGA_LOG_ERROR, VIRGA_LOG_ARGUMENT, "nobody hears %d", 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_have_names),
        cmocka_unit_test(ids_have_names_of_their_own),
        cmocka_unit_test(version_is_that_of_the_header),
        cmocka_unit_test(line_arrives_whole),
        cmocka_unit_test(long_line_is_cut_visibly),
        cmocka_unit_test(no_callback_is_silent),
    };
    return cmocka_run_group_tests_name("core/log", tests, NULL, NULL);
}
