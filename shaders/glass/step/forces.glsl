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

#define RUNS_M_S 1e-4 // slower drops are at rest

// What the glass before a drop does to its contact line.
struct Front {
    float wet;   // [0; 1], share of the front that meets wet glass
    float aside; // [-0.5; 0.5], pull to the left of the way, in the same unit
};

// The advancing angle is large on dry glass only. On a film the contact line has no dry edge to move over: the angle is
// nearly 0, and what is left is the viscous drag of the wedge, cut off at the film's thickness (de Gennes 1985). So a
// drop that follows a path is held less, and one that comes to the end of a path is held again.
//
// The front is the half circle of radius a at the angles p from the way. A point of it is y = a sin p to the left.
// Where it meets wet glass, surface tension pulls outwards with D = sigma (cos wet - cos advancing) more per length:
//
//     along the way:   integral of D w cos p a dp = D integral of w dy
//     to the left:     integral of D w sin p a dp
//
// `passed` marks the middle of a path, which is as wide as the drops that made it: about as wide as this one. A path
// that lies beside the way by one cell, o = cell / a, covers y / a from o - 1 on. With e = |1 - o|, the front has three
// parts: to the left of e a, the middle, and to the right of -e a. A part's share along the way is that of its width,
// and the outer parts pull aside with sqrt(1 - e^2) D a each. All is in units of D 2 a.
//
// A path's film is too thin to run down: one of 6 micrometers drains from 0.1 m of glass in mu x / (rho g h^2), 5
// minutes (Jeffreys 1930). It breaks and dries before that, as `cell_wet` says. So drops wait where a path has dried,
// and then go one behind the other, in pulses.
Front front_of_drop(uint cell, float a, vec2 way)
{
    const float reach = max(a / tick.pane.cell_m, 1.0); // at least the next cell: its own is always wet
    const vec2 middle = vec2(cell_coordinates(cell)) + 0.5 + reach * way, left = vec2(-way.y, way.x);
    const float wet_ahead = path_wet(ivec2(floor(middle))), wet_left = path_wet(ivec2(floor(middle + left))),
                wet_right = path_wet(ivec2(floor(middle - left)));
    const float offset = tick.pane.cell_m / a, e = min(abs(1.0 - offset), 1.0);
    const float part_left = max(wet_ahead, wet_left), part_right = max(wet_ahead, wet_right);
    const float part_middle = offset < 1.0 ? max(part_left, part_right) : wet_ahead;
    return Front(0.5 * (1.0 - e) * (part_left + part_right) + e * part_middle,
                 0.5 * sqrt(1.0 - e * e) * (part_left - part_right));
}

// Adds that to the forces on a drop: less hold, and a pull towards the middle of the path. tick.path_ease is the share
// of its hold that a front on wet glass lacks: (cos wet - cos advancing) / (cos receding - cos advancing).
void follow_path(vec2 velocity, uint cell, float a, inout vec2 force, inout float hold)
{
    const vec2 towards = length(velocity) > RUNS_M_S ? velocity : force;
    if (length(towards) <= 1e-12)
        return;
    const vec2 way = normalize(towards);
    const Front front = front_of_drop(cell, a, way);
    const float eased = tick.path_ease * hold;
    force += vec2(-way.y, way.x) * (eased * front.aside);
    hold -= eased * front.wet;
}

#define MIN_HOLD 0.4 // of the mean retention

// The retention force: the largest force that the drop's contact line withstands on dry glass (Furmidge 1962). Uneven
// glass holds more here and less there.
float retention_force(float a, uint packed_cell)
{
    const float uneven = clamp(1.0 - 0.3 * tick.affinity_sigma * cell_affinity(packed_cell), MIN_HOLD, 2.0 - MIN_HOLD);
    return tick.hold * a * uneven;
}

// The velocity after a tick, from m dv/dt = F - H v/|v| - C v with C = drag a. C / m may be large against 1 / tick, so
// the linear equation is solved exactly: without H, v approaches F / C with the time constant m / C, which gives w. The
// retention H then acts against the new velocity, not the old one: v = w - H s / C v/|v|, so v is parallel to w and
// shorter by H s / C. Against the old velocity, slow drops would oscillate, and more and more where H s exceeds F - H.
// A drop at rest stays at rest while F < H. A moving drop feels a part of H, which can stop it but not reverse it.
vec2 next_velocity(vec2 velocity, vec2 force, float hold, float mass, float a)
{
    const bool runs = length(velocity) > RUNS_M_S;
    const float held = runs ? tick.kinetic_hold * hold : hold;
    if (!runs && length(force) <= held)
        return vec2(0.0);
    const float drag = max(tick.drag * a, 1e-12), share = 1.0 - exp(-drag * tick.tick_s / mass);
    const vec2 w = mix(velocity, force / drag, share);
    return w * max(1.0 - held * share / drag / max(length(w), 1e-12), 0.0);
}
