/* test_particles.h - where frames of another program's particles are, which are not part of the project: in the folder
 * that VIRGA_TEST_PARTICLES names, or in one beside the project's. Tests that need them skip without. */
#ifndef VIRGA_TESTS_TEST_PARTICLES_H
#define VIRGA_TESTS_TEST_PARTICLES_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* The path of a file of it. The same memory each time. */
static inline const char *test_particles_path(const char *name)
{
    static char path[1024];
    const char *given = getenv("VIRGA_TEST_PARTICLES");
    snprintf(path, sizeof path, "%s/%s", given ? given : SOURCE_ROOT "/../shared/particles/dam_break", name);
    return path;
}

/* False, and a line that says so, where it is not there. */
static inline bool test_particles_have(const char *name)
{
    if (access(test_particles_path(name), R_OK) == 0)
        return true;
    printf("skipped: there is no %s; VIRGA_TEST_PARTICLES names its folder\n", test_particles_path(name));
    return false;
}

#endif
