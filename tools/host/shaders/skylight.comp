#version 460
// skylight.comp - gathers, for each voxel, which directions see the sky: their share and their mean direction.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;

layout(set = 0, binding = 0, std140) uniform Skylight { host_skylight_gpu sky; };
layout(set = 0, binding = 1) uniform sampler2DArray maps;
layout(set = 0, binding = 2, rgba16f) uniform writeonly image3D volume;

void main()
{
    vec3 point = sky.low.xyz + (vec3(gl_GlobalInvocationID) + 0.5) * sky.voxel.xyz;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < HOST_SKYLIGHT_DIRECTIONS; i++) {
        vec3 map = (sky.map_from_world[i] * vec4(point, 1.0)).xyz;
        float nearest = textureLod(maps, vec3(map.xy * 0.5 + 0.5, float(i)), 0.0).r;
        sum += nearest >= map.z - sky.low.w ? vec4(sky.direction[i].xyz, 0.5) : vec4(0.0);
    }
    imageStore(volume, ivec3(gl_GlobalInvocationID), sum * (2.0 / float(HOST_SKYLIGHT_DIRECTIONS)));
}
