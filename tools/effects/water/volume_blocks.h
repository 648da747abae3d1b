/* volume_blocks.h - the density on a grid as what volume_write takes. */
#ifndef VIRGA_EFFECTS_WATER_VOLUME_BLOCKS_H
#define VIRGA_EFFECTS_WATER_VOLUME_BLOCKS_H

#include "field.h"
#include "volume.h"

/* Of a grid that lives as long as the volume is used. The caller sets `origin_m` and `surface`. */
volume field_volume(const field *from);

#endif
