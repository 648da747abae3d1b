// scene_depth.glsl - the host's depth buffer at a pixel. The includer has a block with a member `virga_view_gpu view`
// and defines SCENE_DEPTH_BINDING. A compute pass also defines PIXEL_HERE, the pixel that it works for.
#ifndef PIXEL_HERE
#define PIXEL_HERE gl_FragCoord.xy
#endif
layout(set = 0, binding = SCENE_DEPTH_BINDING) uniform sampler2D scene_depth;

float buffer_depth(vec2 pixel) { return texelFetch(scene_depth, ivec2(pixel), 0).r; }

// From a stored depth to view depth (m).
float view_depth(float stored) { return view.depth_b / (view.depth_a + stored); }

// 0 behind a surface, rising to 1 over `soft` (m) in front of it.
float soft_step(float in_front, float soft)
{
    return soft > 0.0 ? clamp(in_front / soft, 0.0, 1.0) : float(in_front >= 0.0);
}

// Soft edge against the scene: 0 behind it, rising to 1 over soft_m in front of it. It also works where the target has
// the depth attached. `terms` are depth_a, depth_b, far_depth and soft_m of the view, from a vertex: in a fragment
// shader software Vulkan reads a uniform buffer lane by lane.
float soft_edge(float distance, vec4 terms)
{
    const float stored = buffer_depth(PIXEL_HERE);
    const float in_front = stored == terms.z ? 1e9 : terms.y / (terms.x + stored) - distance;
    return soft_step(in_front, terms.w);
}

float soft_edge(float distance)
{
    return soft_edge(distance, vec4(view.depth_a, view.depth_b, view.far_depth, view.soft_m));
}
