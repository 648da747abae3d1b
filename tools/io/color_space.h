/* color_space.h - colors of a space that an OpenColorIO config names, as linear light and back. Light is in the space
 * of the config's role scene_linear, with its primaries. OpenColorIO is a module, loaded with the first space. */
#ifndef VIRGA_IO_COLOR_SPACE_H
#define VIRGA_IO_COLOR_SPACE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct color_space color_space; /* opaque */

/* Whether the program was built with OpenColorIO. */
bool color_space_is_there(void);

/* Opens a space by its name, alias or role. `config` is a file; NULL: the one that the environment variable OCIO names.
 * On failure *space is NULL and `error` has one line that begins with "expected" or names the file. */
bool color_space_open(color_space **space, const char *config, const char *name, char *error, size_t error_size);
void color_space_close(color_space **space); /* accepts NULL in it */

/* In place: pixels of 3 or 4 floats, of which the fourth stays. Values outside [0; 1] are what the config makes of
 * them. Any number of threads may do this with one space. */
void color_space_to_light(const color_space *space, float *values, size_t pixels, uint32_t channels);
void color_space_to_code(const color_space *space, float *values, size_t pixels, uint32_t channels);

#ifdef __cplusplus
}
#endif
#endif
