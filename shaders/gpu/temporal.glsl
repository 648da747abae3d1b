// temporal.glsl - outputs for temporal anti-aliasing and upscaling. A shader is compiled with MOTION, REACTIVE, both or
// none (see shaders/meson.build). The includer has a block with a member `virga_view_gpu view`. The locations are
// patched to the target's attachments, see engine/gpu/pipelines.c.

#ifdef MOTION
layout(location = 1) out vec4 motion_taken; // scaled by motion_scale; alpha 1 replaces the scene's vector, 0 keeps it

// Two motion vectors are never mixed: a vector between them belongs to neither. A pixel that is mostly covered by water
// gets the water's vector, any other keeps the scene's.
#define WRITE_MOTION(px, coverage)                                                       \
    motion_taken = vec4((px) * vec2(view.motion_scale[0], view.motion_scale[1]), 0.0, \
                        (coverage) >= view.motion_coverage ? 1.0 : 0.0)

// Motion of a surface, from its clip coordinates (x, y, w) in the previous frame.
vec2 motion_from(vec3 before)
{
    const vec2 size = vec2(view.viewport[2], view.viewport[3]), corner = vec2(view.viewport[0], view.viewport[1]);
    if (before.z < 0.01) // as NEAR_W in gpu/view.glsl
        return vec2(0.0);
    const vec2 moved = corner + (0.5 * before.xy / before.z + 0.5) * size - gl_FragCoord.xy;
    return clamp(moved, vec2(-16384.0), vec2(16384.0));
}
#else
#define WRITE_MOTION(px, coverage)
#endif

#ifdef REACTIVE
layout(location = 2) out vec4 reactive_over; // premultiplied white

// As if `gain` layers of this coverage lay over each other. Layers that are blended one after the other then give the
// same as their sum at once.
#define WRITE_REACTIVE(coverage, gain) reactive_over = vec4(1.0 - pow(max(1.0 - (coverage), 1e-6), gain))
#else
#define WRITE_REACTIVE(coverage, gain)
#endif
