// divide.glsl - surfels with colors of their own, and their division into parts (section 5 of Iwasaki et al. 2006).
//
// Four colors are computed in a surfel, in the centers of four parts of half its radius. Where they differ too much,
// the parts take its place, and each is treated in the same way. What is not divided gets the mean of its four colors.
// The offset of the parts leaves the spread of a splat's weight as it is: (1 - r^2)^2 has a mean square of 1/8 along
// each axis, and 1/8 = offset^2 + 1/4 1/8.
//
// A surfel and its parts are nodes of a tree: the surfel is node 0, and the parts of node n are 4 n + 1 to 4 n + 4.
#define HAS_DEPTH (view.depth_given != 0u)
#define HAS_COLOR (view.color_given != 0u)
#define SCALED (look.scale < 1.0)
#define PIXEL_HERE here_px
vec2 here_px;
#define SCENE_DEPTH_BINDING 17
#include "gpu/scene_depth.glsl"
#include "gpu/light.glsl"
#include "surface.glsl"
#include "light.glsl"

layout(std430, set = 0, binding = 24) buffer Divisions
{
    uvec2 divisions[]; // for each visible surfel: bits of nodes that are divided; how many parts that adds, then the
                       // sum of these over the surfels before it
};

// Nodes down to a level: 1, 5, 21, 85.
uint nodes_to(uint level) { return ((4u << 2u * level) - 1u) / 3u; }

// Center of part 0, 1, 2 or 3, in radii of what is divided.
vec2 part_offset(uint part)
{
    return VIRGA_WATER_PART_OFFSET * vec2((part & 1u) != 0u ? 1.0 : -1.0, (part & 2u) != 0u ? 1.0 : -1.0);
}

// Center of a node in radii of its surfel; z: its own radius.
vec3 node_disc(uint node)
{
    vec3 disc = vec3(0.0, 0.0, 1.0);
    for (uint at = node; at != 0u; at = (at - 1u) >> 2)
        disc = vec3(part_offset((at - 1u) & 3u) + 0.5 * disc.xy, 0.5 * disc.z);
    return disc;
}

// A point of a surfel's disc; `at`: in its radii.
vec3 disc_point(Surfel s, vec2 at)
{
    const vec3 first = normalize(abs(s.normal.y) < 0.7 ? vec3(s.normal.z, 0.0, -s.normal.x)
                                                       : vec3(0.0, s.normal.z, -s.normal.y));
    return s.position + look.surfel_scale * s.radius * (at.x * first + at.y * cross(s.normal, first));
}

vec3 color_at(Surfel s, vec3 position)
{
    Point point;
    point.position = position;
    point.incident = normalize(position);
    point.normal = seen_normal(s.normal, point.incident);
    point.depth = project(to_mat(view.clip_from_rel), position).w;
    point.spread = 0.0;
    here_px = inside_view(pixel_of(position));
    point.thickness = thickness_at(image_pixel(here_px));
    return light_of(point);
}

// Mean of the four colors of a node. `difference`: how far they are apart in the worst channel, in parts of the mean of
// the brightest one.
vec3 color_of(Surfel s, uint node, out float difference)
{
    const vec3 disc = node_disc(node);
    vec3 low = vec3(1e30), high = vec3(-1e30), sum = vec3(0.0);
    for (uint part = 0u; part < 4u; part++) {
        const vec3 color = color_at(s, disc_point(s, disc.xy + disc.z * part_offset(part)));
        low = min(low, color);
        high = max(high, color);
        sum += color;
    }
    const vec3 mean = 0.25 * sum, apart = high - low;
    difference = max(apart.r, max(apart.g, apart.b)) / max(max(mean.r, max(mean.g, mean.b)), 1e-12);
    return mean;
}
