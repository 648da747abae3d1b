/* suggest.h - "did you mean": the known name nearest to a wrong one. */
#ifndef VIRGA_IO_SUGGEST_H
#define VIRGA_IO_SUGGEST_H

#include <stddef.h>

/* Edit distance of two names, ignoring case: letters to insert, drop, replace, or swap with a neighbour. Only the first
 * 63 bytes are compared. */
unsigned suggest_distance(const char *one, const char *other);

/* The name of the list that was most likely meant, or NULL if none is near. The first of equally near ones. */
const char *suggest_nearest(const char *word, const char *const *list, size_t count);

#endif
