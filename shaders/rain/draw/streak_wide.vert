// streak_wide.vert - vertices of wide streaks: at least WIDE_PX, so their ends are round, and the inside of a drop in
// focus shows.
// One invocation per vertex. Reads: streaks. Writes: position, colours and shape.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"
#include "streak.glsl"

// x: px from the center line; y: px from the tail; z: turns of the wave; w: 1 / view depth, which is linear on the
// picture
layout(location = 0) noperspective out vec4 streak_position;
layout(location = 1) flat out vec4 center_alpha;
layout(location = 2) flat out vec4 rim_wave; // .w: size of the wave
// x: half width; y: length of the drop; z: length of the path (px); w: focus, see Streak
layout(location = 3) flat out vec4 shape;
layout(location = 5) flat out vec4 depth_terms;
// What the light of the middle has of lamps: the record has the sum, see set_light in streak_write.comp.
layout(location = 6) flat out vec3 lamp_light;

#include "gpu/own_view.glsl"

void main()
{
    const Streak streak = streak_corner(uint(gl_VertexIndex));
    gl_Position = streak.position;
    // What hides a drop out of focus is found by the pixel, see lens_edge.glsl. It passes every test of depth.
    if (HAS_LENS && streak.focus < 1.0)
        gl_Position.z = (1.0 - view.far_depth) * gl_Position.w;
    streak_position = vec4(streak.across, streak.along, streak_phase(streak), 1.0 / streak.distance);
    center_alpha = vec4(streak.center, streak.alpha);
    rim_wave = vec4(streak.rim, streak.wave_size);
    shape = vec4(streak.half_width, streak.body_px, streak.way_px, streak.focus);
    lamp_light = max(streak.center - environment(normalize(streak.middle_ray), vec2(0.97, 0.90)), vec3(0.0));
    if (HAS_DEPTH)
        depth_terms = vec4(view.depth_a, view.depth_b, view.far_depth, view.soft_m);
}
