#version 460
// mirror_level.vert - one triangle over a whole level.

layout(location = 0) out vec2 out_uv;

void main()
{
    out_uv = vec2(gl_VertexIndex == 1 ? 2.0 : 0.0, gl_VertexIndex == 2 ? 2.0 : 0.0);
    gl_Position = vec4(out_uv * 2.0 - 1.0, 0.0, 1.0);
}
