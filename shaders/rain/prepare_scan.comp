// prepare_scan.comp - gives the marked slots their places among the streaks, and writes the draw's arguments.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "field.glsl"
#include "view.glsl"
#include "scan.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
layout(scalar, set = 0, binding = 6) writeonly buffer Prepared { virga_prepared_gpu prepared; };

void main()
{
    const uint found = scan_picks(tick.groups, 0u);
    if (gl_LocalInvocationIndex != 0u)
        return;
    const uint count = min(found, view.max_streaks);
    prepared = virga_prepared_gpu(6u * count, 1u, 0u, 0, 0u, count, found - count, 0u);
}
