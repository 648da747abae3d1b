// mesh_map.frag - normal and material of the first surface that falling rain meets. See engine/gpu/mesh_map.h.
// One invocation per texel of a map. Reads: the mesh's push constants. Writes: the surface, packed as
// shared/surface.glsl unpacks it.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/mesh_map.h"
#include "shared/random.h"

layout(scalar, push_constant) uniform Push { virga_map_push push; };
layout(constant_id = 0) const bool HOLES = false; // the mesh covers only a part of its surface
layout(location = 0) noperspective in vec3 position;
layout(location = 0) out uint surface;

uint pack_normal(vec3 n)
{
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    vec2 e = n.xz;
    if (n.y < 0.0)
        e = (1.0 - abs(n.zx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.z >= 0.0 ? 1.0 : -1.0);
    const uvec2 bits = uvec2(round(clamp(e * 0.5 + 0.5, 0.0, 1.0) * 4095.0));
    return (bits.x << 8) | (bits.y << 20);
}

void main()
{
    // Before any discard: derivatives are undefined after it.
    const vec3 to_right = dFdx(position), down = dFdy(position);
    // Meshes with holes (leaves): some texels let drops through. The choice is made per texel, so it is stable while
    // the map stays in place. Other meshes are compiled without it, because a shader with a discard has no early depth
    // test.
    const uvec2 texel = uvec2(gl_FragCoord.xy);
    if (HOLES && virga_unit(virga_hash3(push.texels, texel.x, texel.y)) >= push.cover)
        discard;
    const vec3 up = cross(down, to_right); // not normalised
    const float towards_sky = up.y - up.x * push.slant[0] - up.z * push.slant[1];
    surface = pack_normal(towards_sky < 0.0 ? -up : up) | push.material;
}
