/* words.h - guesses what a surface is made of from the words in its names. */
#ifndef VIRGA_HOST_WORDS_H
#define VIRGA_HOST_WORDS_H

#include <stdint.h>

/* Material number of the first known word in `name` (in any case), e.g. 1 for "tr-asphalt-2"; 0 if there is none.
 * The numbers never change. */
uint32_t host_material_word(const char *name);

/* Name of such a number; "default" for 0 and for numbers that are not used. */
const char *host_material_name(uint32_t material);

#endif
