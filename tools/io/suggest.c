/* suggest.c - edit distance (Damerau 1964, Levenshtein 1966). Swapping neighbours is one step. */
#include "suggest.h"

#include <stdbool.h>
#include <string.h>
#include <strings.h>

#define MAX_LENGTH 63

static unsigned minimum(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

static bool same_letter(char a, char b)
{
    return strncasecmp(&a, &b, 1) == 0;
}

unsigned suggest_distance(const char *one, const char *other)
{
    unsigned rows[3][MAX_LENGTH + 1]; /* the newest three rows of the table, used as a ring */
    size_t height = strnlen(one, MAX_LENGTH), width = strnlen(other, MAX_LENGTH);
    for (size_t x = 0; x <= width; x++)
        rows[0][x] = (unsigned)x;
    for (size_t y = 1; y <= height; y++) {
        unsigned *row = rows[y % 3], *above = rows[(y + 2) % 3], *two_above = rows[(y + 1) % 3];
        row[0] = (unsigned)y;
        for (size_t x = 1; x <= width; x++) {
            bool same = same_letter(one[y - 1], other[x - 1]);
            row[x] = minimum(above[x - 1] + !same, minimum(above[x], row[x - 1]) + 1);
            if (x > 1 && y > 1 && same_letter(one[y - 1], other[x - 2]) && same_letter(one[y - 2], other[x - 1]))
                row[x] = minimum(row[x], two_above[x - 2] + 1);
        }
    }
    return rows[height % 3][width];
}

const char *suggest_nearest(const char *word, const char *const *list, size_t count)
{
    size_t length = strlen(word);
    unsigned best = length < 3 ? 1 : (unsigned)(length + 2) / 3;
    const char *nearest = NULL;
    for (size_t i = 0; i < count; i++) {
        unsigned distance = suggest_distance(word, list[i]);
        if (length >= 3 && strncasecmp(word, list[i], length) == 0 && distance > 1)
            distance = 1; /* an abbreviation, as "res" for "resume" */
        if (distance < strlen(list[i]) && (distance < best || (!nearest && distance == best))) {
            best = distance;
            nearest = list[i];
        }
    }
    return nearest;
}
