/* gpu/budget.c - an effect that does not fit into what the memory budget has left is made with smaller pools.
 *
 * An estimate would only be an upper bound, and pages fragment what is left. So an effect is simply created, smaller
 * each time, until it fits. Every create makes its pipelines last, so an attempt costs no more than some buffers. */
#include "gpu/budget.h"

#include "gpu/context.h"

#include <stdio.h>

#define SHARE 0.75 /* of the previous size, with each attempt: a tenth after nine */

/* The size of a pool at a share of the requested size: a multiple of its unit, or a power of two. */
static uint32_t size_at(const virga_pool *pool, uint32_t requested, double share)
{
    uint32_t size = (uint32_t)(requested * share), power = 1;
    while (power <= size / 2)
        power *= 2;
    size = pool->unit ? size / pool->unit * pool->unit : power;
    size = size > pool->min_size ? size : pool->min_size;
    return size < requested ? size : requested;
}

/* Whether any pool would be smaller at that share than it is now. */
static bool can_shrink(const virga_pool *pools, const uint32_t *requested, uint32_t count, double share)
{
    for (uint32_t i = 0; i < count; i++)
        if (size_at(&pools[i], requested[i], share) < *pools[i].size)
            return true;
    return false;
}

/* Logs the pools that are smaller than requested. False if there are none. */
static bool log_shrunk_pools(const virga_context *context, const char *what, const virga_pool *pools,
                             const uint32_t *requested, uint32_t count)
{
    char list[VIRGA_LOG_LINE];
    int at = 0;
    list[0] = 0;
    for (uint32_t i = 0; i < count && at < (int)sizeof list; i++)
        if (*pools[i].size != requested[i])
            at += snprintf(list + at, sizeof list - (size_t)at, "%s%s %u (of %u)", at ? ", " : "", pools[i].name,
                           *pools[i].size, requested[i]);
    if (at)
        virga_log_say(&context->log, VIRGA_LOG_WARNING, VIRGA_LOG_SHRUNK,
                      "%s is made smaller for the memory budget: %s", what, list);
    return at > 0;
}

virga_result virga_make_in_budget(virga_context *context, const char *what, const virga_pool *pools, uint32_t count,
                                  virga_result (*make)(virga_context *context, const void *def, void **made),
                                  const void *def, void **made)
{
    uint32_t requested[VIRGA_MAX_POOLS];
    virga_result result;
    double share = 1;
    for (uint32_t i = 0; i < count; i++)
        requested[i] = *pools[i].size;
    for (;;) {
        for (uint32_t i = 0; i < count; i++)
            *pools[i].size = share < 1 ? size_at(&pools[i], requested[i], share) : requested[i];
        /* Some pools may have reached their minimum already while others can still shrink. */
        share *= SHARE;
        while (share > 1e-6 && !can_shrink(pools, requested, count, share))
            share *= SHARE;
        context->making = true;
        context->over_budget = false;
        context->may_shrink = share > 1e-6;
        result = make(context, def, made);
        const bool again = result == VIRGA_ERROR_DEVICE_MEMORY && context->over_budget && context->may_shrink;
        context->making = context->may_shrink = false;
        if (!again)
            break;
    }
    if (result < 0 || !log_shrunk_pools(context, what, pools, requested, count))
        return result;
    return VIRGA_DEGRADED;
}
