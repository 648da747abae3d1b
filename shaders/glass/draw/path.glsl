// path.glsl - rays from the eye through pane and water: where the light comes from.

#define FRAME_M 0.001 // what is nearer to the pane is part of it: a frame
#define EDGE_STEPS 8  // bisection steps towards an edge

// A ray that was refracted, or reflected back.
struct Path {
    vec3 normal;    // of the water's surface, outward
    vec3 out_of;    // unit direction in which it leaves the pane; the reflected direction if `total`
    vec3 mirrored;  // direction whose light the surface reflects
    float reflects; // reflected part of the light
    bool total;     // total reflection
    float lost;     // (total) 0: nearly refracted, 1: far from it
    vec3 from;      // point where it leaves the pane, relative to the camera
    bool ahead;     // it exits in front of the camera
    bool hidden;    // what it meets is hidden on the picture by something on the eye's side of the pane
    vec2 pixel;     // the pixel that it meets; (hidden) the pixel that is shown instead
    float pixels;   // how many pixels of the picture one pixel shows
};

// Fresnel reflectance of unpolarised light, from an index n1 into n2, at angles with these cosines.
float fresnel(float cos1, float cos2, float n1, float n2)
{
    const float s = (n1 * cos1 - n2 * cos2) / (n1 * cos1 + n2 * cos2);
    const float p = (n2 * cos1 - n1 * cos2) / (n2 * cos1 + n1 * cos2);
    return 0.5 * (s * s + p * p);
}

// Distance of the scene along the pixel's own ray; 0: far away.
float scene_distance(vec3 d)
{
    const float stored = HAS_DEPTH ? buffer_depth(PIXEL_HERE) : view.far_depth;
    if (stored == view.far_depth)
        return 0.0;
    const vec3 ahead = to_vec(view.ahead);
    // `ahead` has the length 1 along the camera's axis, plus what lens shift adds across it.
    const vec3 axis = normalize(cross(to_vec(view.right), to_vec(view.up)));
    return view_depth(stored) * abs(dot(ahead, axis)) / max(abs(dot(d, axis)), 1e-4);
}

// From behind the pane: air, glass, water, air. The flat faces are parallel, so the direction in the water is as if
// there were no glass; the glass only shifts the ray. A ray that is totally reflected continues in the direction of the
// last one that is not, along the surface; `lost` says how far it is beyond that.
void pass_outward(inout Path path, vec3 d, vec3 flat_normal)
{
    const vec3 in_water = refract(d, -flat_normal, 1.0 / WATER);
    const vec3 n = path.normal;
    const float cos_in = max(dot(in_water, n), 0.0), k = 1.0 - WATER * WATER * (1.0 - cos_in * cos_in);
    const float cos_out = sqrt(max(k, 0.0));
    path.total = k < 0.0;
    path.lost = clamp(-6.0 * k, 0.0, 1.0);
    path.out_of = normalize(WATER * in_water + (cos_out - WATER * cos_in) * n);
    path.reflects = path.total ? 0.0 : fresnel(cos_in, cos_out, WATER, 1.0);
    path.mirrored = reflect(d, n); // the glass between has little effect, and this reflection is faint
}

// From the front of the pane: air, water, glass, air.
void pass_inward(inout Path path, vec3 d, vec3 flat_normal)
{
    vec3 n = path.normal;
    n = dot(n, d) < -0.02 ? n : normalize(n - d * (dot(n, d) + 0.02)); // the far side of a steep drop is not visible
    const vec3 in_water = refract(d, n, 1.0 / WATER);
    path.reflects = fresnel(-dot(d, n), -dot(in_water, n), 1.0, WATER);
    path.mirrored = reflect(d, n);
    path.out_of = refract(in_water, flat_normal, WATER);
    path.total = path.out_of == vec3(0.0);
    path.lost = path.total ? 1.0 : 0.0;
    path.out_of = path.total ? path.mirrored : path.out_of;
    path.reflects = path.total ? 0.0 : path.reflects;
}

// How far the glass shifts a ray sideways.
vec3 glass_shift(vec3 d, vec3 flat_normal)
{
    const vec3 n = dot(d, flat_normal) > 0.0 ? flat_normal : -flat_normal;
    const vec3 in_glass = refract(d, -n, 1.0 / 1.52);
    return look.thickness_m * (in_glass / max(dot(in_glass, n), 0.1) - d / max(dot(d, n), 0.1));
}

// What is on the eye's side of the pane (taken as flat) or in it: pillars, a dashboard, the pane's frame, passengers. A
// ray that has left the pane can not meet them.
struct Inside {
    vec3 facing; // direction out through the pane, in the camera's right, up and ahead
    float reach; // distance of the pane from the eye along it, m
    // depth_a, depth_b and far_depth of the view: read once, because software Vulkan reads them lane by lane
    vec3 depth;
};

Inside inside_of_pane(vec3 d)
{
    const vec3 normal = cross(along_u, along_v), out_of = normal * sign(dot(d, normal));
    return Inside(vec3(dot(to_vec(view.right), out_of), dot(to_vec(view.up), out_of), dot(to_vec(view.ahead), out_of)),
                  dot(position, out_of) + FRAME_M, vec3(view.depth_a, view.depth_b, view.far_depth));
}

