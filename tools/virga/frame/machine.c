/* machine.c - see machine.h. */
#include "frame/machine.h"

#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define PATH_SIZE 4096

/* The number in a file; false: there is none, or it is "max". */
static bool read_number(const char *folder, const char *name, double *number)
{
    char path[PATH_SIZE + 64];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "r");
    const bool read = file && fscanf(file, "%lf", number) == 1;
    if (file)
        fclose(file);
    return read;
}

/* The number behind a word at the beginning of a line; 0: there is none. */
static double find_number(const char *folder, const char *name, const char *word)
{
    char path[PATH_SIZE + 64], line[256];
    double number = 0;
    const size_t length = strlen(word);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file))
        if (!strncmp(line, word, length) && sscanf(line + length, " %lf", &number) == 1)
            break;
    if (file)
        fclose(file);
    return number;
}

/* ---- control groups */

typedef struct limits {
    double processors, bytes; /* the least of all groups so far */
} limits;

static void lower(double *limit, double to)
{
    if (to < *limit)
        *limit = to > 0 ? to : 0;
}

/* Version 2 has all in one tree; version 1 has a tree for memory and one for processors. */
static void read_group(const char *folder, limits *found)
{
    char path[PATH_SIZE + 64];
    double max, now, period;
    if (read_number(folder, "memory.max", &max) && read_number(folder, "memory.current", &now))
        lower(&found->bytes, max - now + find_number(folder, "memory.stat", "inactive_file "));
    if (read_number(folder, "memory.limit_in_bytes", &max) && read_number(folder, "memory.usage_in_bytes", &now))
        lower(&found->bytes, max - now + find_number(folder, "memory.stat", "total_inactive_file "));
    if (read_number(folder, "cpu.cfs_quota_us", &max) && read_number(folder, "cpu.cfs_period_us", &period) && max > 0)
        lower(&found->processors, max / period);
    snprintf(path, sizeof path, "%s/cpu.max", folder);
    FILE *file = fopen(path, "r");
    if (file && fscanf(file, "%lf %lf", &max, &period) == 2 && period > 0)
        lower(&found->processors, max / period);
    if (file)
        fclose(file);
}

/* A group and all around it. In a container the tree may begin at its own group, whatever the path says. */
static void read_groups(const char *tree, const char *group, limits *found)
{
    char folder[PATH_SIZE];
    snprintf(folder, sizeof folder, "%s%s", tree, group);
    const size_t least = strlen(tree);
    for (;;) {
        read_group(folder, found);
        char *slash = strrchr(folder, '/');
        if (!slash || strlen(folder) <= least)
            return;
        *slash = 0;
    }
}

/* Lines are "0::/user/shell" (version 2) and "4:memory:/user/shell" (version 1). */
static limits read_limits(const char *root)
{
    limits found = {1e9, 1e18};
    char path[PATH_SIZE], line[PATH_SIZE], tree[PATH_SIZE];
    snprintf(path, sizeof path, "%s/proc/self/cgroup", root);
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file)) {
        char *kinds = strchr(line, ':'), *group = kinds ? strchr(kinds + 1, ':') : NULL;
        if (!group)
            continue;
        *group++ = 0;
        kinds++;
        group[strcspn(group, "\n")] = 0;
        snprintf(tree, sizeof tree, "%.1000s/sys/fs/cgroup%s%.1000s", root, *kinds ? "/" : "", kinds);
        read_groups(tree, group, &found);
    }
    if (file)
        fclose(file);
    return found;
}

/* ---- what there is */

uint32_t machine_processors(const char *root)
{
    cpu_set_t set;
    const long online = sysconf(_SC_NPROCESSORS_ONLN);
    double count = online > 0 ? (double)online : 1;
    if (!sched_getaffinity(0, sizeof set, &set))
        lower(&count, CPU_COUNT(&set));
    lower(&count, read_limits(root).processors);
    return count < 1 ? 1 : (uint32_t)count;
}

uint64_t machine_free_bytes(const char *root)
{
    char folder[PATH_SIZE];
    snprintf(folder, sizeof folder, "%s/proc", root);
    double bytes = 1024 * find_number(folder, "meminfo", "MemAvailable:");
    lower(&bytes, read_limits(root).bytes);
    return (uint64_t)bytes;
}
