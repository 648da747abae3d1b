// forces.glsl - the forces that move a drop, and the force that holds it. All in newtons.

// Force along the pane on water of `mass` (kg) with a base of radius a, at a point.
//
// Gravity minus the pane's own acceleration: tick.force is that in the pane's frame, and a rotating pane adds -w x (w x
// r). Bump maps (Chen and Zhang, equation 14): the bump with the normal N carries the part of F that presses on it, so
// F - (N . F) N is left. Air: the flow along the pane drags with half its density times its speed squared on the drop's
// cross-section; tick.air_drag holds the constants. Air that meets the pane head-on spreads from its middle as before a
// stagnation point, in proportion to the distance from it.
vec2 force_on_drop(vec2 point, float mass, float a, uint packed_cell)
{
    const Frame frame = frame_at(point);
    const vec3 spin = to_vec(tick.spin);
    const vec3 field = to_vec(tick.force) - cross(spin, cross(spin, frame.position));
    vec3 force = mass * vec3(dot(field, frame.along_u), dot(field, frame.along_v), dot(field, frame.normal));
    const vec3 n = cell_normal(packed_cell);
    force -= dot(n, force) * n;
    const vec3 air = to_vec(tick.air);
    const vec2 from_middle = point - 0.5 * vec2(tick.pane.width_m, tick.pane.height_m);
    const vec2 spread = vec2(tick.air_outward[0], tick.air_outward[1]) * from_middle;
    const vec2 along = (vec2(dot(air, frame.along_u), dot(air, frame.along_v)) + spread) * tick.air_share;
    return force.xy + along * (length(along) * tick.air_drag * a * a);
}

#define MIN_HOLD 0.4 // of the mean retention

// The retention force: the largest force that the drop's contact line withstands (Furmidge 1962). Uneven glass holds
// more here and less there, and a wet path holds less.
float retention_force(float a, uint cell, uint packed_cell)
{
    const float uneven = clamp(1.0 - 0.3 * tick.affinity_sigma * cell_affinity(packed_cell), MIN_HOLD, 2.0 - MIN_HOLD);
    return tick.hold * a * uneven * (1.0 - tick.path_ease * cell_wet(cell));
}

// The velocity after a tick, from m dv/dt = F - H v/|v| - C v with C = drag a. C / m may be large against 1 / tick, so
// the linear equation is solved exactly: without H, v approaches F / C with the time constant m / C, which gives w. The
// retention H then acts against the new velocity, not the old one: v = w - H s / C v/|v|, so v is parallel to w and
// shorter by H s / C. Against the old velocity, slow drops would oscillate, and more and more where H s exceeds F - H.
// A drop at rest stays at rest while F < H. A moving drop feels a part of H, which can stop it but not reverse it.
vec2 next_velocity(vec2 velocity, vec2 force, float hold, float mass, float a)
{
    const bool runs = length(velocity) > 1e-4;
    const float held = runs ? tick.kinetic_hold * hold : hold;
    if (!runs && length(force) <= held)
        return vec2(0.0);
    const float drag = max(tick.drag * a, 1e-12), share = 1.0 - exp(-drag * tick.tick_s / mass);
    const vec2 w = mix(velocity, force / drag, share);
    return w * max(1.0 - held * share / drag / max(length(w), 1e-12), 0.0);
}