// How far the ray through a pixel comes out through the pane per metre of view depth.
float exit_rate(Inside inside, vec2 pixel)
{
    return dot(inside.facing, vec3((pixel - view_box.xy) / view_box.zw * 2.0 - 1.0, 1.0));
}

// Whether the picture shows something on the eye's side at a pixel.
bool hides_exit(Inside inside, vec2 pixel, float exit_rate)
{
    const float stored = buffer_depth(min(pixel, view_box.xy + view_box.zw - 1.0));
    return stored != inside.depth.z && inside.depth.y / (inside.depth.x + stored) * exit_rate < inside.reach;
}

// The picture does not contain what is hidden there, so what is beside it is shown instead. Along the line from this
// pixel, which shows something beyond the pane, to the pixel of the exit, the picture is mirrored at the edge of what
// hides it.
void mirror_at_edge(inout Path path, Inside inside)
{
    const vec2 here = PIXEL_HERE, exit_pixel = nearest_in(path.pixel), path_px = exit_pixel - here;
    const float out_here = exit_rate(inside, here), out_there = exit_rate(inside, exit_pixel);
    float open = 0.0, closed = 1.0;
    for (int i = 0; i < EDGE_STEPS; i++) {
        const float middle = 0.5 * (open + closed);
        const bool hidden = hides_exit(inside, here + middle * path_px, mix(out_here, out_there, middle));
        open = hidden ? open : middle;
        closed = hidden ? middle : closed;
    }
    const float length_px = length(path_px), edge = open * length_px, beyond = length_px - edge;
    // Neither so wide nor so close to the edge that what is inside gets into the look-up: a copy's texels reach half as
    // far again.
    const float max_back = max(min(MIRRORED * view_box.w, edge), 1e-3), back = max_back * beyond / (max_back + beyond);
    path.pixels = min(max(path.pixels, 0.5 * back), edge / 1.5);
    path.pixel = here + path_px * (max(edge - max(back, 1.5 * path.pixels), 0.0) / max(length_px, 1e-3));
}

void project_exit(inout Path path, vec3 d, float distance)
{
    const vec3 met_at = path.from + path.out_of * max(distance - length(path.from), 0.0);
    path.ahead = on_picture(distance > 0.0 ? vec4(met_at, 1.0) : vec4(path.out_of, 0.0), path.pixel);
    const Inside inside = inside_of_pane(d);
    const vec2 exit_pixel = nearest_in(path.pixel);
    path.hidden = path.ahead && hides_exit(inside, exit_pixel, exit_rate(inside, exit_pixel));
    if (path.hidden)
        mirror_at_edge(path, inside);
}

// On a surface that is not glass: the point of the surface that is seen through water of this height, displaced along
// the surface.
void look_under(inout Path path, vec3 d, vec3 flat_normal, float height)
{
    vec3 n = path.normal;
    n = dot(n, d) < -0.02 ? n : normalize(n - d * (dot(n, d) + 0.02));
    const vec3 in_water = refract(d, n, 1.0 / WATER);
    const vec3 under = height * (in_water / max(-dot(in_water, flat_normal), 0.1) - d / max(-dot(d, flat_normal), 0.1));
    path.reflects = fresnel(-dot(d, n), -dot(in_water, n), 1.0, WATER);
    path.mirrored = reflect(d, n);
    path.out_of = d;
    path.total = false;
    path.lost = 0.0;
    path.ahead = on_picture(vec4(path.from + under, 1.0), path.pixel);
}

// From whichever side the pane is seen.
void pass_through(inout Path path, vec3 d, vec3 flat_normal)
{
    if (SIDE == VIRGA_GLASS_DRAW_BEHIND)
        pass_outward(path, d, flat_normal);
    else if (SIDE == VIRGA_GLASS_DRAW_BEFORE)
        pass_inward(path, d, flat_normal);
    else if (dot(d, flat_normal) > 0.0)
        pass_outward(path, d, flat_normal);
    else
        pass_inward(path, d, flat_normal);
}

// Through water whose surface has this normal. `pixels`: see Path.
Path path_by_normal(vec3 d, vec3 normal, float pixels)
{
    const vec3 flat_normal = cross(along_u, along_v);
    Path path;
    path.normal = normal;
    path.from = position;
    path.hidden = false;
    path.pixels = pixels;
    if (HAS_DEPTH)
        path.from += glass_shift(d, flat_normal);
    pass_through(path, d, flat_normal);
    if (HAS_DEPTH)
        project_exit(path, d, scene_distance(d));
    else
        path.ahead = on_picture(vec4(path.out_of, 0.0), path.pixel);
    return path;
}

// `opaque`: the surface is not glass, by the pipeline or the settings.
Path path_through(vec3 d, Water water, float pixel_m, bool opaque)
{
    const vec3 flat_normal = cross(along_u, along_v);
    const vec3 normal = normalize(flat_normal - water.slope.x * along_u - water.slope.y * along_v);
    if (opaque) {
        Path path;
        path.normal = normal;
        path.from = position;
        path.hidden = false;
        path.pixels = 1.0;
        look_under(path, d, flat_normal, water.height);
        return path;
    }
    // Rays of neighbouring pixels diverge by (n - 1) times the change of slope from one pixel to the next.
    return path_by_normal(d, normal, 1.0 + (WATER - 1.0) * water.bend * pixel_m / gain_angle.y);
}
