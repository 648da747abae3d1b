// view_points.frag - a disk.
#version 460
layout(location = 0) in vec2 in_at;
layout(location = 1) flat in vec3 in_color;
layout(location = 0) out vec4 out_color;

void main()
{
    const float r = dot(in_at, in_at);
    if (r > 1.0)
        discard;
    out_color = vec4(in_color * (r > 0.6 ? 0.75 : 1.0), 1.0);
}
