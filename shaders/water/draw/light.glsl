// light.glsl - the light that comes from a point of the water's surface. See gpu/scene_depth.glsl for PIXEL_HERE.
#include "scene_color.glsl"
layout(set = 0, binding = 19) uniform sampler2D panorama;

#include "fresnel.glsl"

#define STEPS 12    // at most, of the search for where a ray meets the scene
#define CLOSE 0.002 // it ends when a step changes the length by less than this part
#define BETWEEN_PX 3.0
#define SAME  0.03  // and what it found counts if it does not miss the scene by more

struct Point {
    vec3 position; // relative to the camera
    vec3 incident; // direction of view
    vec3 normal;
    float depth;     // view depth
    float thickness; // of the water along the direction of view, m
    float spread;    // variance of the normal within the pixel
};

vec3 around(vec3 direction)
{
    if (look.panorama_given == 0u)
        return environment(direction, vec2(1.0));
    const vec2 at = vec2(atan(direction.x, -direction.z) * 0.15915494 + 0.5,
                         acos(clamp(direction.y, -1.0, 1.0)) * 0.31830989);
    return textureLod(panorama, at, 0.0).rgb;
}

// ---- what is seen through the water

// A ray in the water. It goes straight to where it leaves the water, and on in a direction between its own and that of
// view: a thin sheet has parallel sides and deflects nothing in the end, in thick water the ray is soon lost.
struct Path {
    vec3 in_water, out_of_water;
    float length_m; // in the water
    float cos_air, cos_water;
};

vec3 on_path(Point point, Path path, float s)
{
    return point.position + path.in_water * min(s, path.length_m) + path.out_of_water * max(s - path.length_m, 0.0);
}

vec2 pixel_of(vec3 p)
{
    const vec4 clip = project(to_mat(view.clip_from_rel), p);
    return vec2(view.viewport[0], view.viewport[1]) +
           (0.5 * clip.xy / max(clip.w, 1e-4) + 0.5) * vec2(view.viewport[2], view.viewport[3]);
}

vec2 inside_view(vec2 pixel)
{
    const vec2 low = vec2(view.viewport[0], view.viewport[1]);
    return clamp(pixel, low + 0.5, low + vec2(view.viewport[2], view.viewport[3]) - 0.5);
}

// How far what the scene's picture shows at a pixel lies behind the plane of the surface at the point.
float below_surface(Point point, vec2 pixel)
{
    const float stored = buffer_depth(pixel), depth = stored == view.far_depth ? 1e4 : view_depth(stored);
    return dot(point.normal, point.position - pixel_ray(floor(pixel) + 0.5) * depth); // where the depth was taken
}

// The length along the path to the scene that the picture shows where the path is after the length s. The scene there
// is taken as a plane that is parallel to the surface of the water.
float next_length(Point point, Path path, float s)
{
    const vec2 pixel = inside_view(pixel_of(on_path(point, path, s)));
    const float below = max(below_surface(point, pixel), 0.0), wet = path.length_m * path.cos_water;
    return below < wet ? below / path.cos_water
                       : path.length_m + (below - wet) / max(-dot(path.out_of_water, point.normal), 0.1);
}

// An object that the ray meets before the length `far`: those steps may have gone past it. The picture is looked at
// every BETWEEN_PX along the path.
float nearer_meeting(Point point, Path path, float far)
{
    const float shift = distance(pixel_of(on_path(point, path, far)), PIXEL_HERE);
    const int steps = int(min(shift / BETWEEN_PX, float(STEPS)));
    for (int i = 1; i < steps; i++) {
        const float s = far * float(i) / float(steps);
        float met = next_length(point, path, s);
        if (met > (1.0 - SAME) * s)
            continue; // the ray is not behind what is seen there
        for (int k = 0; k < 4; k++) {
            const float next = next_length(point, path, met);
            if (abs(next - met) <= (k < 3 ? CLOSE : SAME) * met)
                return met;
            met = next;
        }
    }
    return far;
}

// Where the ray meets the scene, as a length along the path: exact for a flat bottom, and on other scenes each step
// comes nearer. Where the ray passes behind the edge of an object there is no such length: the picture shows the
// background where the ray is before the edge, and the object where it is behind. The ray then sees what the picture
// shows just before the edge.
float last_meeting(Point point, Path path)
{
    float s = 0.0, next = 0.0, before = 0.0, behind = 1e30;
    for (int i = 0; i < STEPS; i++) {
        s = next >= before && next < behind ? next : 0.5 * (before + behind);
        next = next_length(point, path, s);
        if (abs(next - s) <= CLOSE * max(next, s))
            return s; // whose pixel was looked at; that of `next` may be beyond an edge
        if (next < s)
            behind = min(behind, s);
        else
            before = max(before, s);
    }
    return abs(next - s) > SAME * max(next, s) ? before : s;
}

