/* numbered_files.c - names with numbers, and the folder that has them. */
#include "numbered_files.h"

#include "file.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool no_memory(const char *name, char *error, size_t error_size)
{
    return file_error(error, error_size, "cannot read", name, ENOMEM);
}

bool numbered_files_parse(numbered_files *files, const char *name, char *error, size_t error_size)
{
    const char *slash = strrchr(name, '/'), *base = slash ? slash + 1 : name;
    const char *percent = strchr(base, '%'), *rest = percent ? percent + 1 : "d";
    *files = (numbered_files){.numbered = percent};
    if (*rest == '0' && rest[1] >= '1' && rest[1] <= '9') {
        files->width = rest[1] - '0';
        rest += 2;
    }
    if (*rest != 'd' || strchr(rest, '%') || memchr(name, '%', (size_t)(base - name)))
        return file_fail(error, error_size, "%s: expected one number like %%04d, in the name of the file", name);
    files->folder = strndup(name, (size_t)(base - name));
    files->prefix = percent ? strndup(base, (size_t)(percent - base)) : strdup(base);
    files->suffix = strdup(rest + 1);
    if (files->folder && files->prefix && files->suffix)
        return true;
    numbered_files_free(files);
    return no_memory(name, error, error_size);
}

void numbered_files_free(numbered_files *files)
{
    free(files->folder);
    free(files->prefix);
    free(files->suffix);
    *files = (numbered_files){0};
}

char *numbered_files_path(const numbered_files *files, uint32_t number)
{
    char *path = NULL, digits[16] = "";
    if (files->numbered)
        snprintf(digits, sizeof digits, "%0*u", files->width, number);
    return asprintf(&path, "%s%s%s%s", files->folder, files->prefix, digits, files->suffix) < 0 ? NULL : path;
}

/* The number in a name of the folder; -1: not one of the files. */
static int64_t number_in(const numbered_files *files, const char *name)
{
    const size_t before = strlen(files->prefix), behind = strlen(files->suffix), length = strlen(name);
    char digits[16] = {0}, again[16], *end;
    if (length <= before + behind || length - before - behind > 9 || strncmp(name, files->prefix, before) ||
        strcmp(name + length - behind, files->suffix))
        return -1;
    memcpy(digits, name + before, length - before - behind);
    const long number = strtol(digits, &end, 10);
    if (*end || digits[0] < '0' || digits[0] > '9' || number > NUMBERED_FILES_MAX)
        return -1;
    snprintf(again, sizeof again, "%0*d", files->width, (int)number);
    return strcmp(again, digits) ? -1 : number;
}

static int compare(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

bool numbered_files_list(const numbered_files *files, uint32_t **numbers, size_t *count, char *error, size_t error_size)
{
    size_t room = 0;
    const char *folder = *files->folder ? files->folder : ".";
    DIR *list = opendir(folder);
    *numbers = NULL;
    *count = 0;
    if (!list)
        return file_error(error, error_size, "cannot read", folder, errno);
    for (struct dirent *entry; (entry = readdir(list));) {
        const int64_t number = files->numbered ? number_in(files, entry->d_name) : -1;
        if (number < 0)
            continue;
        if (*count == room) {
            uint32_t *grown = realloc(*numbers, (room = 2 * room + 256) * sizeof **numbers);
            if (!grown) {
                closedir(list);
                free(*numbers);
                *numbers = NULL;
                return no_memory(folder, error, error_size);
            }
            *numbers = grown;
        }
        (*numbers)[(*count)++] = (uint32_t)number;
    }
    closedir(list);
    if (*count)
        qsort(*numbers, *count, sizeof **numbers, compare);
    return true;
}
