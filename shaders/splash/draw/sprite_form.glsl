// sprite_form.glsl - what a pipeline of sprites is specialised for. Each kind has its own, because software Vulkan
// would compute the coverage of every kind for each pixel.
layout(constant_id = 0) const uint SPRITES_OF = uint(VIRGA_SPLASH_SPRITES_DEPTH);
const bool HAS_DEPTH = (SPRITES_OF & uint(VIRGA_SPLASH_SPRITES_DEPTH)) != 0u,
           LINES = (SPRITES_OF & uint(VIRGA_SPLASH_SPRITES_LINES)) != 0u,
           PUFFS = (SPRITES_OF & uint(VIRGA_SPLASH_SPRITES_PUFFS)) != 0u;
