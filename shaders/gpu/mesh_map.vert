// mesh_map.vert - a host's mesh seen from above along parallel, possibly slanted lines. Depth is height.
// One invocation per vertex of a mesh. Reads: positions. Writes: the position in the map, and the unsheared one.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/mesh_map.h"

layout(scalar, push_constant) uniform Push { virga_map_push push; };
layout(location = 0) in vec3 mesh_position;
layout(location = 0) noperspective out vec3 position; // w is 1

void main()
{
    const vec4 p = vec4(mesh_position, 1.0);
    for (int row = 0; row < 3; row++)
        position[row] = dot(p, vec4(push.rel_from_mesh[row * 4], push.rel_from_mesh[row * 4 + 1],
                                 push.rel_from_mesh[row * 4 + 2], push.rel_from_mesh[row * 4 + 3]));
    const vec2 sheared = position.xz + vec2(push.slant[0], push.slant[1]) * position.y;
    gl_Position = vec4((sheared - vec2(push.center[0], push.center[1])) * push.inv_half_m,
                       (push.top_m - position.y) * push.inv_height, 1.0);
}
