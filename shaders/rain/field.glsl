// field.glsl - what every pass over the field of drops shares: slots, drops, boxes, weights, occlusion.
#include "tick.glsl"
#include "gpu/texels.glsl"

// See VIRGA_RAIN_FORM. Software Vulkan runs every lane through what a branch would skip, so what a rain was made
// without is left out of its pipelines.
layout(constant_id = 0) const uint FORM = 0u;
const uint CASCADES = FORM & 7u;
const uint SLANTS = (FORM >> 3) & 7u;
const bool SWAYS = (FORM & 64u) != 0u;

TEXELS(slot_texel, 2, 22)
TEXELS(drop_texel, 20, 3)
#ifndef SWAYS_ACCESS
#define SWAYS_ACCESS readonly
#endif
layout(scalar, set = 0, binding = 8) SWAYS_ACCESS buffer Sways { virga_sway_gpu sways[]; };
layout(scalar, set = 0, binding = 15) readonly buffer Weights
{
    virga_weight_gpu weights[]; // of class k in box l at l * VIRGA_RAIN_CLASSES + k
};
layout(set = 0, binding = 9) uniform sampler2DArray occlusion_depth;
layout(set = 0, binding = 10) uniform usampler2DArray occlusion_surface;

#define RANK_SOFTNESS 0.05 // share of ranks that fade where the rate changes; the C side inverts it
#define FADE_FROM 0.75     // of a box's half side, where it begins to hand over to the next

virga_slot_gpu slot_of(uint slot_index)
{
    const uvec4 texel = slot_texel(slot_index);
    return virga_slot_gpu(uint[3](texel.x, texel.y, texel.z), texel.w);
}

// The drop that a slot has at the end of the tick.
virga_drop_gpu drop_of(uint slot_index)
{
    const uvec4 texel = drop_texel(slot_index);
    const vec3 position = uintBitsToFloat(texel.xyz);
    return virga_drop_gpu(float[3](position.x, position.y, position.z), texel.w);
}

vec3 velocity_of(uint slot_index, uint size_class)
{
    vec3 velocity = to_vec(classes[size_class].velocity);
    if (SWAYS && tick.sway != 0u)
        velocity += to_vec(sways[slot_index].velocity);
    return velocity;
}

// The box that a slot lies in. Whole numbers are divided lane by lane on software Vulkan, and a quotient of at most
// 16384 / 1 is right in float, half a group away from the next.
uint slot_level(uint slot_index)
{
    return uint((float(slot_index / VIRGA_RAIN_GROUP) + 0.5) * tick.levels_per_group);
}

// Radius of the square around the camera: boxes are cubes.
float box_radius(vec3 p) { return max(max(abs(p.x), abs(p.y)), abs(p.z)); }

float box_share(float radius, float half_side) { return 1.0 - smoothstep(FADE_FROM * half_side, half_side, radius); }

// How much of space at a radius belongs to a box: over all boxes it adds up to 1 (within the range).
float level_share(float radius, uint level)
{
    const float half_side = 0.5 * tick.side_m * exp2(float(level + 1u) - float(tick.levels));
    const float inner = level > 0u ? box_share(radius, 0.5 * half_side) : 0.0;
    return max(box_share(radius, half_side) - inner, 0.0);
}

// Drops that a slot stands for where its box is the only one.
float full_weight(uint level, uint size_class, uint rank)
{
    const virga_weight_gpu weight = weights[level * VIRGA_RAIN_CLASSES + size_class];
    const float presence = clamp((weight.threshold - float(rank) * (1.0 / 65536.0)) / RANK_SOFTNESS, 0.0, 1.0);
    return presence * weight.drops;
}

// The same at a place relative to the origin; 0: the slot is not in use here and now.
float drop_weight(vec3 p, uint level, uint size_class, uint rank)
{
    return full_weight(level, size_class, rank) * level_share(box_radius(p), level);
}

