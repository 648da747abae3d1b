/* words.h - names of materials; and guesses what a surface is made of from the words in its names. */
#ifndef VIRGA_HOST_WORDS_H
#define VIRGA_HOST_WORDS_H

#include <stdbool.h>
#include <stdint.h>

/* Material number of the first known word in `name` (in any case), e.g. 1 for "tr-asphalt-2"; 0 if there is none.
 * The numbers are virga_material's and never change. */
uint32_t host_material_word(const char *name);

/* The number of a name as host_material_name gives it; false if there is none. */
bool host_material_find(const char *name, uint32_t *material);

/* Whether `name` has `word` (lower case) in it, in any case. */
bool host_name_contains(const char *name, const char *word);

/* Whether people walk on it: neither furniture, houses and cars nor what is not solid ground. */
bool host_is_ground(const char *name, uint32_t material);

/* Name of such a number; "default" for 0 and for numbers that are not used. */
const char *host_material_name(uint32_t material);

#endif
