/* same_runs.h - the same bits from software Vulkan with any number of threads, in any vector width, and with both
 * variants of passes.
 *
 * A test has a function that runs an effect and hashes what comes out. Its main calls same_runs_child first: a vector
 * width holds for a process, so those of other widths are processes of the same program. */
#ifndef VIRGA_TESTS_SAME_RUNS_H
#define VIRGA_TESTS_SAME_RUNS_H

#include "effect_fixture.h"

#include <inttypes.h>

enum { SAME_PARTS = 8 };

/* What a run gives: the hashes of its parts. Pictures may differ in the last bits between variants. */
typedef struct same_bits {
    uint64_t parts[SAME_PARTS];
    const char *names[SAME_PARTS];
    uint32_t count, pictures; /* the last `pictures` of them */
} same_bits;

typedef void (*same_run)(same_bits *bits);

static inline void same_add(same_bits *bits, const char *name, const void *data, size_t size)
{
    uint64_t hash = 14695981039346656037u; /* FNV-1a, by words */
    REQUIRE(bits->count < SAME_PARTS && size && size % 4 == 0);
    for (size_t i = 0; i < size / 4; i++)
        hash = (hash ^ ((const uint32_t *)data)[i]) * 1099511628211u;
    bits->names[bits->count] = name;
    bits->parts[bits->count++] = hash;
}

static inline void same_compare(const same_bits *first, const same_bits *other, bool pictures, const char *what)
{
    assert_int_equal(first->count, other->count);
    for (uint32_t i = 0; i < first->count - (pictures ? 0 : first->pictures); i++)
        if (first->parts[i] != other->parts[i])
            fail_msg("%s: other bits of the %s", what, first->names[i]);
}

static inline void same_for_threads_and_variants(same_run run)
{
    static const char *const threads[] = {"0", "1", "2"};
    const virga_pass_variants kept = effect_fixture_variants;
    same_bits first = {0}, of_variant = {0};
    for (int i = 0; i < 6; i++) {
        same_bits bits = {0};
        char what[64];
        effect_fixture_variants = i < 3 ? VIRGA_VARIANTS_SOFTWARE : VIRGA_VARIANTS_GPU;
        effect_device_set_threads(threads[i % 3]);
        run(&bits);
        snprintf(what, sizeof what, "%s threads, variants %s", threads[i % 3], i < 3 ? "of software" : "of GPUs");
        first = i ? first : bits;
        of_variant = i % 3 ? of_variant : bits;
        same_compare(&first, &bits, false, what);
        same_compare(&of_variant, &bits, true, what);
    }
    effect_fixture_variants = kept;
}

/* Returns true in a process that only runs, and prints what it has; main then returns `*code`. */
static inline bool same_runs_child(int argc, char **argv, same_run run, int *code)
{
    same_bits bits = {0};
    if (argc < 2 || strcmp(argv[1], "--bits"))
        return false;
    run(&bits);
    for (uint32_t i = 0; i < bits.count; i++)
        printf("bits %016" PRIx64 "\n", bits.parts[i]);
    *code = effect_fixture_close(0);
    return true;
}

/* Software Vulkan's cache of shaders does not know the width, so each width has one of its own in the folder `caches`,
 * which is kept: compiling takes long. Validation has seen these passes before. */
static inline void same_in_widths(const char *caches, same_run run)
{
    same_bits own = {0};
    run(&own);
    for (int width = 128; width <= 256; width *= 2) {
        char command[1024], line[128], what[64];
        same_bits bits = own;
        uint32_t count = 0;
        snprintf(command, sizeof command,
                 "mkdir -p '%s/%d' && VIRGA_VALIDATE=0 LP_NATIVE_VECTOR_WIDTH=%d MESA_SHADER_CACHE_DIR='%s/%d' "
                 "/proc/%d/exe --bits",
                 caches, width, width, caches, width, (int)getpid());
        snprintf(what, sizeof what, "vectors of %d bits", width);
        FILE *from = popen(command, "r");
        REQUIRE(from);
        while (fgets(line, sizeof line, from))
            if (count < SAME_PARTS && sscanf(line, "bits %" SCNx64, &bits.parts[count]) == 1)
                count++;
        REQUIRE(pclose(from) == 0);
        assert_int_equal(count, own.count);
        same_compare(&own, &bits, true, what);
    }
}

#endif
