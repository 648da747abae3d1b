/* gutters.c - see gutters.h. */
#include "gutters.h"

#include <math.h>
#include <stdlib.h>

#include <virga/shared/random.h>

#define BESIDE_M     1.0  /* a pipe stands as near to the gutter that it empties */
#define LEVEL_M      0.1  /* pieces of one gutter that are neighbours differ less in height */
#define REACH_CELLS  2    /* so far apart neighbours may be: eaves aslant to the grid have gaps */
#define PART_M2      2.0  /* of a roof, for a place that pours */
#define PART_WIDTH_M 1.0  /* of its eave: the most that a place may have */
#define PIPE_M       0.03 /* inner radius, over which the places are spread. Pipes of 60 to 100 mm are usual */
/* A pipe that no scene names is in no mesh either. It ends at the ground, a drop's size above it: a jet that comes out
 * of the air would be seen as a block of water. Water leaves a pipe at about 1 m/s. */
#define FOOT_M    0.01
#define FOOT_M_S  1.0
#define DROPS     8 /* of a jet, that fly as one */
#define MIN_SLOPE 0.005
#define NO_RUN    UINT32_MAX

/* What a pipe gets. */
typedef struct pipe_load {
    double catch_m2, width_m, slope_m; /* slope_m: sum of slopes times widths */
} pipe_load;

typedef struct gutter_work {
    const host_eave *eaves;
    uint32_t count;
    uint32_t *runs;  /* the gutter of each piece: the first of its pieces */
    uint32_t *stack; /* pieces whose neighbours are to be visited */
    host_downpipe *pipes;
    pipe_load *loads;
    uint32_t pipe_count;
} gutter_work;

/* ---- gutters */

static bool are_neighbours(const host_eave *a, const host_eave *b)
{
    const int64_t x = (int64_t)a->x - b->x, z = (int64_t)a->z - b->z;
    return x * x <= REACH_CELLS * REACH_CELLS && z * z <= REACH_CELLS * REACH_CELLS &&
           fabs(a->position_m[1] - b->position_m[1]) < LEVEL_M;
}

static void follow_run(gutter_work *w, uint32_t first)
{
    uint32_t waiting = 0;
    w->runs[first] = first;
    w->stack[waiting++] = first;
    while (waiting) {
        const host_eave *at = &w->eaves[w->stack[--waiting]];
        for (uint32_t i = first + 1; i < w->count; i++) {
            if (w->runs[i] != NO_RUN || !are_neighbours(at, &w->eaves[i]))
                continue;
            w->runs[i] = first;
            w->stack[waiting++] = i;
        }
    }
}

static void find_runs(gutter_work *w)
{
    for (uint32_t i = 0; i < w->count; i++)
        w->runs[i] = NO_RUN;
    for (uint32_t i = 0; i < w->count; i++)
        if (w->runs[i] == NO_RUN)
            follow_run(w, i);
}

/* ---- pipes */

/* A gutter ends where it reaches farthest along its longer side. A pipe stands there if there is ground. */
static void add_pipe_of_run(gutter_work *w, uint32_t run)
{
    uint32_t low[2] = {UINT32_MAX, UINT32_MAX}, high[2] = {0, 0};
    for (uint32_t i = run; i < w->count; i++) {
        const uint32_t at[2] = {w->eaves[i].x, w->eaves[i].z};
        for (int axis = 0; axis < 2 && w->runs[i] == run; axis++) {
            low[axis] = at[axis] < low[axis] ? at[axis] : low[axis];
            high[axis] = at[axis] > high[axis] ? at[axis] : high[axis];
        }
    }
    const bool along_z = high[1] - low[1] > high[0] - low[0];
    const host_eave *end = NULL;
    for (uint32_t i = run; i < w->count; i++) {
        const host_eave *eave = &w->eaves[i];
        if (w->runs[i] == run && !isnan(eave->ground_m) && (!end || (along_z ? eave->z > end->z : eave->x > end->x)))
            end = eave;
    }
    if (end)
        w->pipes[w->pipe_count++] =
            (host_downpipe){{end->position_m[0], end->ground_m + FOOT_M, end->position_m[2]}, {0, -FOOT_M_S, 0}};
}

static double apart_m(const host_eave *eave, const host_downpipe *pipe)
{
    return hypot(eave->position_m[0] - pipe->position_m[0], eave->position_m[2] - pipe->position_m[2]);
}

/* Whether a pipe empties a gutter. */
static bool empties(const gutter_work *w, uint32_t run, const host_downpipe *pipe)
{
    for (uint32_t i = run; i < w->count; i++)
        if (w->runs[i] == run && apart_m(&w->eaves[i], pipe) <= BESIDE_M &&
            w->eaves[i].position_m[1] > pipe->position_m[1])
            return true;
    return false;
}

