// gaps.glsl - the share of water behind the nearest one, see splat_gaps.comp.
layout(set = 0, binding = 29) uniform sampler2D gaps_image;

#define FILL 4.0 // the weight of water behind an open pixel: more than 1, so that little is left of what is in front

float fill_here() { return FILL * texelFetch(gaps_image, ivec2(gl_FragCoord.xy), 0).r; }
