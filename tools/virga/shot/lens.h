/* lens.h - a shot's lens that blurs each sub-frame by its depth. */
#ifndef VIRGA_TOOL_LENS_H
#define VIRGA_TOOL_LENS_H

#include "effect.h"

/* Creates s->lens for the size of the picture, where the scene's camera has an aperture that blurs by depth. After the
 * target and the effects. */
bool shot_open_lens(shot *s, char *error, size_t error_size);
void shot_close_lens(shot *s);

/* Before the layers of a sub-frame are drawn. */
void shot_begin_lens(shot *s);

/* Whether a layer is the first of the last effect that shows what is behind it, with a lens. Then shot_record_behind
 * records what the scene and the layers behind it are out of focus, and gives a picture of it. */
bool shot_lens_has_behind(const shot *s, uint32_t layer);
bool shot_record_behind(shot *s, VkCommandBuffer cmd, const tool_moment *at, virga_image *color, char *error,
                        size_t error_size);

/* Records what the rest is out of focus. After all layers are drawn. With both, the plate's color and the layers are in
 * s->target.focused. */
bool shot_record_lens(shot *s, VkCommandBuffer cmd, const tool_moment *at, char *error, size_t error_size);

#endif
