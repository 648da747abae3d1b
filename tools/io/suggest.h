/* suggest.h - "did you mean": the known word nearest to a wrong one. */
#ifndef VIRGA_IO_SUGGEST_H
#define VIRGA_IO_SUGGEST_H

#include <stddef.h>

/* Letters to insert, drop, replace or swap with their neighbour to get from one word to the other, any case. Words
 * longer than 63 bytes are compared by their first 63. */
unsigned suggest_distance(const char *one, const char *other);

/* The word of the list that was most likely meant, or NULL if none is near. The first of equally near ones. */
const char *suggest_nearest(const char *word, const char *const *list, size_t count);

#endif
