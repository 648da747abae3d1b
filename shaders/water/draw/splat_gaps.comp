// splat_gaps.comp - how much of each pixel the nearest water leaves open. The depth pass hides what is behind a splat
// over the whole of it, but at a border of the surface, as at a crest, its weights fall to 0 within the splat.
// One invocation per pixel of the effect's images. Reads: sums. Writes: gaps.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#define SCALED false
#include "surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 28, r32f) uniform writeonly image2D gaps;

void main()
{
    const ivec2 here = ivec2(gl_GlobalInvocationID.xy);
    if (here.x >= int(look.width) || here.y >= int(look.height))
        return;
    const vec4 sums = texelFetch(sums_image, here, 0);
    float open = 1.0;
    if (sums.w > 1e-4) {
        const float depth = sums.z / sums.w;
        // With the widest border: what water.frag may not draw whole is open.
        open -= coverage_of(closed_weight(vec2(here) + 0.5, sums.w, depth), MAX_SLOPE, depth);
    }
    imageStore(gaps, here, vec4(open));
}
