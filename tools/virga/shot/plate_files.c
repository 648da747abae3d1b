/* plate_files.c - which picture belongs to which frame. */
#include "shot/plate_files.h"

#include "host.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static bool add_file(plate_files *p, const char *name)
{
    char **more = realloc(p->files, (p->file_count + 1) * sizeof *more);
    if (more)
        p->files = more;
    if (!more || asprintf(&p->files[p->file_count], "%s/%s", p->pattern, name) < 0)
        return false;
    p->file_count++;
    return true;
}

static bool list_folder(plate_files *p, char *error, size_t error_size)
{
    DIR *folder = opendir(p->pattern);
    bool listed = folder;
    for (struct dirent *entry; listed && (entry = readdir(folder));)
        listed = entry->d_name[0] == '.' || !p->takes(entry->d_name) || add_file(p, entry->d_name);
    if (folder)
        closedir(folder);
    if (!listed)
        return host_fail(error, error_size, "%s: cannot list the folder %s", p->option, p->pattern);
    if (!p->file_count)
        return host_fail(error, error_size, "%s: no %s pictures in the folder %s", p->option, p->endings, p->pattern);
    qsort(p->files, p->file_count, sizeof *p->files, by_name);
    return true;
}

/* A pattern is what printf needs for one whole number, and nothing else: it comes from a command line. */
static bool check_pattern(plate_files *p, char *error, size_t error_size)
{
    const char *percent = strchr(p->pattern, '%');
    if (!percent)
        return true;
    p->numbered = true;
    const char *end = percent + 1 + strspn(percent + 1, "0123456789");
    if (*end == 'd' && end - percent <= 3 && !strchr(end, '%'))
        return true;
    return host_fail(error, error_size, "%s: expected one number as in plate.%%04d.exr, got %s", p->option, p->pattern);
}

bool plate_files_name(const plate_files *p, uint32_t frame, char path[4096], char *error, size_t error_size)
{
    if (p->files && frame - p->first >= p->file_count)
        return host_fail(error, error_size, "%s: %u pictures in %s, none for frame %u", p->option, p->file_count,
                         p->pattern, frame);
    if (p->files) {
        snprintf(path, 4096, "%s", p->files[frame - p->first]);
        return true;
    }
    const char *percent = p->numbered ? strchr(p->pattern, '%') : NULL;
    if (!percent) {
        snprintf(path, 4096, "%s", p->pattern);
        return true;
    }
    const int digits = atoi(percent + 1);
    snprintf(path, 4096, "%.*s%0*u%s", (int)(percent - p->pattern), p->pattern, digits, frame,
             strchr(percent, 'd') + 1);
    return true;
}

/* Finds out what the pattern is, and whether the pictures are there. */
bool plate_files_open(plate_files *p, const uint32_t frames[2], char *error, size_t error_size)
{
    struct stat about;
    const char *pattern = p->pattern;
    const bool folder = !stat(pattern, &about) && S_ISDIR(about.st_mode);
    if (folder ? !list_folder(p, error, error_size) : !check_pattern(p, error, error_size))
        return false;
    for (uint32_t frame = frames[0]; frame <= frames[1]; frame++) {
        char path[4096];
        if (!plate_files_name(p, frame, path, error, error_size))
            return false;
        if (access(path, R_OK))
            return host_fail(error, error_size, "%s: cannot read %s, for frame %u", p->option, path, frame);
    }
    return true;
}

void plate_files_close(plate_files *p)
{
    for (uint32_t i = 0; i < p->file_count; i++)
        free(p->files[i]);
    free(p->files);
    p->files = NULL;
    p->file_count = 0;
}
