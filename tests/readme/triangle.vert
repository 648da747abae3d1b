#version 450
layout(push_constant) uniform Camera { mat4 clip_from_world; };
layout(location = 0) out vec3 colour;
const vec3 places[3] = vec3[](vec3(-1.2, 0.4, -4.0), vec3(1.2, 0.4, -4.0), vec3(0.0, 2.4, -4.0));
const vec3 colours[3] = vec3[](vec3(0.8, 0.1, 0.1), vec3(0.1, 0.6, 0.1), vec3(0.1, 0.2, 0.8));
void main()
{
    colour = colours[gl_VertexIndex];
    gl_Position = clip_from_world * vec4(places[gl_VertexIndex], 1.0);
}
