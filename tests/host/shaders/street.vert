#version 450
// street.vert - the street's opaque surfaces, as three hosts draw them.
#extension GL_GOOGLE_include_directive : require
#include "street_block.glsl"

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec3 in_color;
layout(location = 0) out vec3 out_position;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec3 out_color;
layout(location = 3) out vec4 out_before;
layout(location = 4) out vec4 out_now;

void main()
{
    out_position = in_position;
    out_normal = in_normal;
    out_color = in_color;
    out_before = street.clip_before * vec4(in_position, 1.0);
    out_now = street.clip_now * vec4(in_position, 1.0);
    gl_Position = out_now;
}
