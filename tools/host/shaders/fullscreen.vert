#version 460
// fullscreen.vert - one triangle over the whole picture, at the far end.

void main()
{
    const int corner = gl_VertexIndex;
    gl_Position = vec4(corner == 1 ? 3.0 : -1.0, corner == 2 ? 3.0 : -1.0, 1.0, 1.0);
}
