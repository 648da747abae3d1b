// scene_depth.glsl - the host's depth at a pixel. The includer has a block with a member `virga_view_gpu view`, and
// says in SCENE_DEPTH_BINDING where the depth is bound.
layout(set = 0, binding = SCENE_DEPTH_BINDING) uniform sampler2D scene_depth;

float buffer_depth(vec2 pixel) { return texelFetch(scene_depth, ivec2(pixel), 0).r; }

// As view depth (m).
float view_depth(float stored) { return view.depth_b / (view.depth_a + stored); }

// 0 behind the scene, whether or not its depth is attached too, and rising over soft_m in front of it.
float soft_edge(float distance)
{
    const float stored = buffer_depth(gl_FragCoord.xy);
    const float in_front = stored == view.far_depth ? 1e9 : view_depth(stored) - distance;
    return view.soft_m > 0.0 ? clamp(in_front / view.soft_m, 0.0, 1.0) : float(in_front >= 0.0);
}
