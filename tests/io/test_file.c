/* test_file.c - temporary names, and what becomes of those that a killed program leaves. */
#include "check_io.h"
#include "file.h"

#include <fcntl.h>
#include <sys/wait.h>

static void start(file_writer *file, const char *path)
{
    if (!file_start(file, path, error, sizeof error))
        fail_msg("%s", error);
}

static void a_file_is_there_when_it_is_whole(void **state)
{
    (void)state;
    file_writer file;
    start(&file, in_folder("a"));
    assert_true(file_write(&file, "text", 4));
    assert_int_equal(access(in_folder("a"), F_OK), -1);
    assert_true(file_finish(&file, error, sizeof error));
    assert_int_equal(access(in_folder("a"), F_OK), 0);
    assert_int_equal(folder_entries(false), 1);
}

static void what_is_being_written_is_not_cleaned(void **state)
{
    (void)state;
    file_writer file;
    start(&file, in_folder("a"));
    assert_int_equal(file_clean(folder), 0);
    assert_true(file_write(&file, "text", 4));
    if (!file_finish(&file, error, sizeof error))
        fail_msg("%s", error);
    assert_int_equal(file_clean(folder), 0);
    assert_int_equal(folder_entries(false), 1);
}

static void what_a_killed_program_leaves_is_cleaned(void **state)
{
    (void)state;
    pid_t child = fork();
    if (child == 0) {
        file_writer file;
        if (file_start(&file, in_folder("a"), error, sizeof error) && file_write(&file, "te", 2))
            raise(SIGKILL);
        _exit(1);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status));
    assert_int_equal(folder_entries(false), 1);
    assert_int_equal(file_clean(folder), 1);
    assert_int_equal(folder_entries(false), 0);
}

static void other_names_are_not_cleaned(void **state)
{
    (void)state;
    static const char *const names[] = {"a.tmp",         ".virga.tmp",     ".virga-1-.tmp", ".virga-1-2.tmp.exr",
                                        "virga-1-2.tmp", ".virga-x-2.tmp", ".virga-1-2",    ".virga-notes.tmp"};
    for (size_t i = 0; i < COUNT(names); i++)
        put_file(in_folder(names[i]), "text", 4);
    assert_int_equal(file_clean(folder), 0);
    assert_int_equal(folder_entries(false), COUNT(names));
}

static void links_and_folders_are_not_cleaned(void **state)
{
    (void)state;
    put_file(in_folder("a"), "text", 4);
    assert_int_equal(symlink("a", in_folder(".virga-1-2.tmp")), 0);
    assert_int_equal(mkdir(in_folder(".virga-1-3.tmp"), 0777), 0);
    assert_int_equal(file_clean(folder), 0);
    assert_int_equal(folder_entries(false), 3);
    assert_int_equal(rmdir(in_folder(".virga-1-3.tmp")), 0);
}

static void a_missing_folder_has_nothing_to_clean(void **state)
{
    (void)state;
    assert_int_equal(file_clean(in_folder("none")), 0);
}

/* One process cleans without a pause while another starts and finishes files: none may be lost. */
static void cleaning_and_writing_at_once_lose_nothing(void **state)
{
    (void)state;
    pid_t child = fork();
    if (child == 0)
        for (;;)
            file_clean(folder);
    int lost = 0;
    for (int i = 0; i < 1000; i++) {
        file_writer file;
        if (!file_start(&file, in_folder("a"), error, sizeof error) || !file_write(&file, "text", 4) ||
            !file_finish(&file, error, sizeof error))
            lost++;
    }
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    if (lost)
        fail_msg("%d of 1000 files: %s", lost, error);
    assert_int_equal(folder_entries(false), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(a_file_is_there_when_it_is_whole),
        TEST_IN_FOLDER(what_is_being_written_is_not_cleaned),
        TEST_IN_FOLDER(what_a_killed_program_leaves_is_cleaned),
        TEST_IN_FOLDER(other_names_are_not_cleaned),
        TEST_IN_FOLDER(links_and_folders_are_not_cleaned),
        TEST_IN_FOLDER(a_missing_folder_has_nothing_to_clean),
        TEST_IN_FOLDER(cleaning_and_writing_at_once_lose_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
