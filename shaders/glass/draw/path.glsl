// path.glsl - rays from the eye through pane and water: where they come from.

#define WATER    1.333
#define OWN_M    0.001 // what is nearer to the pane lies in it: a frame
#define EDGE_STEPS 8  // halvings of the way to an edge

// A ray that has passed, or been thrown back.
struct Path {
    vec3 normal;    // of the water, outward
    vec3 out_of;    // direction it leaves the pane in, unit length; also the reflected one's where all is
    vec3 mirrored;  // direction that the water reflects from
    float reflects; // share of the light
    bool total;     // none passes
    float lost;     // (total) how far it is from passing: 0 nearly, 1 at all
    vec3 from;      // place that it leaves the pane at, relative to the camera
    bool ahead;     // before the camera
    bool hidden;    // what it meets is hidden on the picture, by what lies on the eye's side of the pane
    vec2 pixel;     // of the picture, that it meets; (hidden) that is shown instead
    float pixels;   // of the picture, that one of ours shows
};

// Unpolarised light that meets a surface at the angles with these cosines, from an index `n1` into `n2` (Fresnel).
float fresnel(float cos1, float cos2, float n1, float n2)
{
    const float s = (n1 * cos1 - n2 * cos2) / (n1 * cos1 + n2 * cos2);
    const float p = (n2 * cos1 - n1 * cos2) / (n2 * cos1 + n1 * cos2);
    return 0.5 * (s * s + p * p);
}

// Distance of the scene along the pixel's own ray, or 0 for far away.
float scene_distance(vec3 d)
{
    const float stored = HAS_DEPTH ? buffer_depth(gl_FragCoord.xy) : view.far_depth;
    if (stored == view.far_depth)
        return 0.0;
    const vec3 ahead = to_vec(view.ahead);
    // `ahead` has the length 1 along the camera's axis, and what lens shift adds across it.
    const vec3 axis = normalize(cross(to_vec(view.right), to_vec(view.up)));
    return view_depth(stored) * abs(dot(ahead, axis)) / max(abs(dot(d, axis)), 1e-4);
}

// From behind the pane: air, glass, water, air. The flat faces are parallel, so the ray is in the water as if there
// were no
// glass, only that the glass has shifted it. One that is thrown back goes on as the last that passes would, along the
// surface:
// what it shows is `lost` by how far it is beyond that.
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
    path.mirrored = reflect(d, n); // the glass between bends it little, and what it shows is faint
}

// From before the pane: air, water, glass, air.
void pass_inward(inout Path path, vec3 d, vec3 flat_normal)
{
    vec3 n = path.normal;
    n = dot(n, d) < -0.02 ? n : normalize(n - d * (dot(n, d) + 0.02)); // the far side of a steep drop is not seen
    const vec3 in_water = refract(d, n, 1.0 / WATER);
    path.reflects = fresnel(-dot(d, n), -dot(in_water, n), 1.0, WATER);
    path.mirrored = reflect(d, n);
    path.out_of = refract(in_water, flat_normal, WATER);
    path.total = path.out_of == vec3(0.0);
    path.lost = path.total ? 1.0 : 0.0;
    path.out_of = path.total ? path.mirrored : path.out_of;
    path.reflects = path.total ? 0.0 : path.reflects;
}

// Snell, in the direction only.
vec3 glass_shift(vec3 d, vec3 flat_normal)
{
    const vec3 n = dot(d, flat_normal) > 0.0 ? flat_normal : -flat_normal;
    const vec3 in_glass = refract(d, -n, 1.0 / 1.52);
    return look.thickness_m * (in_glass / max(dot(in_glass, n), 0.1) - d / max(dot(d, n), 0.1));
}

// What lies on the eye's side of the pane, taken as flat, or in it: pillars, a dashboard, the pane's frame, who sits
// there. A ray that has passed the pane can not meet them.
struct Inside {
    vec3 facing; // the way out through the pane, along the picture's right, its up and the camera's axis
    float reach; // m along it from the eye
    vec3 depth;  // depth_a, depth_b and far_depth of the view: read once, as software Vulkan does it lane by lane
};

