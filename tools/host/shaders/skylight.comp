#version 460
// skylight.comp - gathers, for each voxel, which directions see the sky: their share and their mean direction.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

layout(local_size_x = 8, local_size_y = 2, local_size_z = 4) in;

layout(set = 0, binding = 0, std140) uniform Skylight { host_skylight_gpu sky; };
layout(set = 0, binding = 1) uniform sampler2DArray maps;
layout(set = 0, binding = 2, rgba16f) uniform writeonly image3D volume;

// As a sampler reads: the nearest texel, clamped to the edge. A fetch is a fourth of the time on software Vulkan.
float nearest_of(vec2 map, int direction)
{
    const ivec2 size = textureSize(maps, 0).xy;
    const ivec2 at = clamp(ivec2(floor((map * 0.5 + 0.5) * vec2(size))), ivec2(0), size - 1);
    return texelFetch(maps, ivec3(at, direction), 0).r;
}

// Each invocation has some voxels above one another, as software Vulkan reads what is indexed by a variable for each of
// its lanes.
void main()
{
    const ivec3 first = ivec3(gl_GlobalInvocationID) * ivec3(1, HOST_SKYLIGHT_RUN, 1);
    vec4 sums[HOST_SKYLIGHT_RUN];
    for (int v = 0; v < HOST_SKYLIGHT_RUN; v++)
        sums[v] = vec4(0.0);
    for (int i = 0; i < HOST_SKYLIGHT_DIRECTIONS; i++) {
        const mat4 map_from_world = sky.map_from_world[i];
        const vec4 seen = vec4(sky.direction[i].xyz, 0.5);
        for (int v = 0; v < HOST_SKYLIGHT_RUN; v++) {
            const vec3 point = sky.low.xyz + (vec3(first + ivec3(0, v, 0)) + 0.5) * sky.voxel.xyz;
            const vec3 map = (map_from_world * vec4(point, 1.0)).xyz;
            sums[v] += nearest_of(map.xy, i) >= map.z - sky.low.w ? seen : vec4(0.0);
        }
    }
    for (int v = 0; v < HOST_SKYLIGHT_RUN; v++)
        imageStore(volume, first + ivec3(0, v, 0), sums[v] * (2.0 / float(HOST_SKYLIGHT_DIRECTIONS)));
}
