#version 460
// show.frag - the finished picture for the display: a stop brighter, highlights rolled off. sRGB is the target's
// format.

layout(set = 0, binding = 0) uniform sampler2D picture;

layout(location = 0) out vec4 out_color;

void main()
{
    vec3 light = 2.0 * texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb;
    vec3 over = max(light - 0.6, 0.0); // identity up to 0.6, then a shoulder of the same slope that ends at 1
    out_color = vec4(min(light, 0.6) + 0.4 * over / (0.4 + over), 1.0);
}
