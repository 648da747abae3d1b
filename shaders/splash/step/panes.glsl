// panes.glsl - spray that hits a pane.

// Whether a droplet passes through a pane on its way from `from` to `to`, in the last part of a tick: `left_s` is the
// time from its start to the end of the tick. `hit` gets the position on the pane, along its sides.
bool hits_pane(virga_splash_pane_gpu pane, vec3 from, vec3 to, float left_s, float part_s, out vec2 hit)
{
    const vec3 u = to_vec(pane.along_u), v = to_vec(pane.along_v), normal = cross(u, v);
    // Relative to the corner where it is at either time.
    const vec3 corner = to_vec(pane.corner), velocity = to_vec(pane.velocity);
    const vec3 a = from - corner + left_s * velocity, b = to - corner + (left_s - part_s) * velocity;
    const float side_a = dot(a, normal), side_b = dot(b, normal);
    const vec3 at = mix(a, b, side_a / (side_a - side_b));
    hit = vec2(dot(at, u), dot(at, v));
    return (side_a < 0.0) != (side_b < 0.0) && all(greaterThanEqual(hit, vec2(0.0))) &&
           all(lessThan(hit, vec2(pane.width_m, pane.height_m)));
}

// 1 + number of the first pane that it hits; 0: none.
uint pane_hit(vec3 from, vec3 to, float left_s, float part_s, out vec2 hit)
{
    for (uint i = 0u; i < tick.pane_count; i++)
        if (hits_pane(tick.panes[i], from, to, left_s, part_s, hit))
            return i + 1u;
    return 0u;
}
