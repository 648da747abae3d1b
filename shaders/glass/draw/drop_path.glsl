// drop_path.glsl - the eye's ray through a single drop. Include it after path.glsl and drop_inputs.glsl.
//
// (x, y) is a point of the drop's base in radii of the base, and rays are those through it. Two shapes:
//
// Cap, as the height map has it (height.glsl): its surface is at h (1 - x^2 - y^2) over the base, h = tan(contact angle
// / 2), with the slopes (-2 h x, -2 h y). The ray is refracted by the surface over the point where it crosses the base,
// as in the height map; so a drop is the same in both ways of drawing it.
//
// Hemisphere (Sato, Dobashi and Yamamoto 2002, section 3.3 and figure 2): the ray meets the sphere of radius 1 around
// the base's middle at P, and the normal there is P itself. Seen from behind the pane, the ray is refracted by the flat
// base first: it runs from b = (x, y, 0) along the unit vector t in the water, and |b + s t| = 1 gives
//     s = -b.t + sqrt((b.t)^2 + 1 - b.b),   P = b + s t.
// Seen from the front, it meets the sphere before it crosses the base in the direction d: P = b - s d with
//     s = b.d + sqrt((b.d)^2 + 1 - b.b).
// b is inside the sphere, so both roots are real and s >= 0.
//
// With P's normal, Snell's law gives the ray's direction out of the pane (pass_outward and pass_inward in path.glsl),
// and that the point of the plate which it meets: q in the paper's figure 2.

#define STEEPEST 0.3 // least cosine of a hemisphere's normal that counts for how fast the picture in it changes

vec3 hemisphere_normal(vec2 at, vec3 d)
{
    const vec3 flat_normal = cross(along_u, along_v), base = at.x * along_u + at.y * along_v;
    const bool from_behind = dot(d, flat_normal) > 0.0;
    const vec3 way = from_behind ? refract(d, -flat_normal, 1.0 / WATER) : -d;
    const float b_t = dot(base, way);
    return base + (-b_t + sqrt(max(b_t * b_t + 1.0 - dot(base, base), 0.0))) * way;
}

// `pixel`: width of a pixel in radii.
Path path_through_drop(vec2 at, vec3 d, float pixel)
{
    const vec2 slope = -2.0 * look.cap_height * at;
    const vec3 cap = cross(along_u, along_v) - slope.x * along_u - slope.y * along_v;
    const bool hemisphere = look.hemispheres != 0u;
    // A slope of 1 is a turn of 1 rad; a hemisphere's normal turns by 1 / cosine per radius.
    const float turn = hemisphere ? inversesqrt(max(1.0 - dot(at, at), STEEPEST * STEEPEST)) : 2.0 * look.cap_height;
    return path_by_normal(d, normalize(hemisphere ? hemisphere_normal(at, d) : cap),
                          1.0 + (WATER - 1.0) * turn * pixel / gain_angle.y);
}
