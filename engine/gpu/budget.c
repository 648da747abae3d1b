/* gpu/budget.c - an effect that does not fit into what the memory budget has left is made with smaller pools.
 *
 * An estimate is an upper bound, and what is left is cut by pages; so an effect is simply tried, smaller each time,
 * until it fits. Pipelines come last in every create, so that a try costs the making of some buffers and no more. */
#include "gpu/budget.h"

#include "gpu/context.h"
#include "gpu/effect.h"

#include <stdio.h>

#define SHRINK    0.75 /* of the size before, with each try: nine of them come down to a tenth */
#define MIN_SHARE 1e-6 /* all pools have reached their minimum */

/* The pools of a definition while it is tried. */
typedef struct budget_try {
    const virga_effect_type *type;
    char *def;
    uint32_t requested[VIRGA_MAX_POOLS];
} budget_try;

static uint32_t *pool_size(const budget_try *attempt, uint32_t i)
{
    return (uint32_t *)(attempt->def + attempt->type->pools[i].member);
}

/* The size of a pool at a share of what it was asked to be: a whole number of units, or a power of two. */
static uint32_t size_at(const virga_effect_pool *pool, uint32_t requested, double share)
{
    uint32_t size = (uint32_t)(requested * share), power = 1;
    while (power <= size / 2)
        power *= 2;
    size = pool->unit ? size / pool->unit * pool->unit : power;
    size = size > pool->min ? size : pool->min;
    return size < requested ? size : requested;
}

/* Whether any pool would be smaller at that share than it is now. */
static bool can_shrink(const budget_try *attempt, double share)
{
    for (uint32_t i = 0; i < attempt->type->pool_count; i++)
        if (size_at(&attempt->type->pools[i], attempt->requested[i], share) < *pool_size(attempt, i))
            return true;
    return false;
}

/* False where no pool is smaller than it was asked to be. */
static bool log_shrunk(const virga_context *context, const budget_try *attempt)
{
    char list[VIRGA_LOG_LINE];
    int at = 0;
    list[0] = 0;
    for (uint32_t i = 0; i < attempt->type->pool_count && at < (int)sizeof list; i++)
        if (*pool_size(attempt, i) != attempt->requested[i])
            at += snprintf(list + at, sizeof list - (size_t)at, "%s%s %u (of %u)", at ? ", " : "",
                           attempt->type->pools[i].name, *pool_size(attempt, i), attempt->requested[i]);
    if (at)
        virga_log_write(&context->log, VIRGA_LOG_WARNING, VIRGA_LOG_SHRUNK,
                        "%s is made smaller for the memory budget: %s", attempt->type->name, list);
    return at > 0;
}

virga_result virga_make_in_budget(virga_context *context, const virga_effect_type *type, void *def, virga_effect **made)
{
    budget_try attempt = {.type = type, .def = def};
    virga_result result;
    double share = 1;
    for (uint32_t i = 0; i < type->pool_count; i++)
        attempt.requested[i] = *pool_size(&attempt, i);
    for (;;) {
        for (uint32_t i = 0; i < type->pool_count; i++)
            *pool_size(&attempt, i) =
                share < 1 ? size_at(&type->pools[i], attempt.requested[i], share) : attempt.requested[i];
        /* From here on some may have reached their minimum while others have steps to go. */
        share *= SHRINK;
        while (share > MIN_SHARE && !can_shrink(&attempt, share))
            share *= SHRINK;
        context->making = true;
        context->over_budget = false;
        context->may_shrink = share > MIN_SHARE;
        result = virga_effect_make(context, type, def, made);
        const bool again = result == VIRGA_ERROR_DEVICE_MEMORY && context->over_budget && context->may_shrink;
        context->making = context->may_shrink = false;
        if (!again)
            break;
    }
    if (result < 0 || !log_shrunk(context, &attempt))
        return result;
    return VIRGA_DEGRADED;
}
