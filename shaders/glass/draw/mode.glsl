// mode.glsl - what a draw's pipeline is specialised for, because software Vulkan runs all sides of a branch.
layout(constant_id = 0) const uint DRAW_MODE = 0u;
#define IN_PAPER ((DRAW_MODE & VIRGA_GLASS_DRAW_PAPER) != 0u)
#define HAS_PLATE                                  \
    ((DRAW_MODE & VIRGA_GLASS_DRAW_PLATE) != 0u || \
     ((DRAW_MODE & VIRGA_GLASS_DRAW_ALONE) == 0u && view.color_given != 0u))
