#version 460
// id.frag - which opaque surface it is, beside its depth.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

layout(push_constant) uniform Surface { host_surface_gpu surface; };

layout(location = 4) out uint out_id;

void main() { out_id = uint(surface.traits.z); }
