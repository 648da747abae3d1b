/* gpu/effect_settle.h - what became of completed frames. Internal. */
#ifndef VIRGA_GPU_EFFECT_SETTLE_H
#define VIRGA_GPU_EFFECT_SETTLE_H

#include "gpu/effect_type.h"

/* For all effects of a context: learns which calls of completed frames the device has executed, and lets effects do
 * again what is lost. `dropped` is a frame that the host has thrown away; 0: none. */
void virga_effects_settle(virga_context *context, uint64_t dropped);

#endif
