// streak_wide.vert - corners of a streak that is wide enough to show the inside of its drop.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"
#include "streak.glsl"

layout(location = 0) noperspective out vec4 place; // px from the middle line; px from the tail; turns; view depth
layout(location = 1) flat out vec4 centre_alpha;
layout(location = 2) flat out vec4 rim_wave; // .w: size of the wave
layout(location = 3) flat out vec3 shape;    // half width; length of the drop; way (px)
layout(location = 5) flat out vec4 depth_terms;

void main()
{
    const Streak streak = streak_corner(uint(gl_VertexIndex));
    gl_Position = streak.position;
    place = vec4(streak.across, streak.along, streak_turns(streak), streak.distance);
    centre_alpha = vec4(streak.centre, streak.alpha);
    rim_wave = vec4(streak.rim, streak.wave_size);
    shape = vec3(streak.half_width, streak.body_px, streak.way_px);
    if (HAS_DEPTH)
        depth_terms = vec4(view.depth_a, view.depth_b, view.far_depth, view.soft_m);
}
