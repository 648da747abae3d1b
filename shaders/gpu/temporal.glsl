// temporal.glsl - what a fragment tells temporal anti-aliasing and upscaling, in the forms of a shader that are
// compiled with MOTION, REACTIVE or both (see shaders/meson.build). The includer has a block with a member
// `virga_view_gpu view`. Locations are changed to the attachments of the target, see engine/gpu/pipelines.c.

#ifdef MOTION
layout(location = 1) out vec4 motion_taken; // times motion_scale; alpha 1: in place of what is there, 0: not

// Two motions are never mixed: halfway between them lies what neither shows. Pixels that water covers for the most part
// get its own, the others keep the scene's.
#define WRITE_MOTION(px, coverage)                                                       \
    motion_taken = vec4((px) * vec2(view.motion_scale[0], view.motion_scale[1]), 0.0, \
                        (coverage) >= view.motion_coverage ? 1.0 : 0.0)

// Of a surface, from its place in the previous frame's clip coordinates: x, y, w.
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

// As if so many layers of the same coverage lay over one another: of layers with different coverages it gives the same
// together as of their sum one by one.
#define WRITE_REACTIVE(coverage, gain) reactive_over = vec4(1.0 - pow(max(1.0 - (coverage), 1e-6), gain))
#else
#define WRITE_REACTIVE(coverage, gain)
#endif
