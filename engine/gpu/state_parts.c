/* gpu/state_parts.c - what of an effect belongs to a saved state, see state_parts.h. */
#include "gpu/state_parts.h"

#include "gpu/effect.h"
#include "gpu/state_bytes.h"

VkDeviceSize virga_state_aligned(VkDeviceSize size)
{
    return (size + VIRGA_STATE_ALIGNMENT - 1) / VIRGA_STATE_ALIGNMENT * VIRGA_STATE_ALIGNMENT;
}

/* Buffers that passes write anew before they read them have no state. */
static bool is_state_buffer(const virga_effect_buffer *row)
{
    return !row->scratch && !row->per_view && (row->keeps || row->first == VIRGA_FIRST_FILL);
}

virga_buffer *virga_state_buffer(const virga_effect *effect, const virga_effect_buffer *row)
{
    return is_state_buffer(row) ? *(virga_buffer **)virga_effect_member(effect, row->member) : NULL;
}

virga_image_2d *virga_state_image(const virga_effect *effect, const virga_effect_image *row)
{
    return row->keeps && !row->per_view ? *(virga_image_2d **)virga_effect_member(effect, row->member) : NULL;
}

void *virga_state_host_part(const virga_effect *effect, const virga_effect_state_row *row)
{
    void *member = virga_effect_member(effect, row->member);
    return row->pointed ? *(void **)member : member;
}

VkDeviceSize virga_state_host_bytes(const virga_effect *effect, const virga_effect_state_row *row)
{
    VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS];
    if (!row->count)
        return row->bytes;
    virga_effect_counts(effect, counts);
    return row->bytes * counts[row->count];
}
