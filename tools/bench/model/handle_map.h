/* handle_map.h - something to be known of each Vulkan handle. */
#ifndef VIRGA_BENCH_MODEL_HANDLE_MAP_H
#define VIRGA_BENCH_MODEL_HANDLE_MAP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct handle_map {
    uint64_t *keys; /* 0: free */
    void **values;
    size_t capacity, count;
} handle_map;

void *handle_map_find(const handle_map *map, uint64_t key);

/* Replaces what was known, which is freed, as the map owns it. False: no memory; then the value is freed. */
bool handle_map_put(handle_map *map, uint64_t key, void *value);
void handle_map_free(handle_map *map);

#endif
