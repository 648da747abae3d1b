/* main.c - runs fuzz_scene.c without libFuzzer: the inputs of files and folders that are named, then so many made by
 * chance from seeds 1, 2, 3 ... Usage: fuzz [-n COUNT] [-s SEED] [FILE or FOLDER]... */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <virga/shared/random.h>

#include "fuzz.h"

enum { MAX_BYTES = 4096 };

static void run_file(const char *path)
{
    static uint8_t data[MAX_BYTES];
    FILE *file = fopen(path, "rb");
    if (!file) {
        fprintf(stderr, "%s: can not be read\n", path);
        exit(1);
    }
    const size_t size = fread(data, 1, sizeof data, file);
    fclose(file);
    fprintf(stderr, "%s\n", path); /* the last line names the input that failed */
    LLVMFuzzerTestOneInput(data, size);
}

static void run_path(const char *path)
{
    DIR *folder = opendir(path);
    if (!folder) {
        run_file(path);
        return;
    }
    for (const struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        char full[1024];
        snprintf(full, sizeof full, "%s/%s", path, entry->d_name);
        if (entry->d_name[0] != '.')
            run_file(full);
    }
    closedir(folder);
}

static void run_seed(uint32_t seed)
{
    uint8_t data[MAX_BYTES];
    const size_t size = virga_hash2(seed, 0) % MAX_BYTES;
    for (size_t i = 0; i < size; i++)
        data[i] = (uint8_t)virga_hash3(seed, 1, (uint32_t)i);
    fprintf(stderr, "seed %u\n", seed);
    LLVMFuzzerTestOneInput(data, size);
}

int main(int argc, char **argv)
{
    uint32_t count = 0, first = 1;
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "-n") && i + 1 < argc)
            count = (uint32_t)strtoul(argv[++i], NULL, 10);
        else if (!strcmp(argv[i], "-s") && i + 1 < argc)
            first = (uint32_t)strtoul(argv[++i], NULL, 10);
        else
            run_path(argv[i]);
    }
    for (uint32_t seed = first; seed < first + count; seed++)
        run_seed(seed);
    fuzz_close();
    return 0;
}
