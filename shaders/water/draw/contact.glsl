// contact.glsl - the contact line: where the water's surface meets the scene. See gpu/scene_depth.glsl.
//
// Particles end half a spacing before a solid, and their surface bends down there, into a gap. Nearer than REACH to a
// solid it is therefore drawn anew. The solid is the plane that the scene's picture shows behind the pixel. Where
// water is farther from it, at REACH, its surface goes on as a plane up to the solid, with the meniscus that surface
// tension makes. Where there is none it is a thin layer: its border is a wedge.
// The includer has surface.glsl, and pixel_of.
#include "contact_limits.glsl"

#define REACH         2.0    // spacings
#define GAP           0.8    // spacings: the widest gap between the surface and a solid
#define THIN          1.6    // spacings: a layer that is as high is not thin
#define WEDGE         1.5    // spacings: how wide the border of a thin layer is
#define GRAZING       0.15   // cosine: surfaces that are seen from aside hide the gap behind them
#define CAPILLARY_M   0.0027 // sqrt(tension / (density gravity)) of water
#define CONTACT_RAD   0.35   // angle of water on stone, wood and glass that are not clean
#define STEEPEST      0.75   // cosine between surface and solid: with more it is a thin layer or a film

struct Water {
    vec2 at;     // in the images, where it is taken from
    float depth; // view depth
    vec3 normal;
    float covered;
    bool is_new; // drawn anew here
};

struct Solid {
    vec3 point; // relative to the camera
    vec3 normal;
};

vec2 image_at(vec3 p) { return image_pixel(pixel_of(p)); }
vec3 ray_of_image(vec2 at) { return pixel_ray(at / look.scale + vec2(view.viewport[0], view.viewport[1])); }

vec3 scene_point(vec2 pixel)
{
    const vec2 center = floor(inside_view(pixel)) + 0.5;
    return pixel_ray(center) * view_depth(buffer_depth(center));
}

// Of the two differences along an axis the smaller one: the other may cross the edge of an object.
vec3 scene_slope(vec3 here, vec2 aside)
{
    const vec3 ahead = scene_point(PIXEL_HERE + aside) - here, back = here - scene_point(PIXEL_HERE - aside);
    return dot(ahead, ahead) < dot(back, back) ? ahead : back;
}

Solid solid_here()
{
    Solid solid;
    solid.point = scene_point(PIXEL_HERE);
    const vec3 across = cross(scene_slope(solid.point, vec2(1, 0)), scene_slope(solid.point, vec2(0, 1)));
    solid.normal = normalize(across) * (dot(across, solid.point) > 0.0 ? -1.0 : 1.0);
    return solid;
}

float above(Solid solid, vec3 p) { return dot(p - solid.point, solid.normal); }

// The water's surface at REACH from the solid, beside `from`; `covered` 0: there is none. `is_high`: there is water
// that is higher over the solid than a thin layer.
Water beside_solid(Solid solid, vec3 from, out bool is_high)
{
    Water found;
    vec3 p = from;
    const vec2 size = vec2(look.width, look.height);
    const float reach = REACH * look.spacing_m;
    float distance = above(solid, from);
    found.covered = 0.0;
    found.is_new = false;
    is_high = false;
    for (int i = 0; i < 3; i++) {
        p += solid.normal * (reach - distance);
        found.at = image_at(p);
        if (any(lessThan(found.at, vec2(0.5))) || any(greaterThan(found.at, size - 0.5)))
            return found;
        const vec4 sums = between_texels(sums_image, found.at, ivec2(size));
        found.depth = sums.z / max(sums.w, 1e-12);
        found.normal = normal_of(sums.xy / max(sums.w, 1e-12));
        p = ray_of_image(found.at) * found.depth;
        distance = above(solid, p);
        is_high = is_high || (sums.w >= 0.5 && distance > THIN * look.spacing_m);
        if (sums.w < 0.5 || length(p - from) > 2.0 * reach)
            return found;
    }
    found.covered = 1.0 - smoothstep(0.1, 0.3, abs(distance / reach - 1.0));
    return found;
}

// How far the surface is turned towards the solid at a distance from it, by surface tension. Small slopes decay as an
// exponential. A pixel that is wider than the meniscus has its mean.
float meniscus_turn(float at_wall, float distance, float pixel_m)
{
    return at_wall * exp(-max(distance, 0.0) / CAPILLARY_M) * CAPILLARY_M / (CAPILLARY_M + pixel_m);
}

// The height of the meniscus over the plane that the surface is without it: 2 a sin(turn / 2) with the capillary length
// a, as far as the surface is flat along the solid.
float rise_of(float turn) { return 2.0 * CAPILLARY_M * sin(0.5 * turn); }

// How far the water that the picture shows at a point lies over a plane (spacings).
float over_plane(vec3 p, vec3 normal, float plane)
{
    const vec2 at = image_at(p);
    const vec4 sums = sums_at(clamp(at, vec2(0.5), vec2(look.width, look.height) - 0.5));
    return sums.w < 0.5 ? -1e9 : (dot(ray_of_image(at), normal) * sums.z / sums.w - plane) / look.spacing_m;
}

// Water lies under the plane in which it goes on, by no more than it bends down at its end.
float share_of_plane(float over, float high)
{
    return smoothstep(-0.9, -0.6, over) * (1.0 - smoothstep(0.25 * high, high, over));
}

