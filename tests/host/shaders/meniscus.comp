// meniscus.comp - what meniscus.glsl of the program comes to, for a test. For each case: a view, a slope, a height on
// the wall and the side of a pixel; the height and width of the slope, the slope of the height, what the pixel sees.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "meniscus.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Cases { float values[]; };

void main()
{
    const uint at = gl_GlobalInvocationID.x * 12u;
    if (at + 12u > uint(values.length()))
        return;
    const MeniscusView view = MeniscusView(values[at], values[at + 1u], values[at + 2u]);
    const vec3 seen = meniscus_seen(view, values[at + 4u], values[at + 5u]);
    values[at + 6u] = meniscus_height(view, values[at + 3u]);
    values[at + 7u] = meniscus_width(view, values[at + 3u]);
    values[at + 8u] = meniscus_slope(view, values[at + 6u]);
    values[at + 9u] = seen.x;
    values[at + 10u] = seen.y;
    values[at + 11u] = seen.z;
}
