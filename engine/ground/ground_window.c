/* ground/ground_window.c - which tiles are in the window, which are cached, which are evicted. */
#include "ground/ground_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The window does not move while its middle is at most this many tiles from the camera. */
#define HYSTERESIS_TILES 1

void ground_window_wanted(const ground_window *window, const double camera_m[3], double tile_m, int32_t low[2])
{
    for (int axis = 0; axis < 2; axis++) {
        const double at = floor(camera_m[axis * 2] / tile_m);
        /* Cell numbers must fit into an int. */
        const double max = INT32_MAX / VIRGA_GROUND_TILE - 2.0 * window->tiles;
        const int32_t wanted = (int32_t)fmin(fmax(at, -max), max) - (int32_t)window->tiles / 2;
        low[axis] =
            window->is_placed && abs(wanted - window->low[axis]) <= HYSTERESIS_TILES ? window->low[axis] : wanted;
    }
}

/* Slot of a tile in the window's buffers. */
static uint32_t slot_of(const ground_window *window, int32_t x, int32_t z)
{
    const uint32_t mask = window->tiles - 1;
    return ((uint32_t)z & mask) * window->tiles + ((uint32_t)x & mask);
}

static bool inside(const ground_window *window, const int32_t low[2], int32_t x, int32_t z)
{
    return x >= low[0] && z >= low[1] && x - low[0] < (int32_t)window->tiles && z - low[1] < (int32_t)window->tiles;
}

static uint32_t find_cached(const ground_window *window, int32_t x, int32_t z)
{
    for (uint32_t i = 0; i < window->cache_capacity; i++)
        if (window->cache[i].since && window->cache[i].tile[0] == x && window->cache[i].tile[1] == z)
            return i;
    return GROUND_NEW;
}

/* A free cache slot, or the slot of the tile that left the window longest ago. The cache holds at least twice the tiles
 * of the window, so there is always a slot that the current move does not need. */
static uint32_t evict_tile(ground_window *window, ground_move *move)
{
    uint32_t oldest = GROUND_NEW;
    for (uint32_t i = 0; i < window->cache_capacity; i++) {
        if (!window->cache[i].since)
            return i;
        if (!window->cache[i].wanted && window->cache[i].since < window->moves &&
            (oldest == GROUND_NEW || window->cache[i].since < window->cache[oldest].since))
            oldest = i;
    }
    move->forgotten[move->forgotten_count++] = oldest;
    window->cached_count--;
    return oldest;
}

static void enter(ground_window *window, const int32_t low[2], ground_move *move)
{
    for (int32_t z = low[1]; z < low[1] + (int32_t)window->tiles; z++)
        for (int32_t x = low[0]; x < low[0] + (int32_t)window->tiles; x++) {
            if (window->is_placed && inside(window, window->low, x, z))
                continue;
            const uint32_t from = find_cached(window, x, z);
            if (from != GROUND_NEW)
                window->cache[from].wanted = true;
            move->entering[move->entering_count] = slot_of(window, x, z);
            move->entering_from[move->entering_count++] = from;
        }
}

static void leave(ground_window *window, const int32_t low[2], ground_move *move)
{
    for (int32_t z = window->low[1]; z < window->low[1] + (int32_t)window->tiles; z++)
        for (int32_t x = window->low[0]; x < window->low[0] + (int32_t)window->tiles; x++) {
            if (inside(window, low, x, z))
                continue;
            const uint32_t to = evict_tile(window, move);
            window->cache[to] = (ground_cached_tile){.tile = {x, z}, .since = window->moves};
            window->cached_count++;
            move->leaving[move->leaving_count] = slot_of(window, x, z);
            move->leaving_to[move->leaving_count++] = to;
        }
}

static void remember(ground_window *window)
{
    memcpy(window->low_before, window->low, sizeof window->low);
    memcpy(window->cache_before, window->cache, window->cache_capacity * sizeof *window->cache);
    window->was_placed = window->is_placed;
    window->cached_count_before = window->cached_count;
}

void ground_window_undo(ground_window *window)
{
    memcpy(window->low, window->low_before, sizeof window->low);
    memcpy(window->cache, window->cache_before, window->cache_capacity * sizeof *window->cache);
    window->is_placed = window->was_placed;
    window->cached_count = window->cached_count_before;
}

void ground_window_forget(ground_window *window)
{
    memset(window->cache, 0, window->cache_capacity * sizeof *window->cache);
    window->is_placed = false;
    window->cached_count = 0;
}

void ground_window_move(ground_window *window, const int32_t low[2], ground_move *move)
{
    move->leaving_count = move->entering_count = move->forgotten_count = 0;
    if (window->is_placed && low[0] == window->low[0] && low[1] == window->low[1])
        return;
    remember(window);
    window->moves++;
    enter(window, low, move);
    if (window->is_placed)
        leave(window, low, move);
    for (uint32_t i = 0; i < move->entering_count; i++)
        if (move->entering_from[i] != GROUND_NEW) {
            window->cache[move->entering_from[i]] = (ground_cached_tile){0};
            window->cached_count--;
        }
    window->low[0] = low[0];
    window->low[1] = low[1];
    window->is_placed = true;
}

uint32_t ground_window_cache_end(const ground_window *window)
{
    uint32_t end = window->cached_count ? window->cache_capacity : 0;
    while (end && !window->cache[end - 1].since)
        end--;
    return end;
}
