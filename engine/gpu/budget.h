/* gpu/budget.h - makes the pools of a definition smaller until the effect fits the memory budget. Internal.
 *
 *     virga_budget_begin(context, type, def, &attempt);
 *     do
 *         result = create(def);
 *     while (virga_budget_retry(context, &attempt, result));
 */
#ifndef VIRGA_GPU_BUDGET_H
#define VIRGA_GPU_BUDGET_H

#include <virga/vulkan.h>

#define VIRGA_MAX_POOLS 8

struct virga_effect_type;

/* The pools of a definition during the tries. */
typedef struct virga_budget_try {
    const struct virga_effect_type *type;
    char *def;
    uint32_t requested[VIRGA_MAX_POOLS];
    double share; /* of the requested sizes, in the next try */
} virga_budget_try;

/* Begins the first try. `def` was checked; its sizes may become smaller. */
void virga_budget_begin(virga_context *context, const struct virga_effect_type *type, void *def,
                        virga_budget_try *attempt);

/* Ends a try. If it exceeded the budget and pools can still shrink, makes them smaller, begins the next try and returns
 * true. */
bool virga_budget_retry(virga_context *context, virga_budget_try *attempt, virga_result result);

/* Logs the pools that are smaller than requested. False if none is. */
bool virga_budget_log(const virga_context *context, const virga_budget_try *attempt);

#endif
