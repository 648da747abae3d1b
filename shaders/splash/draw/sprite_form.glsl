// sprite_form.glsl - what a pipeline of sprites is made for. Software Vulkan works out what every kind of sprite would
// cover for each pixel of any, so that each has its own.
layout(constant_id = 0) const uint SPRITES_OF = uint(VIRGA_SPLASH_SPRITES_DEPTH);
const bool HAS_DEPTH = (SPRITES_OF & uint(VIRGA_SPLASH_SPRITES_DEPTH)) != 0u,
           LINES = (SPRITES_OF & uint(VIRGA_SPLASH_SPRITES_LINES)) != 0u,
           PUFFS = (SPRITES_OF & uint(VIRGA_SPLASH_SPRITES_PUFFS)) != 0u;
