#version 450
layout(location = 0) out vec3 colour;
const vec2 corners[3] = vec2[](vec2(0.0, -0.6), vec2(0.6, 0.6), vec2(-0.6, 0.6));
const vec3 colours[3] = vec3[](vec3(0.8, 0.1, 0.1), vec3(0.1, 0.6, 0.1), vec3(0.1, 0.2, 0.8));
void main()
{
    colour = colours[gl_VertexIndex];
    gl_Position = vec4(corners[gl_VertexIndex], 0.0, 1.0);
}
