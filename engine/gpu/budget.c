/* gpu/budget.c - creates effects with smaller pools if they do not fit into the rest of the memory budget.
 *
 * An estimate is only an upper bound, and the rest of the budget is divided into pages. So an effect is simply tried,
 * smaller each time, until it fits. Pipelines are created last, so a failed try only costs the creation of some
 * buffers. */
#include "gpu/budget.h"

#include "gpu/context.h"
#include "gpu/effect_type.h"

#include <stdio.h>

#define SHRINK    0.75 /* factor of the size with each try: nine tries reduce it to less than a tenth */
#define MIN_SHARE 1e-6 /* all pools have reached their minimum */

static uint32_t *pool_size(const virga_budget_try *attempt, uint32_t i)
{
    return (uint32_t *)(attempt->def + attempt->type->pools[i].member);
}

/* The size of a pool at a share of its requested size: a multiple of its unit, or a power of two. */
static uint32_t size_at(const virga_effect_pool *pool, uint32_t requested, double share)
{
    uint32_t size = (uint32_t)(requested * share), power = 1;
    if (share >= 1)
        return requested;
    while (power <= size / 2)
        power *= 2;
    size = pool->unit ? size / pool->unit * pool->unit : power;
    size = size > pool->min ? size : pool->min;
    return size < requested ? size : requested;
}

/* Whether any pool would be smaller with this share than it is now. */
static bool can_shrink(const virga_budget_try *attempt, double share)
{
    for (uint32_t i = 0; i < attempt->type->pool_count; i++)
        if (size_at(&attempt->type->pools[i], attempt->requested[i], share) < *pool_size(attempt, i))
            return true;
    return false;
}

static void begin_try(virga_context *context, virga_budget_try *attempt)
{
    const virga_effect_type *type = attempt->type;
    for (uint32_t i = 0; i < type->pool_count; i++)
        *pool_size(attempt, i) = size_at(&type->pools[i], attempt->requested[i], attempt->share);
    /* Some pools may have reached their minimum, while others can still shrink. */
    do
        attempt->share *= SHRINK;
    while (attempt->share > MIN_SHARE && !can_shrink(attempt, attempt->share));
    context->making = true;
    context->over_budget = false;
    context->may_shrink = attempt->share > MIN_SHARE;
}

void virga_budget_begin(virga_context *context, const virga_effect_type *type, void *def, virga_budget_try *attempt)
{
    *attempt = (virga_budget_try){.type = type, .def = def, .share = 1};
    for (uint32_t i = 0; i < type->pool_count; i++)
        attempt->requested[i] = *pool_size(attempt, i);
    begin_try(context, attempt);
}

bool virga_budget_retry(virga_context *context, virga_budget_try *attempt, virga_result result)
{
    const bool again = result == VIRGA_ERROR_DEVICE_MEMORY && context->over_budget && context->may_shrink;
    context->making = context->may_shrink = false;
    if (again)
        begin_try(context, attempt);
    return again;
}

bool virga_budget_log(const virga_context *context, const virga_budget_try *attempt)
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
