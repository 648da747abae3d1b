/* color_space.c - loads the module of OpenColorIO with the first space. */
#include "color_space.h"

#include "color_space_table.h"
#include "file.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdlib.h>

#define TEXT_OF(name) #name
#define SYMBOL(name)  TEXT_OF(name)

static pthread_once_t once = PTHREAD_ONCE_INIT;
static const color_space_table *spaces; /* NULL: it cannot be loaded */

/* The module stays loaded until the program ends. */
static void load(void)
{
    void *module = dlopen(COLOR_SPACE_MODULE, RTLD_NOW | RTLD_LOCAL);
    spaces = module ? dlsym(module, SYMBOL(COLOR_SPACE_TABLE)) : NULL;
}

bool color_space_is_there(void)
{
    return true;
}

bool color_space_open(color_space **space, const char *config, const char *name, char *error, size_t error_size)
{
    char reason[512];
    *space = NULL;
    pthread_once(&once, load);
    if (!spaces)
        return file_fail(error, error_size, "expected none, as OpenColorIO cannot be loaded");
    if (!config && !getenv("OCIO"))
        return file_fail(error, error_size, "expected footage.ocio_config, or a config named by OCIO");
    *space = spaces->open(config, name, reason, sizeof reason);
    return *space || file_fail(error, error_size, "%s", reason);
}

void color_space_close(color_space **space)
{
    if (*space)
        spaces->close(*space);
    *space = NULL;
}

void color_space_to_light(const color_space *space, float *values, size_t pixels, uint32_t channels)
{
    spaces->apply(space, true, values, pixels, channels);
}

void color_space_to_code(const color_space *space, float *values, size_t pixels, uint32_t channels)
{
    spaces->apply(space, false, values, pixels, channels);
}
