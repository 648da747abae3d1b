/* particle_fade.c - which particles appear and vanish near a time, and how much of them is there. */
#include "particle_fade.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double fade_half(double fade_s, double interval_s)
{
    return fmin(fmax(0.5 * fade_s / interval_s, 0.5), FADE_MOST_FILES);
}

fade_window fade_window_at(double files, double half_fade, uint32_t count)
{
    const double last = (double)count - 1;                                          /* of the files */
    const double now = fmin(fmax(files, -FADE_MOST_FILES), last + FADE_MOST_FILES); /* a number in any case */
    fade_window window = {now, half_fade, 0, -1};
    /* The middle of the edge m is at m + 1/2: those that are less than half a fade away. */
    const double low = floor(now - half_fade - 0.5) + 1, high = ceil(now + half_fade - 0.5) - 1;
    window.first = (int64_t)fmax(low, 0);
    window.last = (int64_t)fmin(high, last - 1);
    return window;
}

double fade_share(const fade_window *window, int64_t edge)
{
    const double s = fmin(fmax(0.5 + (window->files - (double)edge - 0.5) / (2 * window->half_fade), 0), 1);
    return s * s * (3 - 2 * s);
}

/* ---- edges */

static void note(fade_edge *edge, const particles *frame, uint32_t row, bool appears)
{
    fade_change *change = &edge->changes[edge->count++];
    *change = (fade_change){.id = frame->id ? frame->id[row] : row, .appears = appears};
    for (int axis = 0; axis < 3; axis++) {
        change->position[axis] = frame->position[row][axis];
        change->velocity[axis] =
            frame->velocity && isfinite(frame->velocity[row][axis]) ? frame->velocity[row][axis] : 0;
    }
}

static bool changes(const particles *frame, const uint32_t *partners, uint32_t row)
{
    const float *at = frame->position[row];
    return partners[row] == PAIR_NONE && isfinite(at[0]) && isfinite(at[1]) && isfinite(at[2]);
}

static uint32_t count_changes(const particles *frame, const uint32_t *partners)
{
    uint32_t count = 0;
    for (uint32_t row = 0; row < frame->count; row++)
        count += changes(frame, partners, row);
    return count;
}

bool fade_edge_make(fade_edge *edge, const particle_pair *pair, int64_t at)
{
    const bool paired = pair->partner_of_a && pair->partner_of_b;
    const size_t count =
        paired ? (size_t)count_changes(pair->a, pair->partner_of_a) + count_changes(pair->b, pair->partner_of_b) : 0;
    *edge = (fade_edge){.at = at, .changes = malloc((count + 1) * sizeof *edge->changes)};
    if (!edge->changes) {
        edge->at = -1;
        return false;
    }
    for (uint32_t row = 0; paired && row < pair->a->count; row++)
        if (changes(pair->a, pair->partner_of_a, row))
            note(edge, pair->a, row, false);
    for (uint32_t row = 0; paired && row < pair->b->count; row++)
        if (changes(pair->b, pair->partner_of_b, row))
            note(edge, pair->b, row, true);
    return true;
}

void fade_edge_free(fade_edge *edge)
{
    free(edge->changes);
    *edge = (fade_edge){.at = -1};
}

/* ---- a time */

/* A particle that appears or vanishes near a time, perhaps more than once. Each time that it is there, it is there by
 * what has appeared times what has not vanished yet. */
typedef struct fading {
    const fade_change *nearest; /* of its changes, to the time */
    double away;                /* of that file, in files; from the file to the time */
    double done;                /* share by the times that it was there and has vanished */
    double open;                /* by that which has not ended */
    bool is_there, is_sampled;
} fading;

typedef struct fading_list {
    fading *items;
    uint32_t count;
    uint32_t *table; /* 1 + index of an item by its id; 0: free */
    uint32_t mask;
} fading_list;

static uint32_t *entry_of(const fading_list *list, uint32_t id)
{
    uint32_t at = (uint32_t)((id * 0x9e3779b97f4a7c15u) >> 32) & list->mask;
    while (list->table[at] && list->items[list->table[at] - 1].nearest->id != id)
        at = (at + 1) & list->mask;
    return &list->table[at];
}

static void add_change(fading_list *list, const fade_window *window, int64_t edge, const fade_change *change)
{
    uint32_t *entry = entry_of(list, change->id);
    const double away = window->files - (double)edge - (change->appears ? 1 : 0), share = fade_share(window, edge);
    if (!*entry) {
        list->items[list->count] = (fading){.nearest = change, .away = away, .open = 1, .is_there = !change->appears};
        *entry = ++list->count;
    }
    fading *item = &list->items[*entry - 1];
    if (fabs(away) < fabs(item->away)) {
        item->nearest = change;
        item->away = away;
    }
    if (!change->appears && item->is_there)
        item->done += item->open * (1 - share);
    item->open = change->appears ? share : 1;
    item->is_there = change->appears;
}

static bool open_list(fading_list *list, size_t changes)
{
    size_t size = 16;
    while (size < 2 * changes)
        size *= 2;
    *list = (fading_list){.items = malloc((changes + 1) * sizeof *list->items),
                          .table = calloc(size, sizeof *list->table),
                          .mask = (uint32_t)(size - 1)};
    return list->items && list->table;
}

static void close_list(fading_list *list)
{
    free(list->items);
    free(list->table);
}

static float share_of(const fading *item)
{
    return (float)fmin(item->done + (item->is_there ? item->open : 0), 1);
}

/* Before the first file and after the last one it stands still, as all do. */
static particle_sample sample_alone(const fading *item, const fade_window *window, double interval_s, double last)
{
    const fade_change *change = item->nearest;
    const double file = window->files - item->away, stopped = fmin(fmax(window->files, 0), last);
    const bool rests = !(window->files >= 0 && window->files < last);
    particle_sample sample = {.share = share_of(item), .id = change->id};
    for (int axis = 0; axis < 3; axis++) {
        const double v = (double)change->velocity[axis];
        sample.position[axis] = (float)((double)change->position[axis] + v * (stopped - file) * interval_s);
        sample.velocity[axis] = rests ? 0 : change->velocity[axis];
    }
    return sample;
}

bool fade_samples(const fade_window *window, const fade_edge *const *edges, double interval_s, uint32_t file_count,
                  particle_sample *samples, uint32_t *count)
{
    fading_list list;
    size_t all = 0;
    for (int64_t edge = window->first; edge <= window->last; edge++)
        all += edges[edge - window->first]->count;
    if (!all)
        return true;
    const bool ok = open_list(&list, all);
    for (int64_t edge = window->first; ok && edge <= window->last; edge++) {
        const fade_edge *from = edges[edge - window->first];
        for (uint32_t i = 0; i < from->count; i++)
            add_change(&list, window, edge, &from->changes[i]);
    }
    for (uint32_t i = 0; ok && i < *count; i++) {
        const uint32_t entry = *entry_of(&list, samples[i].id);
        if (!entry)
            continue;
        list.items[entry - 1].is_sampled = true;
        samples[i].share = share_of(&list.items[entry - 1]);
    }
    for (uint32_t i = 0; ok && i < list.count; i++)
        if (!list.items[i].is_sampled && share_of(&list.items[i]) > 0)
            samples[(*count)++] = sample_alone(&list.items[i], window, interval_s, (double)file_count - 1);
    close_list(&list);
    return ok;
}
