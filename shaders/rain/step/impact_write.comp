// impact_write.comp - writes the impacts of the selected entries.
// One invocation per entry of the first list. Reads: selection, drops, occlusion maps. Writes: impacts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_buffers.glsl"
#include "impact.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
layout(scalar, set = 0, binding = 4) buffer Impacts
{
    virga_impacts_gpu head;
    virga_impact_gpu impacts[];
};

// Water of the drops (nl), rounded at random so that sums are right on average.
uint water_of(float diameter_m, float weight, uint id)
{
    const float mm = diameter_m * 1e3;
    const float nl = 523.598776 * mm * mm * mm * weight; // pi / 6 in nl for a drop of 1 mm
    return uint(min(floor(nl + virga_unit(virga_hash3(tick.seed, id, tick.tick))), 4294967040.0));
}

// Normal from a host's depth map, which has no normals: from the smaller of the differences to the neighbours.
vec3 depth_normal(Cover surface)
{
    const virga_map_gpu map = maps[min(surface.map, VIRGA_RAIN_MAX_MAPS - 1u)];
    const float here = texelFetch(occlusion_depth, surface.texel, 0).r;
    const vec2 s = vec2(map.slant[0], map.slant[1]) / map.texels_per_m;
    vec2 slope;
    for (int axis = 0; axis < 2; axis++) {
        const ivec3 to = axis == 0 ? ivec3(1, 0, 0) : ivec3(0, 1, 0);
        const float ahead = here - texelFetch(occlusion_depth, surface.texel + to, 0).r;
        const float behind = texelFetch(occlusion_depth, surface.texel - to, 0).r - here;
        slope[axis] = (abs(ahead) < abs(behind) ? ahead : behind) * tick.map_height_m * map.texels_per_m;
    }
    // dy/dX in sheared coordinates back to a plane: n.x = -a, n.z = -b, n.y = 1 - a s.x - b s.y.
    return normalize(vec3(-slope.x, 1.0 - dot(slope, s), -slope.y));
}

void add_water(uint water)
{
    const uint old = atomicAdd(head.water_nl_low, water);
    if (old + water < old)
        atomicAdd(head.water_nl_high, 1u);
}

void main()
{
    const uint entry = gl_GlobalInvocationID.x, bit = 1u << (entry & 31u);
    const uvec4 word = selection[entry >> 5];
    if ((word.x & bit) == 0u)
        return;
    Hit hit = test_drop(listed[entry]);
    hit.weight = max(hit.weight, 1e-6); // it is above 0, or it would not be selected
    const uint index = list.first + word.z + bitCount(word.x & (bit - 1u));
    const float diameter = classes[hit.size_class].diameter_m;
    const uint water = water_of(diameter, hit.weight, hit.id);
    add_water(water);
    if (index >= tick.max_impacts)
        return;
    const uint surface =
        tick.host_depth != 0u ? tick.default_material : texelFetch(occlusion_surface, hit.surface.texel, 0).r;
    vec3 normal = tick.host_depth != 0u ? depth_normal(hit.surface) : unpack_normal(surface);
    normal = dot(normal, hit.velocity) > 0.0 ? -normal : normal;
    virga_impact_gpu impact;
    impact.position = float[3](hit.position.x, hit.position.y, hit.position.z);
    impact.time_s = (float(tick.tick_in_step) + hit.share) * tick.tick_s;
    impact.velocity = float[3](hit.velocity.x, hit.velocity.y, hit.velocity.z);
    impact.diameter_m = diameter;
    impact.normal = float[3](normal.x, normal.y, normal.z);
    impact.weight = hit.weight;
    impact.id = hit.id;
    impact.material = surface & 255u;
    impact.water_nl = water;
    impact.tick = tick.tick;
    impacts[index] = impact;
}
