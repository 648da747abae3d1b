// contact_maps.glsl - what the passes of contact shade read.
#ifndef CONTACT_MAPS_GLSL
#define CONTACT_MAPS_GLSL

layout(set = 0, binding = 0) uniform sampler2D ground_map;
layout(set = 0, binding = 1) uniform sampler2D under_map;
layout(set = 0, binding = 2) uniform sampler2D over_map;
layout(set = 0, binding = 3) uniform sampler2D moving_under_map;
layout(set = 0, binding = 4) uniform sampler2D moving_over_map;
layout(push_constant) uniform Push { host_contact_gpu push; };

const int CONTACT_TILE = 8;          // texels along a workgroup of contact.comp
const float CONTACT_REACH_M = 1.4;   // of its last look

// Heights above the map's bottom.
float under_at(ivec2 at)
{
    return min(texelFetch(under_map, at, 0).r, texelFetch(moving_under_map, at, 0).r) * push.height_m;
}

float over_at(ivec2 at)
{
    return (1.0 - min(texelFetch(over_map, at, 0).r, texelFetch(moving_over_map, at, 0).r)) * push.height_m;
}

#endif
