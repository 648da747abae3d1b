// field.glsl - what every pass over the field of drops shares: buffers, boxes, weights, occlusion.
#define VIRGA_GLSL
#include "shared/rain_gpu.h"
#include "shared/random.h"
#include "shared/drop.h"
#include "shared/impact.h"

layout(scalar, set = 0, binding = 0) readonly buffer Tick
{
    virga_travel_gpu travels_as_stored[VIRGA_RAIN_CLASSES]; // read as uniforms, see step.comp
    virga_tick_gpu tick;
    virga_map_gpu maps[VIRGA_RAIN_MAX_MAPS];
    virga_class_gpu classes[VIRGA_RAIN_CLASSES];
    virga_weight_gpu weights[]; // of class k in box l at l * VIRGA_RAIN_CLASSES + k
};
layout(scalar, set = 0, binding = 2) readonly buffer Slots { virga_slot_gpu slots[]; };
layout(set = 0, binding = 9) uniform sampler2DArray occlusion_depth;
layout(set = 0, binding = 10) uniform usampler2DArray occlusion_surface;

#define RANK_SOFTNESS 0.05 // share of ranks that fade where the rate changes; the C side inverts it
#define FADE_FROM 0.75     // of a box's half side, where it begins to hand over to the next

vec3 to_vec(float a[3]) { return vec3(a[0], a[1], a[2]); }

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

// Drops that a slot stands for, at a place relative to the origin; 0: the slot is not in use here and now.
float drop_weight(vec3 p, uint level, uint size_class, uint rank)
{
    const virga_weight_gpu weight = weights[level * VIRGA_RAIN_CLASSES + size_class];
    const float presence = clamp((weight.threshold - float(rank) * (1.0 / 65536.0)) / RANK_SOFTNESS, 0.0, 1.0);
    return presence > 0.0 ? presence * weight.drops * level_share(box_radius(p), level) : 0.0;
}

// Where the line of fall through a place first meets something.
struct Shelter {
    float height;   // of that point, relative to the origin; far below where nothing is known
    uint map;       // VIRGA_RAIN_MAX_MAPS: none
    ivec3 texel;
};

// Height on the plane of the texel's surface, not only at its middle, so that slopes are not stairs. With the map's
// coordinate X = x + s (y - y0), a plane n.p = c has dy/dX = -n.x / (n.y - n.x s.x - n.z s.z).
float plane_offset(virga_map_gpu map, vec2 from_middle, vec3 normal)
{
    const float across = normal.y - normal.x * map.slant[0] - normal.z * map.slant[1];
    if (abs(across) < 0.05)
        return 0.0;
    const float texel_m = 2.0 / (map.inv_half_m * map.texels);
    const float offset = -dot(normal.xz, from_middle) * texel_m / across;
    return clamp(offset, -4.0 * texel_m, 4.0 * texel_m);
}

vec3 unpack_normal(uint surface)
{
    // Octahedral, 12 bits an axis above 8 bits of material (Cigolle et al. 2014).
    const vec2 e = vec2((surface >> 8) & 4095u, surface >> 20) * (2.0 / 4095.0) - 1.0;
    vec3 n = vec3(e.x, 1.0 - abs(e.x) - abs(e.y), e.y);
    if (n.y < 0.0)
        n.xz = (1.0 - abs(n.zx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.z >= 0.0 ? 1.0 : -1.0);
    return normalize(n);
}

Shelter find_shelter(vec3 p, uint slant)
{
    Shelter found = Shelter(-1e9, VIRGA_RAIN_MAX_MAPS, ivec3(0));
    for (uint cascade = 0u; cascade < tick.cascades && tick.maps > 0u; cascade++) {
        const uint index = cascade * tick.slants + slant;
        const virga_map_gpu map = maps[index];
        const vec2 sheared = p.xz + vec2(map.slant[0], map.slant[1]) * p.y - vec2(map.centre[0], map.centre[1]);
        const vec2 texel = (sheared * map.inv_half_m * 0.5 + 0.5) * map.texels;
        if (any(lessThan(texel, vec2(1.0))) || any(greaterThanEqual(texel, vec2(map.texels - 1.0))))
            continue;
        found.texel = ivec3(texel, index);
        found.map = index;
        const float depth = texelFetch(occlusion_depth, found.texel, 0).r;
        if (depth < 1.0) {
            found.height = map.top_m - depth * map.height_m;
            if (tick.host_depth == 0u) {
                const vec3 normal = unpack_normal(texelFetch(occlusion_surface, found.texel, 0).r);
                found.height += plane_offset(map, fract(texel) - 0.5, normal);
            }
        }
        break;
    }
    return found;
}
