/* layers.h - the layers of a frame. */
#ifndef VIRGA_TOOL_FRAME_LAYERS_H
#define VIRGA_TOOL_FRAME_LAYERS_H

#include "effect.h"

#define FRAME_MAX_LAYERS 32 /* layers are bits */

typedef struct frame_layer_row {
    const tool_effect *effect; /* NULL: of the plate */
    const tool_layer *layer;
} frame_layer_row;

/* By the number of its bit; NULL behind the last. */
const frame_layer_row *frame_layer(uint32_t index);

/* Bits of a list such as "beauty,rain"; NULL: all. Prints one line and returns false for a wrong name. */
bool frame_layers_parse(const char *list, uint32_t *layers);

/* Leaves out the layers that the scene has nothing for. Prints one line and returns false where none is left. */
bool frame_layers_narrow(const scene_file *scene, uint32_t *layers);

/* What of a plate these layers need. Those of effects need all of it, as water shows what is behind it. */
host_plate_parts frame_layers_parts(uint32_t layers);

/* Layers that a picture with these channels (as exr_header has them) holds, and their list as --layers reads it. */
uint32_t frame_layers_in(const char *channels);
void frame_layers_print(uint32_t layers, char *text, size_t size);

/* Prints what layers there are: a line each, with channels. */
void frame_layers_help(void);

#endif
