// forces.glsl - what pulls at a drop, and what holds it.

// Forces along the pane on water of a mass (kg) with a base of radius a at a place; N.
//
// Gravity less the pane's own acceleration: in the pane's frame that is tick.force, and a turning pane adds -w x (w x
// r). Bump maps (Chen and Zhang, equation 14): of the force, what presses on the structure's face with the normal N is
// borne by it, F - (N . F) N is left. Air: its flow along the pane pulls with half its density times its speed squared
// on the drop's section; tick.air_drag holds the numbers.
vec2 pull(vec2 place, float mass, float a, uint word)
{
    const Frame frame = frame_at(place);
    const vec3 spin = to_vec(tick.spin);
    const vec3 field = to_vec(tick.force) - cross(spin, cross(spin, frame.position));
    vec3 force = mass * vec3(dot(field, frame.along_u), dot(field, frame.along_v), dot(field, frame.normal));
    const vec3 n = cell_normal(word);
    force -= dot(n, force) * n;
    const vec3 air = to_vec(tick.air);
    const vec2 along = vec2(dot(air, frame.along_u), dot(air, frame.along_v)) * tick.air_share;
    return force.xy + along * (length(along) * tick.air_drag * a * a);
}

#define LEAST_HOLD 0.4 // of the mean

// The largest force (N) that the drop's rim withstands, Furmidge 1962: uneven glass holds more here and less there, and
// a wet path less.
float holding(float a, uint cell, uint word)
{
    const float uneven = clamp(1.0 - 0.3 * tick.affinity_sigma * cell_affinity(word), LEAST_HOLD, 2.0 - LEAST_HOLD);
    return tick.hold * a * uneven * (1.0 - tick.path_ease * cell_wet(cell));
}

// The velocity after a tick. m dv/dt = F - H v/|v| - C v, with C = drag a; C / m may be large against 1 / tick, so the
// solution of the linear equation is taken whole: without H, v goes to F / C with the time constant m / C, which gives
// w. What holds then acts against the velocity that comes out, not the one before: v = w - H s / C v/|v|, so v lies
// along w and is shorter by H s / C. Against the one before, slow drops would swing from side to side, ever more where
// H s is more than F - H. A drop at rest stays there while F is below H; one that runs feels a part of H, which can
// stop it but not push it back.
vec2 next_velocity(vec2 velocity, vec2 force, float hold, float mass, float a)
{
    const bool runs = length(velocity) > 1e-4;
    const float held = runs ? tick.run_hold * hold : hold;
    if (!runs && length(force) <= held)
        return vec2(0.0);
    const float drag = max(tick.drag * a, 1e-12), share = 1.0 - exp(-drag * tick.tick_s / mass);
    const vec2 w = mix(velocity, force / drag, share);
    return w * max(1.0 - held * share / drag / max(length(w), 1e-12), 0.0);
}
