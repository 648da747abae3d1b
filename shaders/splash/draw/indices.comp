// indices.comp - fills the index buffer, once: quads of sprites, pyramids, the mesh of a sheet, and lines of sprites.
// One invocation per index or group of them. Writes: the index buffer.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/splash_gpu.h"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;
layout(scalar, set = 0, binding = 15) writeonly buffer Indices { uint indices[]; };
layout(push_constant) uniform Size { uint max_sprites; };

const uint quad[6] = uint[6](0u, 1u, 2u, 2u, 1u, 3u);
const uint pyramid[12] = uint[12](0u, 1u, 4u, 1u, 2u, 4u, 2u, 3u, 4u, 3u, 0u, 4u); // four corners at the foot and a tip

uint index_at(uint i)
{
    const uint quads = 6u * max_sprites, pyramids = 12u * max_sprites;
    if (i < quads)
        return i / 6u * 4u + quad[i % 6u];
    if (i < quads + pyramids)
        return (i - quads) / 12u * 8u + pyramid[(i - quads) % 12u];
    const uint j = i - quads - pyramids;
    if (j >= VIRGA_CROWN_INDICES)
        return (j - VIRGA_CROWN_INDICES) * 2u; // of the four corners the first and the third, one at each end
    const uint cell = j / 6u, corner = quad[j % 6u];
    // Columns alternate between left and right of the farthest, so that the back is drawn first: see crown.vert.
    return ((cell / VIRGA_CROWN_ROWS * 2u + (corner & 1u)) << 4) | (cell % VIRGA_CROWN_ROWS + (corner >> 1));
}

void main()
{
    const uint all = 20u * max_sprites + VIRGA_CROWN_INDICES, stride = gl_NumWorkGroups.x * VIRGA_SPLASH_GROUP;
    for (uint i = gl_GlobalInvocationID.x; i < all; i += stride)
        indices[i] = index_at(i);
}
