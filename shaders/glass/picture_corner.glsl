// picture_corner.glsl - a corner of what is drawn of the pane: where it is, and the pane's directions there.
//
// Nodes are read as texels: those are fetched for eight corners at once by software Vulkan, and a storage buffer word
// by word and corner by corner.
layout(set = 0, binding = 25) uniform usamplerBuffer nodes; // a virga_glass_node_gpu is three texels

layout(location = 0) out vec2 place;    // (u, v) on the pane (m)
layout(location = 1) out vec3 position; // relative to the camera

struct Corner {
    vec3 position, along_u, along_v;
};

Corner node_at(uvec2 node)
{
    const int texel = 3 * int(node.x + node.y * VIRGA_GLASS_NODES);
    const vec4 first = uintBitsToFloat(texelFetch(nodes, texel)),
               second = uintBitsToFloat(texelFetch(nodes, texel + 1)),
               third = uintBitsToFloat(texelFetch(nodes, texel + 2));
    return Corner(first.xyz, vec3(first.w, second.xy), vec3(second.zw, third.x));
}

Corner mix_corners(Corner a, Corner b, float t)
{
    return Corner(mix(a.position, b.position, t), mix(a.along_u, b.along_u, t), mix(a.along_v, b.along_v, t));
}

// Between the four nodes around a place.
Corner corner_at(vec2 share)
{
    const vec2 grid = share * float(VIRGA_GLASS_NODES - 1);
    const uvec2 low = min(uvec2(grid), uvec2(VIRGA_GLASS_NODES - 2));
    const vec2 t = grid - vec2(low);
    return mix_corners(mix_corners(node_at(low), node_at(low + uvec2(1, 0)), t.x),
                       mix_corners(node_at(low + uvec2(0, 1)), node_at(low + uvec2(1, 1)), t.x), t.y);
}

// Places the corner; returns the pane's directions there, in the world. `share`: of the pane's width and height.
Corner place_corner(vec2 share)
{
    const float m[9] = look.world_from_pane;
    const mat3 world_from_pane = mat3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]);
    const Corner pane = corner_at(share);
    place = share * vec2(look.pane.width_m, look.pane.height_m);
    position = world_from_pane * pane.position + to_vec(look.origin);
    gl_Position = to_mat(view.clip_from_rel) * vec4(position, 1.0);
    return Corner(position, world_from_pane * pane.along_u, world_from_pane * pane.along_v);
}

// The corner of a tile with this number: they are counted along rows of the grid of all tiles.
Corner place_tile_corner(uint number)
{
    const uint columns = look.tile_columns + 1u;
    return place_corner(vec2(number % columns, number / columns) / vec2(look.tile_columns, look.tile_rows));
}
