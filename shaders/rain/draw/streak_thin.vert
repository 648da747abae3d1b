// streak_thin.vert - vertices of thin streaks: narrower than WIDE_PX, so the inside of the drop does not show and the
// streak has one colour.
// One invocation per vertex. Reads: streaks. Writes: position, colour and shape.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"
#include "streak.glsl"
#include "gpu/streak_profile.glsl"

// x: see streak_begun; y: turns of the wave; z: 1 / view depth, which is linear on the picture
layout(location = 0) noperspective out vec3 along_turns_depth;
layout(location = 1) flat out vec4 light_alpha;
layout(location = 2) flat out vec3 shape; // x: half width; y: see streak_ends; z: size of the wave
layout(location = 3) flat out vec3 middle_line;
layout(location = 5) flat out vec4 depth_terms;

#include "gpu/own_view.glsl"

void main()
{
    const Streak streak = streak_corner(uint(gl_VertexIndex));
    gl_Position = streak.position;
    along_turns_depth =
        vec3(streak_begun(streak.along, streak.way_px, streak.body_px), streak_phase(streak), 1.0 / streak.distance);
    // The mean over the width, see streak_wide.frag.
    light_alpha = vec4(mix(streak.center, streak.rim, 0.5), streak.alpha);
    shape = vec3(streak.half_width, streak_ends(streak.way_px, streak.body_px), streak.wave_size);
    middle_line = streak.middle_line;
    if (HAS_DEPTH)
        depth_terms = vec4(view.depth_a, view.depth_b, view.far_depth, view.soft_m);
}
