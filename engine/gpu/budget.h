/* gpu/budget.h - effects that do not fit into the memory budget are made smaller. Internal. */
#ifndef VIRGA_GPU_BUDGET_H
#define VIRGA_GPU_BUDGET_H

#include <virga/vulkan.h>

#define VIRGA_MAX_POOLS 8

/* A size in an effect's definition that may be reduced. */
typedef struct virga_pool {
    const char *name;
    uint32_t *size, min_size;
    uint32_t unit; /* the size stays a multiple of it; 0: a power of two */
} virga_pool;

/* Makes an effect from its definition, which contains the pools. If it does not fit into the memory budget, it is made
 * with smaller pools; this is logged, and the result is VIRGA_DEGRADED. `make` leaves nothing behind if it fails. */
virga_result virga_make_in_budget(virga_context *context, const char *what, const virga_pool *pools, uint32_t count,
                                  virga_result (*make)(virga_context *context, const void *def, void **made),
                                  const void *def, void **made);

#endif
