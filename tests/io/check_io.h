/* check_io.h - cmocka, a folder to write to, and ways to make writing fail. */
#ifndef VIRGA_TESTS_IO_CHECK_IO_H
#define VIRGA_TESTS_IO_CHECK_IO_H

#include <dirent.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static char folder[64];
static char error[512];

/* Each test starts with an empty folder and no error. */
static inline int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/virga-test-XXXXXX");
    error[0] = 0;
    return mkdtemp(folder) ? 0 : -1;
}

/* Names in the folder; unlinks them too if asked to. */
static inline int folder_entries(bool removing)
{
    DIR *list = opendir(folder);
    int count = 0;
    for (struct dirent *entry; list && (entry = readdir(list));) {
        if (!strcmp(entry->d_name, ".") || !strcmp(entry->d_name, ".."))
            continue;
        count++;
        if (removing)
            unlinkat(dirfd(list), entry->d_name, 0);
    }
    if (list)
        closedir(list);
    return count;
}

static inline int remove_folder(void **state)
{
    (void)state;
    folder_entries(true);
    return rmdir(folder);
}

/* "FOLDER/name"; valid until the fourth call after this one. */
static inline const char *in_folder(const char *name)
{
    static char paths[4][128];
    static unsigned next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

static inline void put_file(const char *path, const void *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static inline char *get_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *size = (size_t)ftell(file);
    rewind(file);
    char *data = calloc(*size + 1, 1);
    assert_non_null(data);
    assert_int_equal(fread(data, 1, *size, file), *size);
    fclose(file);
    return data;
}

/* Limits the size of files of this process to `bytes`: writing fails in the middle, as on a full disk. */
static inline void limit_files(rlim_t bytes)
{
    struct rlimit limit;
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = bytes;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

static inline void unlimit_files(void)
{
    struct rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_FSIZE, &limit);
}

/* The error is one line and contains both texts. */
static inline void assert_error(const char *one, const char *other)
{
    if (!strstr(error, one) || !strstr(error, other) || strchr(error, '\n'))
        fail_msg("error is '%s', expected one line with '%s' and '%s'", error, one, other);
}

/* A small random number generator, so that every run sees the same numbers. */
static inline uint32_t random_bits(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 33) ^ (uint32_t)(*state >> 20);
}

#define TEST_IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, make_folder, remove_folder)

#endif
