// scene_depth.glsl - the host's depth at a pixel as view depth (m).
layout(set = 0, binding = 12) uniform sampler2D scene_depth;

float buffer_depth(vec2 pixel) { return texelFetch(scene_depth, ivec2(pixel), 0).r; }

float view_depth(float stored) { return view.depth_b / (view.depth_a + stored); }
