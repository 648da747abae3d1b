// quaternion.glsl - rotations as quaternions x, y, z, w of length 1.
vec3 turn(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
vec3 turn_back(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) - q.w * v); }

vec4 product(vec4 a, vec4 b)
{
    return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}

// First q, then a turn about the axis of `by`, in the axes of the world, by its length (rad).
vec4 turned_by(vec4 q, vec3 by)
{
    const float angle = length(by);
    const vec4 step = angle > 1e-6 ? vec4(sin(0.5 * angle) / angle * by, cos(0.5 * angle)) : vec4(0.5 * by, 1.0);
    return normalize(product(step, q));
}
