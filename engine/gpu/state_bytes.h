/* gpu/state_bytes.h - the format of a saved state, and its hash. Internal.
 *
 *   header   virga_state_header
 *   section  one for each effect: virga_state_section, then
 *              the values of its definition that the simulation depends on, as doubles in the order of the rows
 *              the values of such settings
 *              what the object holds on the host, in the order of virga_effect_type.state_rows
 *              buffers and images, each from a multiple of VIRGA_STATE_ALIGNMENT on
 *
 * All numbers are those of the machine: states are not exchanged between machines of different byte order. */
#ifndef VIRGA_GPU_STATE_BYTES_H
#define VIRGA_GPU_STATE_BYTES_H

#include <virga/state.h>

#define VIRGA_STATE_MAGIC     "virgast" /* 8 bytes with its zero */
#define VIRGA_STATE_ALIGNMENT 16u       /* of sections, buffers and images: a texel's largest size */

typedef struct virga_state_header {
    char magic[8];
    uint32_t version, effects;
    uint64_t bytes;       /* of all, a multiple of VIRGA_STATE_ALIGNMENT */
    uint64_t frame_index; /* in which it was saved */
    uint64_t hash;        /* 0: not sealed */
    uint32_t vendor_id, device_id, driver_version, pad;
    uint64_t reserved;
} virga_state_header;

_Static_assert(sizeof(virga_state_header) % VIRGA_STATE_ALIGNMENT == 0, "the first section is aligned");

typedef struct virga_state_section {
    char name[16]; /* log_name of the type */
    uint32_t index, def_values, setting_values, pad;
    uint64_t host_bytes, device_bytes;
} virga_state_section;

_Static_assert(sizeof(virga_state_section) % VIRGA_STATE_ALIGNMENT == 0, "sections have no padding");

#endif
