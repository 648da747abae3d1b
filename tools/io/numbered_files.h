/* numbered_files.h - a folder's files that differ in a number: "dam_%04d.ply". */
#ifndef VIRGA_IO_NUMBERED_FILES_H
#define VIRGA_IO_NUMBERED_FILES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define NUMBERED_FILES_MAX 999999999 /* largest number */

typedef struct numbered_files {
    char *folder;          /* with its slash; "" where the name has none */
    char *prefix, *suffix; /* of the name, around the number */
    int width;             /* digits at least; 0: as many as it needs */
    bool numbered;         /* false: one file, whose name is the prefix */
} numbered_files;

/* Takes a name with %d or %04d apart; without % it is one file. After success call numbered_files_free once. */
bool numbered_files_parse(numbered_files *files, const char *name, char *error, size_t error_size);
void numbered_files_free(numbered_files *files);

/* The name of one of the files, needs free(); NULL without memory. */
char *numbered_files_path(const numbered_files *files, uint32_t number);

/* The numbers that there are, by rising number, need free(); NULL for none. */
bool numbered_files_list(const numbered_files *files, uint32_t **numbers, size_t *count, char *error,
                         size_t error_size);

#endif
