// mesh_map.frag - normal and material of the first surface from above.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/mesh_map.h"
#include "shared/random.h"

layout(scalar, push_constant) uniform Push { virga_map_push push; };
layout(constant_id = 0) const bool HOLES = false; // the mesh covers only a share of its surface
layout(location = 0) noperspective in vec3 place;
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
    // Before any texel is discarded: behind that, derivatives are undefined.
    const vec3 to_right = dFdx(place), down = dFdy(place);
    // Leaves: a share of the texels lets drops through. By texel, so that it is steady while the map stays in place.
    // For meshes without holes this is left out: a shader that may discard has its depth tested last.
    const uvec2 texel = uvec2(gl_FragCoord.xy);
    if (HOLES && virga_unit(virga_hash3(push.texels, texel.x, texel.y)) >= push.cover)
        discard;
    const vec3 up = cross(down, to_right); // of any length
    const float towards_sky = up.y - up.x * push.slant[0] - up.z * push.slant[1];
    surface = pack_normal(towards_sky < 0.0 ? -up : up) | push.material;
}
