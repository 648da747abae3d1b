/* test_jsonl.c - JSON lines: values, escapes, whole lines, appending, failures. */
#include "check_io.h"
#include "jsonl.h"

#include <locale.h>
#include <math.h>

static void assert_text(const char *path, const char *expected)
{
    size_t size;
    char *text = get_file(path, &size);
    assert_string_equal(text, expected);
    free(text);
}

static void start(jsonl *file, jsonl_mode mode)
{
    if (!jsonl_open(file, in_folder("s.jsonl"), mode, error, sizeof error))
        fail_msg("%s", error);
}

static void end_line(jsonl *file)
{
    if (!jsonl_end_line(file, error, sizeof error))
        fail_msg("%s", error);
}

static void one_number_line(jsonl *file, double value)
{
    jsonl_begin(file);
    jsonl_number(file, "n", value);
    end_line(file);
}

static void nested_values_are_laid_out(void **state)
{
    (void)state;
    jsonl file;
    start(&file, JSONL_TRUNCATE);
    jsonl_begin(&file);
    jsonl_uint64(&file, "frame", 3);
    jsonl_begin_object(&file, "ms");
    jsonl_number(&file, "step", 1.25);
    jsonl_boolean(&file, "gpu", true);
    jsonl_end(&file);
    jsonl_begin_array(&file, "counts");
    jsonl_uint64(&file, NULL, 1);
    jsonl_begin_array(&file, NULL);
    jsonl_end(&file);
    jsonl_string(&file, NULL, NULL);
    end_line(&file); /* closes the array and the object */
    jsonl_close(&file);
    assert_text(in_folder("s.jsonl"), "{\"frame\":3,\"ms\":{\"step\":1.25,\"gpu\":true},\"counts\":[1,[],null]}\n");
}

static void lines_of_another_file_are_added_as_they_are(void **state)
{
    static const char line[] = "{\"frame\":7,\"counts\":[1,[],null]}";
    (void)state;
    jsonl file;
    start(&file, JSONL_TRUNCATE);
    one_number_line(&file, 1);
    jsonl_begin(&file); /* an unfinished line is discarded */
    if (!jsonl_add_line(&file, line, strlen(line), error, sizeof error))
        fail_msg("%s", error);
    one_number_line(&file, 2);
    jsonl_close(&file);
    assert_text(in_folder("s.jsonl"), "{\"n\":1}\n{\"frame\":7,\"counts\":[1,[],null]}\n{\"n\":2}\n");
}

static void text_is_escaped(void **state)
{
    (void)state;
    jsonl file;
    start(&file, JSONL_TRUNCATE);
    jsonl_begin(&file);
    jsonl_string(&file, "a\"b", "q\" b\\ \b\f\n\r\t \x01\x1f /");
    end_line(&file);
    jsonl_close(&file);
    assert_text(in_folder("s.jsonl"), "{\"a\\\"b\":\"q\\\" b\\\\ \\b\\f\\n\\r\\t \\u0001\\u001f /\"}\n");
}

static void broken_utf8_is_replaced(void **state)
{
    (void)state;
    jsonl file;
    start(&file, JSONL_TRUNCATE);
    jsonl_begin(&file);
    /* whole: 2, 3 and 4 bytes; then a stray byte, an overlong slash, half a pair, too large, cut short */
    jsonl_string(&file, "s", "\xC3\xA9\xE2\x82\xAC\xF0\x9F\x8C\xA7|\x80|\xC0\xAF|\xED\xA0\x80|\xF5|\xE2\x82");
    end_line(&file);
    jsonl_close(&file);
#define BAD "\xEF\xBF\xBD"
    assert_text(in_folder("s.jsonl"), "{\"s\":\"\xC3\xA9\xE2\x82\xAC\xF0\x9F\x8C\xA7|" BAD "|" BAD BAD "|" BAD BAD BAD
                                      "|" BAD "|" BAD BAD "\"}\n");
}

static void numbers_read_back_the_same(void **state)
{
    (void)state;
    static const double values[] = {0.1, 1.0 / 3.0, 1e300, 5e-324, -0.25, 123456789.0, 1e21, 0.30000000000000004};
    jsonl file;
    start(&file, JSONL_TRUNCATE);
    for (size_t i = 0; i < COUNT(values); i++)
        one_number_line(&file, values[i]);
    jsonl_close(&file);
    size_t size;
    char *text = get_file(in_folder("s.jsonl"), &size), *at = text;
    for (size_t i = 0; i < COUNT(values); i++, at = strchr(at, '\n') + 1)
        assert_true(strtod(at + 5, NULL) == values[i]);
    assert_memory_equal(text, "{\"n\":0.1}\n", 10);
    free(text);
}

