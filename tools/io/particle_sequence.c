/* particle_sequence.c - which files there are, and the two around a time. */
#include "particle_sequence.h"

#include "file.h"
#include "particle_pair.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_NUMBER 999999999 /* of a file */

struct particle_sequence {
    particle_sequence_def def;
    char *folder;          /* "." where the pattern has none */
    char *prefix, *suffix; /* of names in the folder, around the number */
    int width;             /* of the number; 0: as it is */
    bool numbered;         /* false: one file */
    uint32_t first, count; /* number of the first file, and how many there are */

    particles frames[2]; /* the files around the newest time */
    int64_t at[2];       /* which they are; -1: none */
    particle_pair pair;  /* of these two; a NULL: not matched yet */
    particle_sample *samples;
    size_t room;
};

__attribute__((format(printf, 3, 4))) static bool refuse(char *error, size_t error_size, const char *format, ...)
{
    if (error && error_size) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error, error_size, format, arguments);
        va_end(arguments);
    }
    return false;
}

/* ---- names */

/* "folder/dam_%04d.ply" */
static bool split_pattern(particle_sequence *sequence, char *error, size_t error_size)
{
    const char *files = sequence->def.files, *slash = strrchr(files, '/'), *name = slash ? slash + 1 : files;
    const char *percent = strchr(name, '%'), *rest = percent;
    sequence->folder = slash ? strndup(files, (size_t)(slash - files) + (slash == files)) : strdup(".");
    sequence->prefix = percent ? strndup(name, (size_t)(percent - name)) : strdup(name);
    sequence->numbered = percent;
    if (percent) {
        rest++;
        if (*rest == '0' && rest[1] >= '1' && rest[1] <= '9') {
            sequence->width = rest[1] - '0';
            rest += 2;
        }
        if (*rest != 'd' || strchr(rest, '%') || (slash && memchr(files, '%', (size_t)(slash - files))))
            return refuse(error, error_size, "%s: expected one number like %%04d, in the name of the file", files);
    }
    sequence->suffix = strdup(percent ? rest + 1 : "");
    return (sequence->folder && sequence->prefix && sequence->suffix) ||
           refuse(error, error_size, "%s: no memory", files);
}

static char *path_of(const particle_sequence *sequence, int64_t number)
{
    char *path = NULL;
    char digits[16] = "";
    if (sequence->numbered)
        snprintf(digits, sizeof digits, "%0*d", sequence->width, (int)number);
    const bool plain = !strchr(sequence->def.files, '/');
    if (asprintf(&path, "%s%s%s%s%s", plain ? "" : sequence->folder, plain || !strcmp(sequence->folder, "/") ? "" : "/",
                 sequence->prefix, digits, sequence->suffix) < 0)
        return NULL;
    return path;
}

static uint32_t number_of(const particle_sequence *sequence, uint32_t index)
{
    return sequence->first + index * sequence->def.step;
}

char *particle_sequence_path(const particle_sequence *sequence, uint32_t index)
{
    return path_of(sequence, number_of(sequence, index));
}

/* The number in a name of the folder; -1: not one of the files. */
static int64_t number_in(const particle_sequence *sequence, const char *name)
{
    const size_t before = strlen(sequence->prefix), behind = strlen(sequence->suffix), length = strlen(name);
    char digits[16] = {0}, *end;
    if (length <= before + behind || length - before - behind > 9 || strncmp(name, sequence->prefix, before) ||
        strcmp(name + length - behind, sequence->suffix))
        return -1;
    memcpy(digits, name + before, length - before - behind);
    const long number = strtol(digits, &end, 10);
    if (*end || digits[0] < '0' || digits[0] > '9' || number > MAX_NUMBER)
        return -1;
    char again[16];
    snprintf(again, sizeof again, "%0*d", sequence->width, (int)number);
    return strcmp(again, digits) ? -1 : number;
}

/* ---- which files there are */

