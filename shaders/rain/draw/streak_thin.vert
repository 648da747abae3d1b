// streak_thin.vert - corners of a streak that is too thin to show the inside of its drop: one colour for all of it.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"
#include "streak.glsl"
#include "gpu/streak_profile.glsl"

layout(location = 0) noperspective out vec3 place; // see streak_begun; turns; view depth
layout(location = 1) flat out vec4 light_alpha;
layout(location = 2) flat out vec3 shape; // half width; see streak_ends; size of the wave
layout(location = 3) flat out vec3 middle_line;
layout(location = 5) flat out vec4 depth_terms;

void main()
{
    const Streak streak = streak_corner(uint(gl_VertexIndex));
    gl_Position = streak.position;
    place = vec3(streak_begun(streak.along, streak.way_px, streak.body_px), streak_turns(streak), streak.distance);
    // Averaged over the width: half each where it is narrow, by u^2 where it is wide (see streak_wide.frag).
    const float wide = clamp(streak.half_width - 0.75, 0.0, 1.0);
    light_alpha = vec4(mix(streak.centre, streak.rim, wide / 3.0 + (1.0 - wide) * 0.5), streak.alpha);
    shape = vec3(streak.half_width, streak_ends(streak.way_px, streak.body_px), streak.wave_size);
    middle_line = streak.middle_line;
    if (HAS_DEPTH)
        depth_terms = vec4(view.depth_a, view.depth_b, view.far_depth, view.soft_m);
}