/* Each piece of a gutter to the nearest of its pipes. Returns the area that has none. */
static double share_run(gutter_work *w, uint32_t run)
{
    double lost_m2 = 0;
    bool *open = (bool *)w->stack; /* of pipes: not used any more, and there are no more of them than room */
    for (uint32_t p = 0; p < w->pipe_count; p++)
        open[p] = empties(w, run, &w->pipes[p]);
    for (uint32_t i = run; i < w->count; i++) {
        const host_eave *eave = &w->eaves[i];
        uint32_t nearest = w->pipe_count;
        if (w->runs[i] != run)
            continue;
        for (uint32_t p = 0; p < w->pipe_count; p++)
            if (open[p] &&
                (nearest == w->pipe_count || apart_m(eave, &w->pipes[p]) < apart_m(eave, &w->pipes[nearest])))
                nearest = p;
        if (nearest == w->pipe_count) {
            lost_m2 += eave->catch_m2;
            continue;
        }
        w->loads[nearest].catch_m2 += eave->catch_m2;
        w->loads[nearest].width_m += eave->width_m;
        w->loads[nearest].slope_m += eave->slope * eave->width_m;
    }
    return lost_m2;
}

/* ---- places */

static uint32_t parts_of(const pipe_load *load)
{
    return (uint32_t)ceil(fmax(load->catch_m2 / PART_M2, load->width_m / PART_WIDTH_M));
}

/* A part of the roof's film for each, of the same depth as all of it. */
static void add_places(const host_downpipe *pipe, const pipe_load *load, uint32_t number, host_gutters *out)
{
    const uint32_t parts = parts_of(load);
    for (uint32_t i = 0; i < parts; i++) {
        const uint32_t hash = virga_hash2(number, i);
        const double turn = 2 * M_PI * (double)virga_unit(hash),
                     radius = PIPE_M * sqrt((double)virga_unit(virga_hash1(hash)));
        virga_drip_site *site = &out->sites[out->site_count++];
        *site = (virga_drip_site){.catch_m2 = (float)(load->catch_m2 / parts),
                                  .width_m = (float)fmax(load->width_m / parts, 0.005),
                                  .slope = (float)fmax(load->slope_m / load->width_m, MIN_SLOPE),
                                  .drops = DROPS};
        for (int axis = 0; axis < 3; axis++) {
            const double off[3] = {radius * cos(turn), 0, radius * sin(turn)};
            site->position_m[axis] = pipe->position_m[axis] + off[axis];
            site->velocity_m_s[axis] = (float)pipe->velocity_m_s[axis];
        }
    }
}

static bool add_all_places(const gutter_work *w, host_gutters *out)
{
    size_t parts = 0;
    for (uint32_t p = 0; p < w->pipe_count; p++)
        parts += parts_of(&w->loads[p]);
    out->sites = malloc((parts + 1) * sizeof *out->sites);
    for (uint32_t p = 0; out->sites && p < w->pipe_count; p++)
        add_places(&w->pipes[p], &w->loads[p], p, out);
    return out->sites;
}

static bool work(gutter_work *w, const host_downpipe *pipes, uint32_t pipe_count, host_gutters *out)
{
    find_runs(w);
    for (uint32_t p = 0; p < pipe_count; p++)
        w->pipes[w->pipe_count++] = pipes[p];
    for (uint32_t i = 0; i < w->count && !pipe_count; i++)
        if (w->runs[i] == i)
            add_pipe_of_run(w, i);
    for (uint32_t i = 0; i < w->count; i++)
        if (w->runs[i] == i)
            out->lost_m2 += share_run(w, i);
    return add_all_places(w, out);
}

bool host_gutters_find(const host_eave *eaves, uint32_t eave_count, const host_downpipe *pipes, uint32_t pipe_count,
                       host_gutters *gutters)
{
    const size_t most = eave_count > pipe_count ? eave_count : pipe_count;
    gutter_work w = {.eaves = eaves,
                     .count = eave_count,
                     .runs = malloc((most + 1) * sizeof *w.runs),
                     .stack = malloc((most + 1) * sizeof *w.stack),
                     .pipes = malloc((most + 1) * sizeof *w.pipes),
                     .loads = calloc(most + 1, sizeof *w.loads)};
    *gutters = (host_gutters){.sites = NULL};
    const bool ok = w.runs && w.stack && w.pipes && w.loads && work(&w, pipes, pipe_count, gutters);
    free(w.runs);
    free(w.stack);
    free(w.pipes);
    free(w.loads);
    return ok;
}
