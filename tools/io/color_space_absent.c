/* color_space_absent.c - for builds without OpenColorIO. */
#include "color_space.h"

#include "file.h"

bool color_space_is_there(void)
{
    return false;
}

bool color_space_open(color_space **space, const char *config, const char *name, char *error, size_t error_size)
{
    (void)config;
    (void)name;
    *space = NULL;
    return file_fail(error, error_size, "expected none, as this program was built without OpenColorIO");
}

void color_space_close(color_space **space)
{
    *space = NULL;
}

void color_space_to_light(const color_space *space, float *values, size_t pixels, uint32_t channels)
{
    (void)space;
    (void)values;
    (void)pixels;
    (void)channels;
}

void color_space_to_code(const color_space *space, float *values, size_t pixels, uint32_t channels)
{
    color_space_to_light(space, values, pixels, channels);
}
