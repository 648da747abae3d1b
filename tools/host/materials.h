/* materials.h - names of materials, and guesses of materials from the names of meshes. */
#ifndef VIRGA_HOST_MATERIALS_H
#define VIRGA_HOST_MATERIALS_H

#include <stdbool.h>
#include <stdint.h>

/* The material (virga_material) of the first known keyword in `name`, in any case: 1 for "tr-asphalt-2"; 0 if there is
 * none. */
uint32_t host_guess_material(const char *name);

/* The number of a name as host_material_name gives it; false if there is none. */
bool host_material_find(const char *name, uint32_t *material);

/* Whether `name` contains `part` (lower case), in any case. */
bool host_name_contains(const char *name, const char *part);

/* Whether people walk on it: not furniture, houses or cars, and not glass, water, leaves, cloth or plastic. */
bool host_is_ground(const char *name, uint32_t material);

/* Name of a material; "default" for 0 and for numbers that are not used. */
const char *host_material_name(uint32_t material);

#endif
