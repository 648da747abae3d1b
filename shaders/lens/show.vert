// show.vert - one triangle over the viewport.
// One invocation per vertex.
#version 460

void main()
{
    gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, 0.0, 1.0);
}
