// outputs.glsl - attachments of the plate, and how far a point moved on the picture since a frame ago.

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec2 out_velocity;
layout(location = 3) out vec2 out_water; // wetness, depth of water (m)
layout(location = 4) out uint out_id;

// Of a point relative to the camera of a frame ago (w 1) or of a direction (w 0). Behind that camera it did not move.
vec2 velocity_of(vec4 then)
{
    vec4 clip = frame.previous_from_relative * then;
    vec2 now_px = gl_FragCoord.xy - frame.screen.zw;
    vec2 then_px = (clip.xy / clip.w * 0.5 + 0.5) * frame.screen.xy;
    return clip.w > 1e-6 ? now_px - then_px : vec2(0.0);
}
