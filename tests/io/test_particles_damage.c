/* test_particles_damage.c - damaged files of particles: cut off anywhere, with wrong bytes anywhere, plain and packed.
 * Each is read or refused in one line. Compiled with AddressSanitizer and UBSan, which end the program if anything else
 * happens. */
#include "check_io.h"
#include "particle_files.h"
#include "particles.h"

enum { CUTS = 160, FLIPS = 320 };

static void try_file(const char *data, size_t size)
{
    particles read;
    unlink(in_folder("damaged")); /* some file systems flush a file that is written again */
    put_file(in_folder("damaged"), data, size);
    error[0] = 0;
    if (particles_read(in_folder("damaged"), &read, error, sizeof error)) {
        assert_string_equal(error, "");
        assert_non_null(read.position);
    } else {
        assert_error("cannot read ", "damaged: ");
        assert_null(read.position);
    }
    particles_free(&read);
}

static void damage(const particle_file *file, uint64_t *random)
{
    char *copy = malloc(file->size);
    for (uint32_t i = 0; i < CUTS; i++)
        try_file(file->data, i < CUTS / 2 ? file->size * i / (CUTS / 2) : random_bits(random) % file->size);
    for (uint32_t i = 0; i < FLIPS; i++) {
        memcpy(copy, file->data, file->size);
        for (uint32_t k = 0; k <= i % 4; k++) {
            /* Half of the bytes are in the first part, where a header is. */
            const size_t reach = i & 4 ? file->size : (file->size < 400 ? file->size : 400);
            copy[random_bits(random) % reach] = i & 8 ? (char)random_bits(random) : "09-. \n\377"[i % 7];
        }
        try_file(copy, file->size);
    }
    free(copy);
}

static void damaged_files_are_read_or_refused(void **state)
{
    (void)state;
    uint64_t random = 1;
    for (int kind = 0; kind < FILE_KINDS; kind++) {
        particle_file file = make_particle_file((particle_file_kind)kind, 12);
        particle_file packed = gzip_particle_file(&file);
        damage(&file, &random);
        damage(&packed, &random);
        free(file.data);
        free(packed.data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(damaged_files_are_read_or_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
