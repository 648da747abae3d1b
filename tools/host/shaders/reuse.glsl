// reuse.glsl - blocks of pixels whose shading sub-frames share, see reuse.h. Depth is affine in the picture where a
// surface is flat, so a block has the plane of its depth, and how far from it a depth may be.
#include "frame_gpu.h"

layout(push_constant) uniform Reuse { host_reuse_gpu reuse; };

// Depth of the pixel above and left of the block, what it rises by from pixel to pixel right and down, and how far a
// depth may be from that. Below 0: REUSE_NOTHING, all of it is shaded, or REUSE_PIXELS, each pixel takes another one
// that sees the same surface.
#define REUSE_NOTHING vec4(0.0, 0.0, 0.0, -1.0)
#define REUSE_PIXELS  vec4(0.0, 0.0, 0.0, -2.0)

const float REUSE_MOVED_PX = 0.1; // what the eye moves meanwhile, beyond what shift says

// 2 parts of a thousand of the distance: 1 - depth falls as 1 / distance.
float reuse_tolerance(float depth) { return 0.002 * (1.0 - depth) + 1e-6; }

// Whether something moves by itself in a block.
bool reuse_moves(uvec2 first)
{
    bool moves = false;
    for (uint i = 0u; i < reuse.rect_count; i++) {
        const uint low = reuse.rects[2u * i], high = reuse.rects[2u * i + 1u];
        moves = moves || (first.x + HOST_REUSE_SIDE > (low & 0xffffu) && first.y + HOST_REUSE_SIDE > low >> 16 &&
                          first.x < (high & 0xffffu) && first.y < high >> 16);
    }
    return moves;
}

uint reuse_block(uvec2 pixel)
{
    const uint row = (reuse.width + HOST_REUSE_SIDE - 1u) / HOST_REUSE_SIDE;
    return pixel.y / HOST_REUSE_SIDE * row + pixel.x / HOST_REUSE_SIDE;
}

ivec2 reuse_inside(ivec2 at) { return clamp(at, ivec2(0), ivec2(reuse.width, reuse.height) - 1); }

// The first sub-frame's four pixels around the point that a pixel sees, from that pixel on.
ivec2 reuse_place(uint i) { return ivec2(floor(vec2(reuse.shift_x, reuse.shift_y))) + ivec2(i & 1u, i >> 1); }
