// nodes.glsl - the nodes that give a pane's shape, and the pane's local frame between them. The includer defines
// NODES_BINDING.
//
// Nodes are read as texels. Software Vulkan fetches texels for eight lanes at once, but reads a storage buffer lane by
// lane. A texel buffer also does not count against VIRGA_STORAGE_BUFFERS, and there are so few nodes that a view of
// them fits on every device.
layout(set = 0, binding = NODES_BINDING) uniform usamplerBuffer nodes; // a virga_glass_node_gpu is three texels

struct Frame {
    vec3 position, along_u, along_v, normal;
};

Frame node_frame(uvec2 node)
{
    const int texel = 3 * int(node.x + node.y * VIRGA_GLASS_NODES);
    const vec4 first = uintBitsToFloat(texelFetch(nodes, texel)),
               second = uintBitsToFloat(texelFetch(nodes, texel + 1)),
               third = uintBitsToFloat(texelFetch(nodes, texel + 2));
    return Frame(first.xyz, vec3(first.w, second.xy), vec3(second.zw, third.x), third.yzw);
}

Frame mix_frames(Frame a, Frame b, float t)
{
    return Frame(mix(a.position, b.position, t), mix(a.along_u, b.along_u, t), mix(a.along_v, b.along_v, t),
                 mix(a.normal, b.normal, t));
}

// Interpolates between the four nodes around a point, which is given as fractions of the pane's width and height, [0;
// 1].
Frame frame_between(vec2 share)
{
    const vec2 grid = share * float(VIRGA_GLASS_NODES - 1);
    const uvec2 low = min(uvec2(grid), uvec2(VIRGA_GLASS_NODES - 2));
    const vec2 t = grid - vec2(low);
    return mix_frames(mix_frames(node_frame(low), node_frame(low + uvec2(1, 0)), t.x),
                      mix_frames(node_frame(low + uvec2(0, 1)), node_frame(low + uvec2(1, 1)), t.x), t.y);
}
