/* particle_sequence.c - which files there are, and the two around a time. */
#include "particle_sequence.h"

#include "file.h"
#include "numbered_files.h"
#include "particle_pair.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct particle_sequence {
    particle_sequence_def def;
    numbered_files files;
    uint32_t first, count; /* number of the first file, and how many there are */

    particles frames[2]; /* the files around the newest time */
    int64_t at[2];       /* which they are; -1: none */
    particle_pair pair;  /* of these two; a NULL: not matched yet */
    particle_sample *samples;
    size_t room;
};

/* ---- which files there are */

static uint32_t number_of(const particle_sequence *sequence, uint32_t index)
{
    return sequence->first + index * sequence->def.step;
}

char *particle_sequence_path(const particle_sequence *sequence, uint32_t index)
{
    return numbered_files_path(&sequence->files, number_of(sequence, index));
}

static bool refuse_missing(const particle_sequence *sequence, uint32_t number, uint32_t last, char *error,
                           size_t error_size)
{
    char *path = numbered_files_path(&sequence->files, number);
    file_fail(error, error_size, "%s is missing; expected the numbers %u to %u in steps of %u", path ? path : "a file",
              sequence->first, last, sequence->def.step);
    free(path);
    return false;
}

/* From the first number on, in steps, up to the largest. Numbers between the steps are left out. */
static bool check_numbers(particle_sequence *sequence, const uint32_t *numbers, size_t count, char *error,
                          size_t error_size)
{
    if (!count)
        return file_fail(error, error_size, "%s: no file has such a name", sequence->def.files);
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
    if (!sequence->files.numbered)
        return true;
    const bool ok = numbered_files_list(&sequence->files, &numbers, &count, error, error_size) &&
                    check_numbers(sequence, numbers, count, error, error_size);
    free(numbers);
    return ok;
}

/* ---- open and close */

bool particle_sequence_open(particle_sequence **opened, const particle_sequence_def *def, char *error,
                            size_t error_size)
{
    *opened = NULL;
    if (!(def->rate_hz > 0) || !def->step || def->first > NUMBERED_FILES_MAX)
        return file_fail(error, error_size, "%s: a rate of %g, steps of %u, from number %lld; expected more than 0",
                         def->files, def->rate_hz, def->step, (long long)def->first);
    particle_sequence *sequence = calloc(1, sizeof *sequence);
    char *files = strdup(def->files);
    if (!sequence || !files) {
        free(files);
        free(sequence);
        return file_fail(error, error_size, "%s: no memory", def->files);
    }
    sequence->def = *def;
    sequence->def.files = files;
    sequence->at[0] = sequence->at[1] = -1;
    if (!numbered_files_parse(&sequence->files, files, error, error_size) || !list_files(sequence, error, error_size)) {
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
    numbered_files_free(&sequence->files);
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
                         : file_fail(error, error_size, "%s: no memory", sequence->def.files);
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
        return file_fail(error, error_size, "%s: no memory for %u particles", sequence->def.files, a->count + b->count);
    char *path = particle_sequence_path(sequence, (uint32_t)sequence->at[1]);
    file_fail(error, error_size, "cannot use %s: particle %u has the id %u, as one before it; expected different ids",
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
        return file_fail(error, error_size, "%s: no memory for %zu particles", sequence->def.files, count);
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