static void what_is_no_number_is_null(void **state)
{
    (void)state;
    jsonl file;
    start(&file, JSONL_TRUNCATE);
    one_number_line(&file, NAN);
    one_number_line(&file, -INFINITY);
    jsonl_close(&file);
    assert_text(in_folder("s.jsonl"), "{\"n\":null}\n{\"n\":null}\n");
}

static void whole_numbers_keep_every_digit(void **state)
{
    (void)state;
    jsonl file;
    start(&file, JSONL_TRUNCATE);
    jsonl_begin(&file);
    jsonl_uint64(&file, "n", UINT64_MAX);
    end_line(&file);
    jsonl_close(&file);
    assert_text(in_folder("s.jsonl"), "{\"n\":18446744073709551615}\n");
}

static void the_locale_does_not_matter(void **state)
{
    (void)state;
    static const char *const names[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "nl_NL.UTF-8"};
    size_t i = 0;
    while (i < COUNT(names) && !setlocale(LC_ALL, names[i]))
        i++;
    if (i == COUNT(names))
        skip();
    jsonl file;
    start(&file, JSONL_TRUNCATE);
    one_number_line(&file, 1.5);
    jsonl_close(&file);
    setlocale(LC_ALL, "C");
    assert_text(in_folder("s.jsonl"), "{\"n\":1.5}\n");
}

static void a_line_is_in_the_file_when_it_ends(void **state)
{
    (void)state;
    jsonl file;
    start(&file, JSONL_TRUNCATE);
    one_number_line(&file, 1);
    jsonl_begin(&file);
    jsonl_number(&file, "n", 2);
    assert_text(in_folder("s.jsonl"), "{\"n\":1}\n");
    end_line(&file);
    assert_text(in_folder("s.jsonl"), "{\"n\":1}\n{\"n\":2}\n");
    jsonl_close(&file);
}

static void a_new_line_drops_an_unfinished_one(void **state)
{
    (void)state;
    jsonl file;
    start(&file, JSONL_TRUNCATE);
    jsonl_begin(&file);
    jsonl_begin_array(&file, "lost");
    one_number_line(&file, 1);
    jsonl_close(&file);
    assert_text(in_folder("s.jsonl"), "{\"n\":1}\n");
}

static void appending_cuts_half_a_line(void **state)
{
    (void)state;
    jsonl file;
    put_file(in_folder("s.jsonl"), "{\"n\":1}\n{\"n\":", 13);
    start(&file, JSONL_APPEND);
    one_number_line(&file, 2);
    jsonl_close(&file);
    assert_text(in_folder("s.jsonl"), "{\"n\":1}\n{\"n\":2}\n");
}

static void appending_cuts_a_long_half_line(void **state)
{
    (void)state;
    jsonl file;
    char text[10000];
    memset(text, 'x', sizeof text);
    text[0] = '{', text[1] = '}', text[2] = '\n';
    put_file(in_folder("s.jsonl"), text, sizeof text);
    start(&file, JSONL_APPEND);
    one_number_line(&file, 2);
    jsonl_close(&file);
    assert_text(in_folder("s.jsonl"), "{}\n{\"n\":2}\n");
}

static void truncating_starts_anew(void **state)
{
    (void)state;
    jsonl file;
    put_file(in_folder("s.jsonl"), "old\n", 4);
    start(&file, JSONL_TRUNCATE);
    jsonl_close(&file);
    assert_text(in_folder("s.jsonl"), "");
}

static void a_full_disk_is_one_line(void **state)
{
    (void)state;
    jsonl file;
    assert_true(jsonl_open(&file, "/dev/full", JSONL_APPEND, error, sizeof error));
    jsonl_begin(&file);
    assert_false(jsonl_end_line(&file, error, sizeof error));
    assert_error("/dev/full", "No space left on device");
    jsonl_close(&file);
}

static void a_line_that_does_not_fit_leaves_nothing(void **state)
{
    (void)state;
    jsonl file;
    start(&file, JSONL_TRUNCATE);
    one_number_line(&file, 1);
    limit_files(12); /* the next line would end at byte 16 */
    jsonl_begin(&file);
    jsonl_number(&file, "n", 2);
    bool ok = jsonl_end_line(&file, error, sizeof error);
    unlimit_files();
    assert_false(ok);
    assert_error("s.jsonl", "cannot write");
    assert_text(in_folder("s.jsonl"), "{\"n\":1}\n");
    one_number_line(&file, 3);
    jsonl_close(&file);
    assert_text(in_folder("s.jsonl"), "{\"n\":1}\n{\"n\":3}\n");
}

