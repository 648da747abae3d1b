// focus.comp - the focus of this view: as set, or eased towards what is at the focus point. It is eased in 1/m, in
// which the blur is linear.
// One invocation. Reads: depth. Writes: state, and a copy of it that other passes read while one writes the state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define STATE_WRITTEN
#include "lens.glsl"

layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 1) buffer State { virga_lens_state_gpu state; };
layout(std430, set = 0, binding = 40) writeonly buffer Focused { virga_lens_state_gpu focused; };
layout(set = 0, binding = 4) uniform sampler2D scene_depth;

void main()
{
    float next = view.focus_inv_m;
    if (view.follow != 0u && view.depth_given != 0u)
        next = inverse_depth(texelFetch(scene_depth, ivec2(view.focus_x, view.focus_y), 0).r);
    if (view.follow != 0u && state.focused != 0u)
        next = mix(state.focus_inv_m, next, view.ease);
    state.focus_inv_m = next;
    state.focused = 1u;
    focused = state;
}
