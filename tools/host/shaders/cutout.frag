#version 460
// cutout.frag - depth of cut-out surfaces: what is below the alpha cutoff is not there. With ID also which it is.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

layout(set = 1, binding = 0) uniform sampler2D base_texture;
layout(push_constant) uniform Surface { host_surface_gpu surface; };

layout(location = 2) in vec2 in_uv;
#ifdef ID
layout(location = 4) out uint out_id;
#endif

void main()
{
    if (texture(base_texture, in_uv).a * surface.base_color.a < surface.traits.y)
        discard;
#ifdef ID
    out_id = uint(surface.traits.z);
#endif
}