// Where a place is in the occlusion maps.
struct MapPlace {
    virga_map_gpu map;
    uint index;     // VIRGA_RAIN_MAX_MAPS: in none
    vec2 texel;
};

// Where the line of fall through a place first meets something.
struct Shelter {
    float height;   // of that point, relative to the origin; far below where nothing is known
    uint map;       // VIRGA_RAIN_MAX_MAPS: none
    ivec3 texel;
};

#define NOTHING_BELOW -1e9 // height where nothing is known
#define MOST_OFFSET 4.0    // texels that a slope can add to a height

// Height on the plane of the texel's surface, not only at its middle, so that slopes are not stairs. With the map's
// coordinate X = x + s (y - y0), a plane n.p = c has dy/dX = -n.x / (n.y - n.x s.x - n.z s.z).
float plane_offset(virga_map_gpu map, vec2 from_middle, vec3 normal)
{
    const float texel_m = 1.0 / map.texels_per_m;
    const float across = normal.y - (normal.x * map.slant[0] + normal.z * map.slant[1]) * texel_m;
    if (abs(across) < 0.05)
        return 0.0;
    const float offset = -dot(normal.xz, from_middle) * texel_m / across;
    return clamp(offset, -MOST_OFFSET * texel_m, MOST_OFFSET * texel_m);
}

vec2 map_texel(virga_map_gpu map, vec3 p)
{
    return p.xz * map.texels_per_m + vec2(map.slant[0], map.slant[1]) * p.y + vec2(map.origin[0], map.origin[1]);
}

// The finest map that holds the place; the outermost texels do not count. Straight-line code: software Vulkan runs
// every lane through every branch, so all maps are looked at by constant index, and one is kept by arithmetic.
MapPlace map_place(vec3 p, uint slant)
{
    MapPlace place = MapPlace(maps[0], VIRGA_RAIN_MAX_MAPS, vec2(0.0));
    for (uint i = CASCADES * SLANTS; i > 0u; i--) {
        const virga_map_gpu map = maps[i - 1u];
        const vec2 at = map_texel(map, p);
        const bool inside =
            (i - 1u) % SLANTS == slant && min(at.x, at.y) >= 1.0 && max(at.x, at.y) < tick.map_texels - 1.0;
        place.index = inside ? i - 1u : place.index;
        place.texel = inside ? at : place.texel;
        place.map.texels_per_m = inside ? map.texels_per_m : place.map.texels_per_m;
        place.map.slant[0] = inside ? map.slant[0] : place.map.slant[0];
        place.map.slant[1] = inside ? map.slant[1] : place.map.slant[1];
    }
    place.index = tick.maps > 0u ? place.index : VIRGA_RAIN_MAX_MAPS;
    return place;
}

ivec3 texel_of(MapPlace place) { return ivec3(place.texel, place.index < VIRGA_RAIN_MAX_MAPS ? place.index : 0u); }

// Height of the surface in the middle of the place's texel.
float middle_height(MapPlace place)
{
    const float depth = texelFetch(occlusion_depth, texel_of(place), 0).r;
    const bool known = place.index < VIRGA_RAIN_MAX_MAPS && depth < 1.0;
    return known ? tick.map_top_m - depth * tick.map_height_m : NOTHING_BELOW;
}

Shelter find_shelter(vec3 p, uint slant)
{
    const MapPlace place = map_place(p, slant);
    Shelter found = Shelter(middle_height(place), place.index, texel_of(place));
    const ivec3 surface_texel = tick.host_depth != 0u ? ivec3(0) : found.texel; // a host's depth has no surfaces
    const vec3 normal = unpack_normal(texelFetch(occlusion_surface, surface_texel, 0).r);
    const float offset = plane_offset(place.map, fract(place.texel) - 0.5, normal);
    found.height += tick.host_depth != 0u || found.height == NOTHING_BELOW ? 0.0 : offset;
    return found;
}
