/* gpu/budget.h - creates effects with smaller pools to fit the memory budget. Internal. */
#ifndef VIRGA_GPU_BUDGET_H
#define VIRGA_GPU_BUDGET_H

#include <virga/vulkan.h>

#define VIRGA_MAX_POOLS 8

struct virga_effect;
struct virga_effect_type;

/* Creates an effect from a definition that was checked. If it does not fit into the memory budget, it is created with
 * smaller pools; this is logged, and the result is VIRGA_DEGRADED. Changes `def`. */
virga_result virga_make_in_budget(virga_context *context, const struct virga_effect_type *type, void *def,
                                  struct virga_effect **made);

#endif
