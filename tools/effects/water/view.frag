// view.frag - the picture in dark grey, behind the points of a view of water.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "view_gpu.h"
#define VIEW_OWN water_view_gpu
#include "../views/view_common.glsl"

layout(location = 0) out vec4 out_color;

void main()
{
    vec2 at;
    ivec2 texel;
    vec3 color = OUTSIDE;
    if (in_picture(gl_FragCoord.xy, at, texel))
        color = vec3(0.3 * dot(exposed(textureLod(color_map, at, 0.0).rgb), vec3(0.3, 0.6, 0.1)));
    out_color = vec4(color, 1.0);
}
