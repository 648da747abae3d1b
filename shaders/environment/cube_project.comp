// cube_project.comp - the harmonics of a cube map: sums of parts of its texels.
// One invocation per texel, and more of them on large images. Reads: the cube map. Writes: sums.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define CUBE
#include "environment.glsl"
#include "project.glsl"

uint texel_count() { return 6u * info.width * info.width; }

// The direction of a texel's middle, as the table of faces in Vulkan's chapter "Cube Map Face Selection" has it.
vec3 on_face(uint face, vec2 st)
{
    switch (face) {
    case 0u: return vec3(1.0, -st.y, -st.x);
    case 1u: return vec3(-1.0, -st.y, st.x);
    case 2u: return vec3(st.x, 1.0, st.y);
    case 3u: return vec3(st.x, -1.0, -st.y);
    case 4u: return vec3(st.x, -st.y, 1.0);
    default: return vec3(-st.x, -st.y, -1.0);
    }
}

Sample sample_at(uint texel)
{
    const uint on = texel % (info.width * info.width);
    const vec2 st = (vec2(on % info.width, on / info.width) + 0.5) / float(info.width) * 2.0 - 1.0;
    const vec3 towards = on_face(texel / (info.width * info.width), st);
    const float far = length(towards), side = 2.0 / float(info.width);
    return Sample(world_from_image() * (towards / far), light_of(textureLod(image, towards, 0.0).rgb),
                  side * side / (far * far * far));
}
