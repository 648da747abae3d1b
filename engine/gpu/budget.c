/* gpu/budget.c - an effect that does not fit into what the memory budget has left is made with smaller pools.
 *
 * An estimate is an upper bound, and what is left is cut by pages; so an effect is simply tried, smaller each time,
 * until it fits. Pipelines come last in every create, so that a try costs the making of some buffers and no more. */
#include "gpu/budget.h"

#include "gpu/context.h"

#include <stdio.h>

#define SHARE 0.75 /* of the size before, with each try: nine of them come down to a tenth */

/* The size of a pool at a share of what it was asked to be: a whole number of units, or a power of two. */
static uint32_t size_at(const virga_pool *pool, uint32_t asked, double share)
{
    uint32_t size = (uint32_t)(asked * share), power = 1;
    while (power <= size / 2)
        power *= 2;
    size = pool->unit ? size / pool->unit * pool->unit : power;
    size = size > pool->least ? size : pool->least;
    return size < asked ? size : asked;
}

/* Whether any of them would be smaller at that share than it is now. */
static bool can_shrink(const virga_pool *pools, const uint32_t *asked, uint32_t count, double share)
{
    for (uint32_t i = 0; i < count; i++)
        if (size_at(&pools[i], asked[i], share) < *pools[i].size)
            return true;
    return false;
}

/* False where nothing is smaller than it was asked to be. */
static bool say_shrunk(const virga_context *context, const char *what, const virga_pool *pools, const uint32_t *asked,
                       uint32_t count)
{
    char list[VIRGA_LOG_LINE];
    int at = 0;
    list[0] = 0;
    for (uint32_t i = 0; i < count && at < (int)sizeof list; i++)
        if (*pools[i].size != asked[i])
            at += snprintf(list + at, sizeof list - (size_t)at, "%s%s %u (of %u)", at ? ", " : "", pools[i].name,
                           *pools[i].size, asked[i]);
    if (at)
        virga_log_say(&context->log, VIRGA_LOG_WARNING, VIRGA_LOG_SHRUNK,
                      "%s is made smaller for the memory budget: %s", what, list);
    return at > 0;
}

virga_result virga_make_in_budget(virga_context *context, const char *what, const virga_pool *pools, uint32_t count,
                                  virga_result (*make)(virga_context *context, const void *def, void **made),
                                  const void *def, void **made)
{
    uint32_t asked[VIRGA_MAX_POOLS];
    virga_result result;
    double share = 1;
    for (uint32_t i = 0; i < count; i++)
        asked[i] = *pools[i].size;
    for (;;) {
        for (uint32_t i = 0; i < count; i++)
            *pools[i].size = share < 1 ? size_at(&pools[i], asked[i], share) : asked[i];
        /* From here on some may have reached their least while others have steps to go. */
        share *= SHARE;
        while (share > 1e-6 && !can_shrink(pools, asked, count, share))
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
    if (result < 0 || !say_shrunk(context, what, pools, asked, count))
        return result;
    return VIRGA_DEGRADED;
}
