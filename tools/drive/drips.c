/* drips.c - which edges of a street drip. */
#include "drips.h"

#include <stdlib.h>
#include <string.h>

#define NEAREST_M 2.0 /* what is nearer shows no more: its drops leave the picture sooner */
#define MOVED_M   1.0 /* the camera, until places are chosen anew */
#define KEPT      1.5 /* what has a slot counts as so much more, so that places do not change back at once */

bool drip_places_create(virga_drip_site *all, uint32_t count, uint32_t slots, drip_places *places)
{
    const size_t room = (size_t)count + (size_t)slots + 1;
    *places = (drip_places){.all = all,
                            .count = count,
                            .slots = slots,
                            .slot = malloc(room * sizeof *places->slot),
                            .ranks = malloc(room * sizeof *places->ranks)};
    for (uint32_t i = 0; places->slot && i < count; i++) {
        places->slot[i] = slots;
        places->all[i].place = i + 1;
    }
    return places->slot && places->ranks;
}

void drip_places_free(drip_places *places)
{
    free(places->all);
    free(places->slot);
    free(places->ranks);
    *places = (drip_places){0};
}

static double apart2(const double a[3], const double b[3])
{
    double sum = 0;
    for (int axis = 0; axis < 3; axis++)
        sum += (a[axis] - b[axis]) * (a[axis] - b[axis]);
    return sum;
}

/* The largest first; of equal ones the first, so that the order is always the same. */
static int by_value(const void *a, const void *b)
{
    const drip_rank *x = a, *y = b;
    return x->value != y->value ? (x->value < y->value) - (x->value > y->value)
                                : (x->place > y->place) - (x->place < y->place);
}

/* What a place shows: its drops in a second, which are in proportion to its catchment, each with an area on the picture
 * that falls with the square of its distance. */
static void rank(drip_places *p, const double eye_m[3])
{
    for (uint32_t i = 0; i < p->count; i++) {
        const double shown = (double)p->all[i].catch_m2 / (apart2(p->all[i].position_m, eye_m) + NEAREST_M * NEAREST_M);
        p->ranks[i] = (drip_rank){p->slot[i] < p->slots ? KEPT * shown : shown, i};
    }
    qsort(p->ranks, p->count, sizeof *p->ranks, by_value);
}

/* Gives the slots of those that are no longer among the first `count` to those that are now. */
static void pass_slots_on(drip_places *p, uint32_t count)
{
    drip_rank *coming = p->ranks + p->count;
    uint32_t leave = 0, enter = 0;
    for (uint32_t i = 0; i < count; i++)
        if (p->slot[p->ranks[i].place] >= p->slots)
            coming[enter++] = p->ranks[i];
    for (uint32_t i = 0; !p->chosen && i < enter; i++) /* at first all slots are free */
        p->slot[coming[i].place] = i;
    for (uint32_t i = count; i < p->count && leave < enter; i++) {
        uint32_t *old = &p->slot[p->ranks[i].place];
        if (*old >= p->slots)
            continue;
        p->slot[coming[leave++].place] = *old;
        *old = p->slots;
    }
}

uint32_t drip_places_choose(drip_places *p, const double eye_m[3], virga_drip_site *sites)
{
    const uint32_t count = p->count < p->slots ? p->count : p->slots;
    if (p->chosen && apart2(p->eye_m, eye_m) < MOVED_M * MOVED_M)
        return count;
    rank(p, eye_m);
    pass_slots_on(p, count);
    memcpy(p->eye_m, eye_m, sizeof p->eye_m);
    p->chosen = true;
    for (uint32_t i = 0; i < p->count; i++)
        if (p->slot[i] < p->slots)
            sites[p->slot[i]] = p->all[i];
    return count;
}
