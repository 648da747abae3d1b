/* spirv_count.h - a copy of a shader that counts how often each of its blocks runs.
 *
 * At the start of each block, two numbers of a storage buffer grow: by the lanes of the subgroup that run it, and by
 * one. Results of the shader stay the same. Nothing is atomic, which would take a hundred times as long: only one
 * thread may run the shader, and all lanes of a subgroup at once, as on software Vulkan with LP_NUM_THREADS=1. Vertex
 * shaders have no ballots there; their subgroups count as full. */
#ifndef VIRGA_BENCH_MODEL_SPIRV_COUNT_H
#define VIRGA_BENCH_MODEL_SPIRV_COUNT_H

#include "bench/model/block_cost.h"

typedef struct spirv_count_def {
    const uint32_t *code; /* a valid module with one entry point */
    size_t word_count;
    const block_costs *costs; /* of the module: blocks without cost, and those that run as another, are not counted */
    uint32_t set;             /* descriptor set of the buffer, binding 0 */
    uint32_t first; /* the buffer's first number; block i has first + 2 i (lanes), first + 2 i + 1 (subgroups) */
} spirv_count_def;

/* The copy, to be freed. NULL: no memory. */
uint32_t *spirv_count_blocks(const spirv_count_def *def, size_t *word_count);

#endif