static void a_missing_folder_is_one_line(void **state)
{
    (void)state;
    jsonl file;
    assert_false(jsonl_open(&file, in_folder("none/s.jsonl"), JSONL_TRUNCATE, error, sizeof error));
    assert_error("none/s.jsonl", "No such file or directory");
}

static void too_deep_is_an_error(void **state)
{
    (void)state;
    jsonl file;
    start(&file, JSONL_TRUNCATE);
    jsonl_begin(&file);
    for (int i = 0; i < JSONL_MAX_DEPTH; i++)
        jsonl_begin_array(&file, i ? NULL : "a");
    assert_false(jsonl_end_line(&file, error, sizeof error));
    assert_error("s.jsonl", "cannot write");
    jsonl_close(&file);
    assert_text(in_folder("s.jsonl"), "");
}

static bool holds_keep(void *user, const char *line)
{
    ++*(int *)user;
    return strstr(line, "keep");
}

static void assert_filtered(const char *text, size_t size, const char *expected, int asked)
{
    int lines = 0;
    put_file(in_folder("s.jsonl"), text, size);
    if (!jsonl_filter(in_folder("s.jsonl"), holds_keep, &lines, error, sizeof error))
        fail_msg("%s", error);
    assert_text(in_folder("s.jsonl"), expected);
    assert_int_equal(lines, asked);
    assert_int_equal(folder_entries(false), 1);
}

static void a_filter_leaves_what_is_wanted(void **state)
{
    (void)state;
    static const char zeros[] = "keep 1\nkeep\0 2\nkeep 3\n";
    assert_filtered("drop\nkeep 1\ndrop\n\nkeep 2\n", 26, "keep 1\nkeep 2\n", 5);
    assert_filtered("keep 1\nkeep 2\nkeep hal", 22, "keep 1\nkeep 2\n", 2);
    assert_filtered(zeros, sizeof zeros - 1, "keep 1\nkeep 3\n", 2);
    assert_filtered("drop\n", 5, "", 1);
    assert_filtered("", 0, "", 0);
}

static void a_filter_that_keeps_all_leaves_the_file_alone(void **state)
{
    (void)state;
    int lines = 0;
    struct stat before, after;
    put_file(in_folder("s.jsonl"), "keep\nkeep\n", 10);
    assert_int_equal(stat(in_folder("s.jsonl"), &before), 0);
    assert_true(jsonl_filter(in_folder("s.jsonl"), holds_keep, &lines, error, sizeof error));
    assert_int_equal(stat(in_folder("s.jsonl"), &after), 0);
    assert_int_equal(after.st_ino, before.st_ino);
    assert_true(jsonl_filter(in_folder("none.jsonl"), holds_keep, &lines, error, sizeof error));
    assert_int_equal(folder_entries(false), 1);
}

static void a_filter_that_can_not_write_changes_nothing(void **state)
{
    (void)state;
    int lines = 0;
    put_file(in_folder("s.jsonl"), "drop\nkeep 1\nkeep 2\n", 19);
    limit_files(10);
    bool ok = jsonl_filter(in_folder("s.jsonl"), holds_keep, &lines, error, sizeof error);
    unlimit_files();
    assert_false(ok);
    assert_error("s.jsonl", "cannot write");
    assert_text(in_folder("s.jsonl"), "drop\nkeep 1\nkeep 2\n");
    assert_int_equal(folder_entries(false), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(nested_values_are_laid_out),
        TEST_IN_FOLDER(lines_of_another_file_are_added_as_they_are),
        TEST_IN_FOLDER(text_is_escaped),
        TEST_IN_FOLDER(broken_utf8_is_replaced),
        TEST_IN_FOLDER(numbers_read_back_the_same),
        TEST_IN_FOLDER(what_is_no_number_is_null),
        TEST_IN_FOLDER(whole_numbers_keep_every_digit),
        TEST_IN_FOLDER(the_locale_does_not_matter),
        TEST_IN_FOLDER(a_line_is_in_the_file_when_it_ends),
        TEST_IN_FOLDER(a_new_line_drops_an_unfinished_one),
        TEST_IN_FOLDER(appending_cuts_half_a_line),
        TEST_IN_FOLDER(appending_cuts_a_long_half_line),
        TEST_IN_FOLDER(truncating_starts_anew),
        TEST_IN_FOLDER(a_full_disk_is_one_line),
        TEST_IN_FOLDER(a_line_that_does_not_fit_leaves_nothing),
        TEST_IN_FOLDER(a_missing_folder_is_one_line),
        TEST_IN_FOLDER(too_deep_is_an_error),
        TEST_IN_FOLDER(a_filter_leaves_what_is_wanted),
        TEST_IN_FOLDER(a_filter_that_keeps_all_leaves_the_file_alone),
        TEST_IN_FOLDER(a_filter_that_can_not_write_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
