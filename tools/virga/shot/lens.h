/* lens.h - a shot's lens that blurs each sub-frame by its depth. */
#ifndef VIRGA_TOOL_LENS_H
#define VIRGA_TOOL_LENS_H

#include "effect.h"

/* Creates s->lens for the size of the picture, where the scene's camera needs one or may get one. After the target and
 * the effects. */
bool shot_open_lens(shot *s, char *error, size_t error_size);
void shot_close_lens(shot *s);

/* Records what the plate and the layers are out of focus, into s->target.focused. After they are drawn. */
bool shot_record_lens(shot *s, VkCommandBuffer cmd, const tool_moment *at, double focus_inv_m, char *error,
                      size_t error_size);

#endif