static int compare_numbers(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static bool list_numbers(const particle_sequence *sequence, uint32_t **numbers, size_t *count, char *error,
                         size_t error_size)
{
    size_t room = 0;
    DIR *list = opendir(sequence->folder);
    *numbers = NULL;
    *count = 0;
    if (!list)
        return file_error(error, error_size, "cannot read", sequence->folder, errno);
    for (struct dirent *entry; (entry = readdir(list));) {
        const int64_t number = number_in(sequence, entry->d_name);
        if (number < 0)
            continue;
        if (*count == room) {
            uint32_t *grown = realloc(*numbers, (room = 2 * room + 256) * sizeof **numbers);
            if (!grown) {
                closedir(list);
                return refuse(error, error_size, "%s: no memory", sequence->def.files);
            }
            *numbers = grown;
        }
        (*numbers)[(*count)++] = (uint32_t)number;
    }
    closedir(list);
    if (*count)
        qsort(*numbers, *count, sizeof **numbers, compare_numbers);
    return true;
}

static bool refuse_missing(const particle_sequence *sequence, uint32_t number, uint32_t last, char *error,
                           size_t error_size)
{
    char *path = path_of(sequence, number);
    refuse(error, error_size, "%s is missing; expected the numbers %u to %u in steps of %u", path ? path : "a file",
           sequence->first, last, sequence->def.step);
    free(path);
    return false;
}

/* From the first number on, in steps, up to the largest. Numbers between the steps are left out. */
static bool check_numbers(particle_sequence *sequence, const uint32_t *numbers, size_t count, char *error,
                          size_t error_size)
{
    if (!count)
        return refuse(error, error_size, "%s: no file has such a name", sequence->def.files);
    sequence->first = sequence->def.first < 0 ? numbers[0] : (uint32_t)sequence->def.first;
    const uint32_t last = numbers[count - 1];
    uint64_t number = sequence->first;
    size_t i = 0;
    for (sequence->count = 0; sequence->count == 0 || number <= last; number += sequence->def.step) {
        while (i < count && numbers[i] < number)
            i++;
        if (i == count || numbers[i] != number)
            return refuse_missing(sequence, (uint32_t)number, last, error, error_size);
        sequence->count++;
    }
    return true;
}

static bool list_files(particle_sequence *sequence, char *error, size_t error_size)
{
    uint32_t *numbers;
    size_t count;
    sequence->count = 1;
    if (!sequence->numbered)
        return true;
    const bool ok = list_numbers(sequence, &numbers, &count, error, error_size) &&
                    check_numbers(sequence, numbers, count, error, error_size);
    free(numbers);
    return ok;
}

/* ---- open and close */

bool particle_sequence_open(particle_sequence **opened, const particle_sequence_def *def, char *error,
                            size_t error_size)
{
    *opened = NULL;
    if (!(def->rate_hz > 0) || !def->step || def->first > MAX_NUMBER)
        return refuse(error, error_size, "%s: a rate of %g, steps of %u, from number %lld; expected more than 0",
                      def->files, def->rate_hz, def->step, (long long)def->first);
    particle_sequence *sequence = calloc(1, sizeof *sequence);
    char *files = strdup(def->files);
    if (!sequence || !files) {
        free(files);
        free(sequence);
        return refuse(error, error_size, "%s: no memory", def->files);
    }
    sequence->def = *def;
    sequence->def.files = files;
    sequence->at[0] = sequence->at[1] = -1;
    if (!split_pattern(sequence, error, error_size) || !list_files(sequence, error, error_size)) {
        particle_sequence_close(sequence);
        return false;
    }
    *opened = sequence;
    return true;
}

void particle_sequence_close(particle_sequence *sequence)
{
    if (!sequence)
        return;
    pair_free(&sequence->pair);
    particles_free(&sequence->frames[0]);
    particles_free(&sequence->frames[1]);
    free((char *)sequence->def.files);
    free(sequence->folder);
    free(sequence->prefix);
    free(sequence->suffix);
    free(sequence->samples);
    free(sequence);
}

uint32_t particle_sequence_length(const particle_sequence *sequence)
{
    return sequence->count;
}

double particle_sequence_duration(const particle_sequence *sequence)
{
    return (double)(sequence->count - 1) * sequence->def.step / sequence->def.rate_hz;
}

/* ---- a time */

static bool load(particle_sequence *sequence, int slot, uint32_t index, char *error, size_t error_size)
{
    if (sequence->at[slot] == index)
        return true;
    pair_free(&sequence->pair);
    particles_free(&sequence->frames[slot]);
    sequence->at[slot] = -1;
    char *path = particle_sequence_path(sequence, index);
    const bool ok = path ? particles_read(path, &sequence->frames[slot], error, error_size)
                         : refuse(error, error_size, "%s: no memory", sequence->def.files);
    free(path);
    if (ok)
        sequence->at[slot] = index;
    return ok;
}

static void swap_frames(particle_sequence *sequence)
{
    const particles frame = sequence->frames[0];
    const int64_t at = sequence->at[0];
    pair_free(&sequence->pair);
    sequence->frames[0] = sequence->frames[1];
    sequence->at[0] = sequence->at[1];
    sequence->frames[1] = frame;
    sequence->at[1] = at;
}

static bool match(particle_sequence *sequence, char *error, size_t error_size)
{
    uint32_t twice;
    const particles *a = &sequence->frames[0], *b = &sequence->frames[1];
    if (sequence->pair.a || pair_match(&sequence->pair, a, b, sequence->def.ids, &twice))
        return true;
    if (twice == PAIR_NONE)
        return refuse(error, error_size, "%s: no memory for %u particles", sequence->def.files, a->count + b->count);
    char *path = particle_sequence_path(sequence, (uint32_t)sequence->at[1]);
    refuse(error, error_size, "cannot use %s: particle %u has the id %u, as one before it; expected different ids",
           path ? path : sequence->def.files, twice, b->id[twice]);
    free(path);
    return false;
}

static bool reserve(particle_sequence *sequence, size_t count, char *error, size_t error_size)
{
    if (count <= sequence->room)
        return true;
    particle_sample *grown = realloc(sequence->samples, count * sizeof *grown);
    if (!grown)
        return refuse(error, error_size, "%s: no memory for %zu particles", sequence->def.files, count);
    sequence->samples = grown;
    sequence->room = count;
    return true;
}

bool particle_sequence_at(particle_sequence *sequence, double time_s, const particle_sample **samples, uint32_t *count,
                          char *error, size_t error_size)
{
    const double interval = sequence->def.step / sequence->def.rate_hz, last = (double)sequence->count - 1;
    const double files = time_s / interval;
    const bool rest = !(files >= 0 && files < last); /* outside, or no number */
    const uint32_t index = rest ? (files >= last && last > 0 ? (uint32_t)last : 0) : (uint32_t)files;
    if (sequence->at[0] != index && sequence->at[1] == index)
        swap_frames(sequence);
    if (!load(sequence, 0, index, error, error_size) || (!rest && !load(sequence, 1, index + 1, error, error_size)))
        return false;
    const particles *a = &sequence->frames[0], *b = &sequence->frames[1];
    if (!reserve(sequence, (size_t)a->count + (rest ? 1 : b->count + (size_t)1), error, error_size) ||
        (!rest && !match(sequence, error, error_size)))
        return false;
    *count =
        rest ? pair_rest(a, sequence->samples) : pair_mix(&sequence->pair, interval, files - index, sequence->samples);
    *samples = sequence->samples;
    return true;
}