// The surface through `beside` goes on to the solid. Along the ray, the height over it falls and the meniscus rises, so
// they meet once.
void extend(inout Water water, bool wet, Water beside, Solid solid, vec3 ray, float scene)
{
    const float cosine = dot(beside.normal, solid.normal), facing = dot(ray, beside.normal);
    const float steep = smoothstep(1.0, 2.0, -facing / (length(ray) * (wet ? GRAZING : 1.8 * GRAZING)));
    if (abs(cosine) > STEEPEST || steep <= 0.0)
        return;
    const float at_wall = max(acos(cosine) - CONTACT_RAD, 0.0), pixel_m = look.pixel_angle * scene;
    const float plane = dot(ray_of_image(beside.at), beside.normal) * beside.depth;
    float near = (plane + rise_of(at_wall)) / facing, far = plane / facing, turn = 0.0;
    for (int i = 0; i < 8; i++) {
        const float middle = 0.5 * (near + far);
        turn = meniscus_turn(at_wall, above(solid, ray * middle), pixel_m);
        const bool is_over = facing * middle - plane > rise_of(turn);
        near = is_over ? middle : near;
        far = is_over ? far : middle;
    }
    const float distance = above(solid, ray * near) / look.spacing_m;
    if (near >= scene || distance > (wet ? REACH : GAP))
        return;
    const vec3 along = normalize(solid.normal - beside.normal * cosine);
    const vec3 ahead = along * (max(GAP - distance, 0.0) * look.spacing_m / dot(along, solid.normal));
    float share = steep * beside.covered * share_of_plane(over_plane(ray * near + ahead, beside.normal, plane), 0.4);
    if (wet)
        share *= share_of_plane((facing * water.depth - plane) / look.spacing_m, 0.1);
    if (share <= 0.0)
        return;
    const vec3 normal = beside.normal * cos(turn) + along * sin(turn);
    water.at = wet ? water.at : beside.at;
    water.depth = wet ? mix(water.depth, near, share) : near;
    water.normal = wet ? normalize(mix(water.normal, normal, share)) : normal;
    water.covered = max(water.covered, share);
    water.is_new = true;
}

// Distance of a point of a thin layer from its border, [0; 1] of WEDGE spacings: by the part of a circle around it that
// is covered, which is a half at the border.
float from_border(Solid solid, vec3 p)
{
    const vec3 right = normalize(cross(solid.normal, p)), ahead = cross(solid.normal, right);
    const vec2 size = vec2(look.width, look.height);
    float sum = 0.0;
    for (int i = 0; i < 8; i++) {
        const float angle = (float(i) + 0.5) * 0.78539816;
        const vec3 beside = p + WEDGE * look.spacing_m * (cos(angle) * right + sin(angle) * ahead);
        sum += min(sums_at(clamp(image_at(beside), vec2(0.5), size - 0.5)).w, 1.0);
    }
    return clamp(0.25 * sum - 1.0, 0.0, 1.0);
}

// The border of a layer of one or two particles: a wedge, whose height falls to 0.
void thin_out(inout Water water, Solid solid, vec3 ray, float scene)
{
    const vec3 p = ray * water.depth;
    const float height = above(solid, p) / look.spacing_m, thin = 1.0 - smoothstep(1.0, THIN, height);
    if (thin <= 0.0 || height < 0.0)
        return;
    const float inside = from_border(solid, p);
    const float cosine = dot(water.normal, solid.normal), angle = acos(clamp(cosine, -1.0, 1.0));
    const vec3 aside = water.normal - solid.normal * cosine;
    const float wanted = mix(angle, min(angle, CONTACT_RAD), thin * (1.0 - inside));
    if (length(aside) > 1e-4)
        water.normal = solid.normal * cos(wanted) + normalize(aside) * sin(wanted);
    water.depth = mix(water.depth, scene, thin * (1.0 - inside) * 0.98);
    water.is_new = true;
}

// The water at this pixel, drawn anew if it is near a solid. `ray` is as long as a metre of view depth.
Water with_contact(Water water, vec3 ray)
{
    const float stored = buffer_depth(PIXEL_HERE), spacing = look.spacing_m;
    if (stored == view.far_depth || thickness_at(image_pixel(PIXEL_HERE)) <= 0.0)
        return water;
    const float scene = view_depth(stored), before = scene - water.depth;
    const bool wet = water.covered > 0.5 && before > 0.0;
    if (look.pixel_angle * scene * MIN_PX > spacing || (wet && before > FAR_SPACINGS * spacing))
        return water;
    const Solid solid = solid_here();
    const vec3 from = wet ? ray * water.depth : solid.point;
    if (above(solid, from) > REACH * spacing)
        return water;
    bool is_high;
    const Water beside = beside_solid(solid, from, is_high);
    Water result = water;
    if (beside.covered > 0.0)
        extend(result, wet, beside, solid, ray, scene);
    if (wet && !is_high)
        thin_out(result, solid, ray, scene);
    return result;
}

// The contact line is as wide as a pixel. view.soft_m would hide the meniscus.
float edge_of_contact(float depth)
{
    const float pixel_m = look.pixel_angle * depth * look.scale;
    return soft_step(view_depth(buffer_depth(PIXEL_HERE)) - depth, min(view.soft_m, 0.5 * pixel_m));
}
