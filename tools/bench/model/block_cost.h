/* block_cost.h - what one run of each block of a shader costs, in operations and bytes.
 *
 * A block is straight code between two labels: whatever runs its first instruction runs all. So a shader's work is its
 * blocks' costs times how often each was run, which spirv_count.h counts. */
#ifndef VIRGA_BENCH_MODEL_BLOCK_COST_H
#define VIRGA_BENCH_MODEL_BLOCK_COST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define BLOCK_RESOURCES 32 /* buffers and images of one shader */

/* A descriptor that the shader reads or writes. */
typedef struct block_resource {
    uint32_t set, binding;
} block_resource;

/* Of one lane, where nothing else is said. */
typedef struct block_cost {
    float full;       /* operations of one issue: add, multiply, compare, ... of each component */
    float slow;       /* of a quarter of that rate: reciprocal, root, sine, multiplication of integers, ... */
    float memory;     /* loads and stores of buffers, at addresses of the lane's own */
    float shared;     /* loads, stores and atomics of workgroup memory, and exchanges between lanes */
    float fetch;      /* texels by their place */
    float sample;     /* filtered texels */
    float atomic;     /* of buffers and images */
    float uniform;    /* loads of storage buffers and images that are the same for the whole wave */
    float constant;   /* loads of uniform buffers that are */
    float branch;     /* conditional */
    float barrier;    /* of the workgroup */
    bool waits;       /* it loads from memory: one step of the chain of loads that wait for each other */
    uint32_t runs_as; /* the block that always runs as often as this one, before it; itself: there is none */
    float bytes_read[BLOCK_RESOURCES], bytes_written[BLOCK_RESOURCES];
} block_cost;

typedef struct block_costs {
    uint32_t stage; /* STAGE_ of spirv_words.h */
    uint32_t local_size[3];
    block_resource resources[BLOCK_RESOURCES];
    uint32_t resource_count;
    block_cost *blocks; /* in the order of their labels */
    uint32_t block_count;
} block_costs;

/* Costs of a valid module with one entry point. False: no memory. */
bool block_costs_read(const uint32_t *code, size_t word_count, block_costs *costs);
void block_costs_free(block_costs *costs);

/* Whether the block, or one that runs as it does, has any cost: others need not be counted. */
bool block_costs_anything(const block_costs *costs, uint32_t block);

#endif
