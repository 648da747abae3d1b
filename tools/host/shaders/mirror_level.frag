#version 460
// mirror_level.frag - a level of the mirror's picture from the one before. Four looks between texels weigh four by four
// of them 1 3 3 1: the mean of two by two alone would show its squares where a level is magnified.

layout(set = 0, binding = 0) uniform sampler2D finer;
layout(location = 0) in vec2 in_uv;
layout(location = 0) out vec4 out_color;

void main()
{
    const vec2 off = 0.75 / vec2(textureSize(finer, 0));
    out_color = 0.25 * (textureLod(finer, in_uv - off, 0.0) + textureLod(finer, in_uv + off, 0.0) +
                        textureLod(finer, in_uv + vec2(off.x, -off.y), 0.0) +
                        textureLod(finer, in_uv + vec2(-off.x, off.y), 0.0));
}
