// show.frag - copies the picture into the target.
// One invocation per pixel. Reads: the view, the picture.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/lens_gpu.h"
#include "gpu/encode.glsl"

layout(scalar, set = 0, binding = 0) uniform View { virga_lens_gpu view; };
layout(set = 0, binding = 14) uniform sampler2D picture;
layout(location = 0) out vec4 color;

void main()
{
    color = for_target(texelFetch(picture, ivec2(gl_FragCoord.xy) - ivec2(view.left, view.top), 0));
}
