/* test_packed_file.c - packed files come back as they were written; each damage of one is found. */
#include "check_io.h"
#include "file.h"
#include "packed_file.h"

typedef struct test_head {
    uint32_t number;
    char name[12];
} test_head;

static const test_head head = {7, "checkpoint"};

/* Half of it zeros, as states are; larger than zlib's own buffers. */
enum { SIZE = 700001 };

static unsigned char *make_bytes(void)
{
    uint64_t seed = 3;
    unsigned char *bytes = calloc(1, SIZE);
    for (size_t i = 0; i < SIZE; i++)
        if (i / 5000 % 2)
            bytes[i] = (unsigned char)random_bits(&seed);
    return bytes;
}

static void write_file(const char *name, const unsigned char *bytes, uint64_t size)
{
    if (!packed_write(in_folder(name), &head, sizeof head, bytes, size, error, sizeof error))
        fail_msg("%s", error);
}

static void a_block_comes_back(void **state)
{
    (void)state;
    unsigned char *bytes = make_bytes(), *read = malloc(SIZE);
    test_head there;
    uint64_t size;
    write_file("a", bytes, SIZE);
    assert_true(packed_read_head(in_folder("a"), &there, sizeof there, &size, error, sizeof error));
    assert_memory_equal(&there, &head, sizeof head);
    assert_int_equal(size, SIZE);
    assert_true(packed_read(in_folder("a"), sizeof head, read, SIZE, error, sizeof error));
    assert_memory_equal(read, bytes, SIZE);
    assert_int_equal(folder_entries(false), 1);
    free(bytes);
    free(read);
}

static void an_empty_block_comes_back(void **state)
{
    (void)state;
    write_file("b", (const unsigned char *)"", 0);
    assert_true(packed_read(in_folder("b"), sizeof head, NULL, 0, error, sizeof error));
}

static void another_size_is_refused(void **state)
{
    (void)state;
    unsigned char *bytes = make_bytes(), *read = malloc(SIZE + 1);
    test_head there;
    write_file("c", bytes, SIZE);
    assert_false(packed_read(in_folder("c"), sizeof head, read, SIZE - 1, error, sizeof error));
    assert_false(packed_read(in_folder("c"), sizeof head, read, SIZE + 1, error, sizeof error));
    assert_false(packed_read_head(in_folder("c"), &there, sizeof there - 4, NULL, error, sizeof error));
    assert_false(packed_read_head(in_folder("nothing"), &there, sizeof there, NULL, error, sizeof error));
    free(bytes);
    free(read);
}

/* One bit is flipped, or the end is cut off. zlib's checksum finds both in the block, ours in the head. */
static void damage_is_found(void **state)
{
    (void)state;
    unsigned char *bytes = make_bytes(), *read = malloc(SIZE);
    test_head there;
    uint64_t seed = 11;
    write_file("d", bytes, SIZE);
    for (uint32_t i = 0; i < 200; i++) {
        size_t size;
        void *file;
        assert_true(file_read(in_folder("d"), 1 << 24, &file, &size, error, sizeof error));
        const size_t at = i < 40 ? i : random_bits(&seed) % size;
        if (i % 4)
            ((unsigned char *)file)[at] ^= (unsigned char)(1u << random_bits(&seed) % 8);
        FILE *damaged = fopen(in_folder("e"), "wb");
        assert_int_equal(fwrite(file, 1, i % 4 ? size : at, damaged), i % 4 ? size : at);
        fclose(damaged);
        free(file);
        const bool same = packed_read_head(in_folder("e"), &there, sizeof there, NULL, error, sizeof error) &&
                          packed_read(in_folder("e"), sizeof head, read, SIZE, error, sizeof error);
        if (same && (memcmp(read, bytes, SIZE) || memcmp(&there, &head, sizeof head)))
            fail_msg("byte %zu: damage was not found", at);
    }
    free(bytes);
    free(read);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(a_block_comes_back),
        TEST_IN_FOLDER(an_empty_block_comes_back),
        TEST_IN_FOLDER(another_size_is_refused),
        TEST_IN_FOLDER(damage_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