float meeting(Point point, Path path) { return nearer_meeting(point, path, last_meeting(point, path)); }

// Whether the edge of an object runs between the four texels around a position in the picture. Their mean would show
// the object beside itself, as a thin line.
bool is_at_edge(vec2 pixel)
{
    if (!HAS_DEPTH)
        return false;
    float nearest = 1e30, farthest = 0.0;
    for (int i = 0; i < 4; i++) {
        const float stored = buffer_depth(inside_view(pixel - 0.5 + vec2(i & 1, i >> 1)));
        const float depth = stored == view.far_depth ? 1e4 : view_depth(stored);
        nearest = min(nearest, depth);
        farthest = max(farthest, depth);
    }
    return farthest > 1.05 * nearest;
}

// The host's picture where the ray meets it, unless that is in front of the water.
vec3 scene_through(Point point, float s, Path path)
{
    const vec2 own = PIXEL_HERE, pixel = pixel_of(on_path(point, path, s));
    const vec2 shifted = own + look.refraction * (pixel - own);
    const vec2 between = inside_view(shifted), inside = is_at_edge(between) ? floor(between) + 0.5 : between;
    const bool behind = !HAS_DEPTH || buffer_depth(inside) == view.far_depth || below_surface(point, inside) > 0.0;
    const vec4 texels = between_texels(scene_color, behind ? inside : own, textureSize(scene_color, 0));
    const vec3 color = host_color(texels.rgb, view.color_given);
    const vec2 outside = abs(shifted - inside) / vec2(view.viewport[2], view.viewport[3]);
    return mix(color, around(path.in_water), clamp(16.0 * max(outside.x, outside.y), 0.0, 1.0));
}

// Beer and Lambert's law, and light that is scattered once.
vec3 through(Point point, Path path)
{
    const float s = HAS_DEPTH ? meeting(point, path) : 1e4, wet = min(s, path.length_m);
    const vec3 behind = HAS_COLOR ? scene_through(point, s, path) : around(path.in_water);
    const vec3 absorbed = to_vec(look.absorption_1_m), scattered = to_vec(look.scattering_1_m);
    const vec3 lost = absorbed + scattered, left = exp(-lost * wet);
    const vec3 ambient = sh_coefficient(0u) * 0.282095;
    return behind * left + ambient * (scattered / max(lost, vec3(1e-6))) * (1.0 - left);
}

Path path_of(Point point)
{
    Path path;
    path.cos_air = -dot(point.incident, point.normal);
    path.in_water = refract(point.incident, point.normal, 1.0 / WATER);
    path.cos_water = -dot(path.in_water, point.normal);
    // The thickness is measured along the view. The water is taken as a layer below the surface.
    path.length_m = point.thickness * path.cos_air / path.cos_water;
    const float thick = path.length_m / (path.length_m + 2.0 * look.spacing_m);
    path.out_of_water = normalize(mix(point.incident, path.in_water, thick));
    return path;
}

// ---- what it mirrors

#define LEAST_ROUGHNESS 1e-3

// A lamp's highlight: the distribution of Trowbridge and Reitz, as wide as the lamp and as the normals in the pixel.
vec3 highlights(Point point)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < view.light_count; i++) {
        const Lamp lamp = lamp_at(i, point.position);
        const vec3 half_way = normalize(lamp.towards - point.incident);
        const float cosine = max(dot(half_way, point.normal), 0.0), lit = max(dot(lamp.towards, point.normal), 0.0);
        const float size = LAMP_RADIUS_M * LAMP_RADIUS_M / lamp.distance2;
        const float a2 = min(LEAST_ROUGHNESS + 2.0 * point.spread + 0.25 * size, 1.0);
        const float peak = cosine * cosine * (a2 - 1.0) + 1.0, distribution = a2 / (3.14159265 * peak * peak);
        const float facing = max(-dot(point.incident, half_way), 0.0);
        const float in_water = sqrt(1.0 - (1.0 - facing * facing) / (WATER * WATER));
        sum += lamp.light * (distribution * fresnel(facing, in_water) * step(1e-4, lit) /
                             (4.0 * max(-dot(point.incident, point.normal), 0.05)));
    }
    return sum * view.light_gain;
}

vec3 light_of(Point point)
{
    const Path path = path_of(point);
    const float mirrored = look.reflection * fresnel(path.cos_air, path.cos_water);
    return mix(through(point, path), around(reflect(point.incident, point.normal)), min(mirrored, 1.0)) +
           look.reflection * highlights(point);
}