Inside inside_of_pane(vec3 d)
{
    const vec3 normal = cross(along_u, along_v), out_of = normal * sign(dot(d, normal));
    return Inside(vec3(dot(to_vec(view.right), out_of), dot(to_vec(view.up), out_of), dot(to_vec(view.ahead), out_of)),
                  dot(position, out_of) + OWN_M, vec3(view.depth_a, view.depth_b, view.far_depth));
}

// How far out through the pane the ray through a pixel comes with each metre of view depth.
float way_out(Inside inside, vec2 pixel)
{
    return dot(inside.facing, vec3((pixel - view_box.xy) / view_box.zw * 2.0 - 1.0, 1.0));
}

// Whether that is what the picture has at a pixel.
bool is_inside(Inside inside, vec2 pixel, float way_out)
{
    const float stored = buffer_depth(min(pixel, view_box.xy + view_box.zw - 1.0));
    return stored != inside.depth.z && inside.depth.y / (inside.depth.x + stored) * way_out < inside.reach;
}

// The picture has nothing of what lies behind that. What is beside it is shown there: on the way from this pixel, which
// shows what is beyond the pane, to that where the ray would be, it is mirrored at the edge.
void show_beside(inout Path path, Inside inside)
{
    const vec2 here = gl_FragCoord.xy, there = nearest_in(path.pixel), way = there - here;
    const float out_here = way_out(inside, here), out_there = way_out(inside, there);
    float open = 0.0, closed = 1.0;
    for (int i = 0; i < EDGE_STEPS; i++) {
        const float middle = 0.5 * (open + closed);
        const bool hidden = is_inside(inside, here + middle * way, mix(out_here, out_there, middle));
        open = hidden ? open : middle;
        closed = hidden ? middle : closed;
    }
    const float far = length(way), edge = open * far, beyond = far - edge;
    // Not so wide, nor so near to the edge, that anything of what is inside comes in: a copy's texels reach half as far
    // again.
    const float most = max(min(MIRRORED * view_box.w, edge), 1e-3), back = most * beyond / (most + beyond);
    path.pixels = min(max(path.pixels, 0.5 * back), edge / 1.5);
    path.pixel = here + way * (max(edge - max(back, 1.5 * path.pixels), 0.0) / max(far, 1e-3));
}

void find_pixel(inout Path path, vec3 d, float distance)
{
    const vec3 place_at = path.from + path.out_of * max(distance - length(path.from), 0.0);
    path.ahead = on_picture(distance > 0.0 ? vec4(place_at, 1.0) : vec4(path.out_of, 0.0), path.pixel);
    const Inside inside = inside_of_pane(d);
    const vec2 there = nearest_in(path.pixel);
    path.hidden = path.ahead && is_inside(inside, there, way_out(inside, there));
    if (path.hidden)
        show_beside(path, inside);
}

// On a surface that is not glass: the place on it that is seen through water so high, displaced along the surface.
void find_under(inout Path path, vec3 d, vec3 flat_normal, float height)
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

// From the side that the pane is seen from.
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

// On what is not glass: `opaque` as the pipeline or the settings say.
Path path_through(vec3 d, Water water, float pixel_m, bool opaque)
{
    const vec3 flat_normal = cross(along_u, along_v);
    Path path;
    path.normal = normalize(flat_normal - water.slope.x * along_u - water.slope.y * along_v);
    path.from = position;
    path.hidden = false;
    path.pixels = 1.0;
    if (opaque) {
        find_under(path, d, flat_normal, water.height);
        return path;
    }
    // Rays of neighbouring pixels spread by (n - 1) x the change of the slope from one to the next.
    path.pixels += (WATER - 1.0) * water.bend * pixel_m / gain_angle.y;
    if (HAS_DEPTH)
        path.from += glass_shift(d, flat_normal);
    pass_through(path, d, flat_normal);
    if (HAS_DEPTH)
        find_pixel(path, d, scene_distance(d));
    else
        path.ahead = on_picture(vec4(path.out_of, 0.0), path.pixel);
    return path;
}
