// haze.vert - one triangle over the viewport, and constants of the view as flat outputs: in a fragment shader software
// Vulkan reads words of a uniform buffer lane by lane, but flat inputs at once.
// One invocation per vertex. Reads: the view. Writes: ray, constants.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"

layout(location = 0) noperspective out vec3 ray; // with a view depth of 1 m
// xyz: depth_a, depth_b, far_depth of the view; w: half the innermost box
layout(location = 1) flat out vec4 depth_and_reach;
layout(location = 2) flat out vec4 per_m[HAZE_VECTORS]; // light that hits drops, in each box and beyond the last
layout(location = 6) flat out vec4 sky[SKY_VECTORS];    // coefficients of the environment, red, green, blue, red and so
                                                        // on; the last word: metres of haze before it
layout(location = 13) noperspective out float inverse_begin_depth; // 1 / view depth at which haze begins

#include "gpu/own_view.glsl"

void main()
{
    const vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0;
    gl_Position = vec4(corner, 0.0, 1.0);
    ray = to_vec(view.right) * corner.x + to_vec(view.up) * corner.y + to_vec(view.ahead);
    inverse_begin_depth = inverse_begin(ray);
    depth_and_reach = vec4(view.depth_a, view.depth_b, view.far_depth, look.haze_inner_m);
    for (uint box = 0u; box < 4u * HAZE_VECTORS; box++)
        per_m[box / 4u][box % 4u] = look.haze_per_m[min(box, tick.levels)];
    for (uint word = 0u; word < 27u; word++)
        sky[word / 4u][word % 4u] = view.sh[word];
    sky[SKY_VECTORS - 1u].w = look.sky_m;
}
