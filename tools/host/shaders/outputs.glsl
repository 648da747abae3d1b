// outputs.glsl - attachments of the plate, and how far a point moved on the picture since a frame ago.
#include "attachments.glsl"

vec2 pixel_of(vec4 clip) { return (clip.xy / clip.w * 0.5 + 0.5) * frame.screen.xy; }

// Of a point relative to the camera, and to that of a frame ago (w 1), or of a direction (w 0). Behind that camera it
// did not move. Where it is now is worked out, too, and is not the pixel: corners lie on sixteenths of pixels on some
// devices, and a point between them is that much beside its pixel, or what stands still would move by it.
vec2 velocity_of(vec4 now, vec4 then)
{
    vec4 clip = frame.previous_from_relative * then;
    vec2 now_px = pixel_of(frame.clip_from_relative * now) - frame.screen.zw;
    return clip.w > 1e-6 ? now_px - pixel_of(clip) : vec2(0.0);
}
