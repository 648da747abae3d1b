/* gpu/state_check.c - checks the contents of a saved state, see state_check.h. */
#include "gpu/state_check.h"

#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/state_parts.h"

const void *virga_state_saved_row(const virga_state_check *check, const void *part)
{
    const char *saved = check->host;
    for (uint32_t i = 0; i < check->effect->type->state_row_count; i++) {
        const virga_effect_state_row *row = &check->effect->type->state_rows[i];
        if (virga_state_host_part(check->effect, row) == part)
            return saved;
        saved += virga_state_aligned(virga_state_host_bytes(check->effect, row));
    }
    return NULL;
}

const void *virga_state_saved_buffer(const virga_state_check *check, const virga_buffer *buffer)
{
    const char *saved = check->device;
    for (uint32_t i = 0; i < check->effect->type->buffer_count; i++) {
        const virga_buffer *here = virga_state_buffer(check->effect, &check->effect->type->buffers[i]);
        if (here && here == buffer)
            return saved;
        saved += here ? virga_state_aligned(here->size) : 0;
    }
    return NULL;
}

void virga_state_refuse(virga_state_check *check, const char *name, double value, double min, double max)
{
    if (!check->failed)
        virga_wrong_argument(&check->effect->context->log, "%s: %s: the state has %.15g, expected %.15g to %.15g",
                             check->call, name, value, min, max);
    check->failed = true;
}

void virga_state_check_rows(virga_state_check *check)
{
    const char *saved = check->host;
    for (uint32_t i = 0; i < check->effect->type->state_row_count; i++) {
        const virga_effect_state_row *row = &check->effect->type->state_rows[i];
        const VkDeviceSize bytes = virga_state_host_bytes(check->effect, row);
        for (VkDeviceSize at = 0; row->kind == VIRGA_STATE_BOOLS && at < bytes; at++)
            virga_state_expect(check, row->name, ((const unsigned char *)saved)[at], 0, 1);
        for (VkDeviceSize at = 0; row->kind == VIRGA_STATE_DOUBLES && at < bytes; at += sizeof(double))
            virga_state_expect(check, row->name, *(const double *)(saved + at), -VIRGA_STATE_MAX_NUMBER,
                               VIRGA_STATE_MAX_NUMBER);
        saved += virga_state_aligned(bytes);
    }
}
