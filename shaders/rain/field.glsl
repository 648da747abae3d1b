// field.glsl - what all passes over the drops share: slots, drops, the boxes around the camera, weights, occlusion
// maps.
#include "tick.glsl"
#include "gpu/texels.glsl"

// See VIRGA_RAIN_FORM. Software Vulkan runs every lane through branches that it would skip, so options that a rain is
// created without are compiled out of its pipelines.
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

#define RANK_SOFTNESS 0.05 // range of ranks that fade where the rate changes; the C side inverts it
#define FADE_FROM 0.75     // of a box's half side: from here on the box fades into the next one

virga_slot_gpu slot_of(uint slot_index)
{
    const uvec4 texel = slot_texel(slot_index);
    return virga_slot_gpu(uint[3](texel.x, texel.y, texel.z), texel.w);
}

// A slot's drop, at the end of the tick.
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

// The box of a slot. Software Vulkan divides integers lane by lane. A quotient of up to 16384 / 1 is exact in float
// here, because it is half a group away from the next integer.
uint slot_level(uint slot_index) { return uint((float(slot_index / VIRGA_RAIN_GROUP) + 0.5) * tick.levels_per_group); }

// Distance from the camera in the maximum norm: boxes are cubes.
float box_radius(vec3 p) { return max(max(abs(p.x), abs(p.y)), abs(p.z)); }

float box_share(float radius, float half_side) { return 1.0 - smoothstep(FADE_FROM * half_side, half_side, radius); }

// The part of space at a distance that belongs to a box; over all boxes the parts add up to 1 (within the range).
float level_share(float radius, uint level)
{
    const float half_side = 0.5 * tick.side_m * exp2(float(level + 1u) - float(tick.levels));
    const float inner = level > 0u ? box_share(radius, 0.5 * half_side) : 0.0;
    return max(box_share(radius, half_side) - inner, 0.0);
}

// The number of drops that a slot stands for, where its box is the only one.
float full_weight(uint level, uint size_class, uint rank)
{
    const virga_weight_gpu weight = weights[level * VIRGA_RAIN_CLASSES + size_class];
    const float presence = clamp((weight.threshold - float(rank) * (1.0 / 65536.0)) / RANK_SOFTNESS, 0.0, 1.0);
    return presence * weight.drops;
}

// The same at a point relative to the origin; 0: the slot is not used there.
float drop_weight(vec3 p, uint level, uint size_class, uint rank)
{
    return full_weight(level, size_class, rank) * level_share(box_radius(p), level);
}

// A position in the occlusion maps.
struct MapPosition {
    virga_map_gpu map;
    uint index; // VIRGA_RAIN_MAX_MAPS: in no map
    vec2 texel;
};

// The first surface on the line of fall through a point.
struct Cover {
    float height; // of that surface, relative to the origin; far below if unknown
    uint map;     // VIRGA_RAIN_MAX_MAPS: none
    ivec3 texel;
};

#define NOTHING_BELOW -1e9 // height if unknown
#define MAX_OFFSET 4.0     // limit, in texels, of what a slope adds to a height

// Height offset on the plane of the texel's surface, not only at its middle, so that slopes have no steps. With the
// map's coordinate X = x + s (y - y0), a plane n.p = c has dy/dX = -n.x / (n.y - n.x s.x - n.z s.z).
float plane_offset(virga_map_gpu map, vec2 from_middle, vec3 normal)
{
    const float texel_m = 1.0 / map.texels_per_m;
    const float steepness = normal.y - (normal.x * map.slant[0] + normal.z * map.slant[1]) * texel_m;
    if (abs(steepness) < 0.05)
        return 0.0;
    const float offset = -dot(normal.xz, from_middle) * texel_m / steepness;
    return clamp(offset, -MAX_OFFSET * texel_m, MAX_OFFSET * texel_m);
}

vec2 map_texel(virga_map_gpu map, vec3 p)
{
    return p.xz * map.texels_per_m + vec2(map.slant[0], map.slant[1]) * p.y + vec2(map.origin[0], map.origin[1]);
}

// The finest map that contains the point; its outermost texels do not count. Straight-line code: software Vulkan runs
// every lane through every branch, so all maps are tested by constant index, and one is selected by arithmetic.
MapPosition map_position(vec3 p, uint slant)
{
    MapPosition position = MapPosition(maps[0], VIRGA_RAIN_MAX_MAPS, vec2(0.0));
    for (uint i = CASCADES * SLANTS; i > 0u; i--) {
        const virga_map_gpu map = maps[i - 1u];
        const vec2 at = map_texel(map, p);
        const bool inside =
            (i - 1u) % SLANTS == slant && min(at.x, at.y) >= 1.0 && max(at.x, at.y) < tick.map_texels - 1.0;
        position.index = inside ? i - 1u : position.index;
        position.texel = inside ? at : position.texel;
        position.map.texels_per_m = inside ? map.texels_per_m : position.map.texels_per_m;
        position.map.slant[0] = inside ? map.slant[0] : position.map.slant[0];
        position.map.slant[1] = inside ? map.slant[1] : position.map.slant[1];
    }
    position.index = tick.maps > 0u ? position.index : VIRGA_RAIN_MAX_MAPS;
    return position;
}

ivec3 texel_of(MapPosition position)
{
    return ivec3(position.texel, position.index < VIRGA_RAIN_MAX_MAPS ? position.index : 0u);
}

// Height of the surface at the middle of the texel.
float height_at_texel(MapPosition position)
{
    const float depth = texelFetch(occlusion_depth, texel_of(position), 0).r;
    const bool known = position.index < VIRGA_RAIN_MAX_MAPS && depth < 1.0;
    return known ? tick.map_top_m - depth * tick.map_height_m : NOTHING_BELOW;
}

Cover find_cover(vec3 p, uint slant)
{
    const MapPosition position = map_position(p, slant);
    Cover found = Cover(height_at_texel(position), position.index, texel_of(position));
    const ivec3 surface_texel = tick.host_depth != 0u ? ivec3(0) : found.texel; // a host's depth map has no surfaces
    const vec3 normal = unpack_normal(texelFetch(occlusion_surface, surface_texel, 0).r);
    const float offset = plane_offset(position.map, fract(position.texel) - 0.5, normal);
    found.height += tick.host_depth != 0u || found.height == NOTHING_BELOW ? 0.0 : offset;
    return found;
}
