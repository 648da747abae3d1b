/* particle_fade.h - particles that appear and vanish over more time than there is between two files. Internal to
 * particle_sequence.
 *
 * Times are in files here: 3.25 is a quarter of the way from the file 3 to the file 4. Between each file and the next
 * one is an edge. A particle that only one of the two files has fades around the middle of the edge, along
 * 3 s^2 - 2 s^3. Far from its files it moves with its velocity in the nearest one. */
#ifndef VIRGA_IO_PARTICLE_FADE_H
#define VIRGA_IO_PARTICLE_FADE_H

#include "particle_pair.h"

#define FADE_MOST_FILES 8 /* half of the longest fade: as many files are read ahead, and behind */

/* A particle that only one of two files has. */
typedef struct fade_change {
    float position[3], velocity[3];
    uint32_t id;
    bool appears;
} fade_change;

/* What changes from the file `at` to the next one. */
typedef struct fade_edge {
    int64_t at; /* negative: nothing is known */
    uint32_t count;
    fade_change *changes;
} fade_edge;

/* The edges that matter at a time: from `first` to `last`; none if that is less. */
typedef struct fade_window {
    double files;     /* the time */
    double half_fade; /* [0.5; FADE_MOST_FILES] in files */
    int64_t first, last;
} fade_window;

/* Half of a fade: no less than the half of the time between two files. */
double fade_half(double fade_s, double interval_s);

/* `count`: of files. */
fade_window fade_window_at(double files, double half_fade, uint32_t count);

/* How much of what appears at an edge is there; what vanishes is 1 less that. */
double fade_share(const fade_window *window, int64_t edge);

/* Lists what changes between two files: nothing where particles have no ids. False: no memory. */
bool fade_edge_make(fade_edge *edge, const particle_pair *pair, int64_t at);

/* Accepts one that was never made, all zero. */
void fade_edge_free(fade_edge *edge);

/* Fades `count` samples of a time, of which no two have the same id, and adds those of particles that are in files near
 * by alone: at most as many as all edges have changes. `edges`: those of the window, in their order. False: no memory.
 */
bool fade_samples(const fade_window *window, const fade_edge *const *edges, double interval_s, uint32_t file_count,
                  particle_sample *samples, uint32_t *count);

#endif
