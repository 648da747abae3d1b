// variants.glsl - whether a pass runs in the way that is fastest on a GPU, or on software Vulkan. A specialisation
// constant of every pipeline; the context chooses, see virga_context_def.variants. Results are the same bits.
#ifndef VARIANTS
#define VARIANTS
layout(constant_id = 4) const bool FOR_GPU = false;
#endif
