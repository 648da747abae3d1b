/* particle_sequence.c - which files there are, and the two around a time. */
#include "particle_sequence.h"

#include "file.h"
#include "numbered_files.h"
#include "particle_fade.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A file and the next one. */
typedef struct two_files {
    particles frames[2];
    int64_t at[2];      /* which they are; -1: none */
    particle_pair pair; /* of these two; a NULL: not matched yet */
} two_files;

enum { MAX_EDGES = 2 * FADE_MOST_FILES };

struct particle_sequence {
    particle_sequence_def def;
    numbered_files files;
    uint32_t first, count; /* number of the first file, and how many there are */

    two_files now;              /* the files around the newest time */
    two_files near;             /* those of which the edge was listed last */
    fade_edge edges[MAX_EDGES]; /* by the number of their file, modulo MAX_EDGES */
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
    for (int slot = 0; slot < 2; slot++)
        sequence->now.at[slot] = sequence->near.at[slot] = -1;
    for (int edge = 0; edge < MAX_EDGES; edge++)
        sequence->edges[edge].at = -1;
    if (!numbered_files_parse(&sequence->files, files, error, error_size) || !list_files(sequence, error, error_size)) {
        particle_sequence_close(sequence);
        return false;
    }
    *opened = sequence;
    return true;
}

static void free_two(two_files *two)
{
    pair_free(&two->pair);
    particles_free(&two->frames[0]);
    particles_free(&two->frames[1]);
}

void particle_sequence_close(particle_sequence *sequence)
{
    if (!sequence)
        return;
    free_two(&sequence->now);
    free_two(&sequence->near);
    for (int edge = 0; edge < MAX_EDGES; edge++)
        fade_edge_free(&sequence->edges[edge]);
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

static bool load(const particle_sequence *sequence, two_files *two, int slot, uint32_t index, char *error,
                 size_t error_size)
{
    if (two->at[slot] == index)
        return true;
    pair_free(&two->pair);
    particles_free(&two->frames[slot]);
    two->at[slot] = -1;
    char *path = particle_sequence_path(sequence, index);
    const bool ok = path ? particles_read(path, &two->frames[slot], error, error_size)
                         : file_fail(error, error_size, "%s: no memory", sequence->def.files);
    free(path);
    if (ok)
        two->at[slot] = index;
    return ok;
}

static void swap_frames(two_files *two)
{
    const particles frame = two->frames[0];
    const int64_t at = two->at[0];
    pair_free(&two->pair);
    two->frames[0] = two->frames[1];
    two->at[0] = two->at[1];
    two->frames[1] = frame;
    two->at[1] = at;
}

static bool match(const particle_sequence *sequence, two_files *two, char *error, size_t error_size)
{
    uint32_t twice;
    const particles *a = &two->frames[0], *b = &two->frames[1];
    if (two->pair.a || pair_match(&two->pair, a, b, sequence->def.ids, &twice))
        return true;
    if (twice == PAIR_NONE)
        return file_fail(error, error_size, "%s: no memory for %u particles", sequence->def.files, a->count + b->count);
    char *path = particle_sequence_path(sequence, (uint32_t)two->at[1]);
    file_fail(error, error_size, "cannot use %s: particle %u has the id %u, as one before it; expected different ids",
              path ? path : sequence->def.files, twice, b->id[twice]);
    free(path);
    return false;
}

/* A file, and if so wanted the next one with who is who. */
static bool load_two(const particle_sequence *sequence, two_files *two, uint32_t index, bool both, char *error,
                     size_t error_size)
{
    if (two->at[0] != index && two->at[1] == index)
        swap_frames(two);
    return load(sequence, two, 0, index, error, error_size) &&
           (!both || (load(sequence, two, 1, index + 1, error, error_size) && match(sequence, two, error, error_size)));
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

/* Lists the edges around a time that are not listed yet. */
static bool list_edges(particle_sequence *sequence, const fade_window *window, const fade_edge *edges[static MAX_EDGES],
                       char *error, size_t error_size)
{
    for (int64_t at = window->first; at <= window->last; at++) {
        fade_edge *edge = &sequence->edges[at % MAX_EDGES];
        edges[at - window->first] = edge;
        if (edge->at == at)
            continue;
        fade_edge_free(edge);
        const bool is_now = sequence->now.pair.a && sequence->now.at[0] == at;
        two_files *two = is_now ? &sequence->now : &sequence->near;
        if (!load_two(sequence, two, (uint32_t)at, true, error, error_size))
            return false;
        if (!fade_edge_make(edge, &two->pair, at))
            return file_fail(error, error_size, "%s: no memory", sequence->def.files);
    }
    return true;
}

/* Fades what the two files around a time do not tell. Without ids there is nothing more. */
static bool fade(particle_sequence *sequence, double files, double interval_s, uint32_t *count, char *error,
                 size_t error_size)
{
    const fade_window window = fade_window_at(files, fade_half(sequence->def.fade_s, interval_s), sequence->count);
    const bool paired = !sequence->now.pair.a || sequence->now.pair.partner_of_a;
    const fade_edge *edges[MAX_EDGES];
    size_t room = *count;
    if (window.half_fade <= 0.5 || sequence->def.ids == PARTICLE_IDS_NONE || !paired)
        return true;
    if (!list_edges(sequence, &window, edges, error, error_size))
        return false;
    for (int64_t edge = window.first; edge <= window.last; edge++)
        room += edges[edge - window.first]->count;
    if (!reserve(sequence, room, error, error_size))
        return false;
    return fade_samples(&window, edges, interval_s, sequence->count, sequence->samples, count) ||
           file_fail(error, error_size, "%s: no memory for %zu particles", sequence->def.files, room);
}

bool particle_sequence_at(particle_sequence *sequence, double time_s, const particle_sample **samples, uint32_t *count,
                          char *error, size_t error_size)
{
    const double interval = sequence->def.step / sequence->def.rate_hz, last = (double)sequence->count - 1;
    const double files = time_s / interval;
    const bool rest = !(files >= 0 && files < last); /* outside, or no number */
    const uint32_t index = rest ? (files >= last && last > 0 ? (uint32_t)last : 0) : (uint32_t)files;
    two_files *now = &sequence->now;
    if (!load_two(sequence, now, index, !rest, error, error_size))
        return false;
    const particles *a = &now->frames[0], *b = &now->frames[1];
    if (!reserve(sequence, (size_t)a->count + (rest ? 1 : b->count + (size_t)1), error, error_size))
        return false;
    *count = rest ? pair_rest(a, sequence->samples) : pair_mix(&now->pair, interval, files - index, sequence->samples);
    if (!fade(sequence, files, interval, count, error, error_size))
        return false;
    *samples = sequence->samples;
    return true;
}
