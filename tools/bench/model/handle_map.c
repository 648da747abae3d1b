/* handle_map.c - see handle_map.h. A hash table with open addresses. Handles are not taken out: a driver that uses one
 * again replaces what was known of it. */
#include "bench/model/handle_map.h"

#include <stdlib.h>

static size_t place_of(const handle_map *map, uint64_t key)
{
    size_t at = (size_t)(key * 0x9e3779b97f4a7c15u >> 20) & (map->capacity - 1);
    while (map->keys[at] && map->keys[at] != key)
        at = (at + 1) & (map->capacity - 1);
    return at;
}

void *handle_map_find(const handle_map *map, uint64_t key)
{
    return map->capacity && key ? map->values[place_of(map, key)] : NULL;
}

static bool grow(handle_map *map)
{
    handle_map larger = {.capacity = map->capacity ? 2 * map->capacity : 256, .count = map->count};
    larger.keys = calloc(larger.capacity, sizeof *larger.keys);
    larger.values = calloc(larger.capacity, sizeof *larger.values);
    if (!larger.keys || !larger.values) {
        free(larger.keys);
        free(larger.values);
        return false;
    }
    for (size_t i = 0; i < map->capacity; i++)
        if (map->keys[i]) {
            const size_t at = place_of(&larger, map->keys[i]);
            larger.keys[at] = map->keys[i];
            larger.values[at] = map->values[i];
        }
    free(map->keys);
    free(map->values);
    *map = larger;
    return true;
}

bool handle_map_put(handle_map *map, uint64_t key, void *value)
{
    if (!value || (2 * map->count >= map->capacity && !grow(map))) {
        free(value);
        return false;
    }
    const size_t at = place_of(map, key);
    map->count += !map->keys[at];
    free(map->values[at]);
    map->keys[at] = key;
    map->values[at] = value;
    return true;
}

void handle_map_free(handle_map *map)
{
    for (size_t i = 0; i < map->capacity; i++)
        free(map->values[i]);
    free(map->keys);
    free(map->values);
    *map = (handle_map){0};
}
