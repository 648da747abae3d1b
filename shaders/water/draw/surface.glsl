// surface.glsl - the water's surface at a pixel of the target, from the sums of splats.
layout(set = 0, binding = 14) uniform sampler2D sums_image;
layout(set = 0, binding = 15) uniform sampler2D motion_image;
layout(set = 0, binding = 16) uniform sampler2D thickness_image;

vec4 texel_of(sampler2D image, ivec2 texel, ivec2 size)
{
    return texelFetch(image, clamp(texel, ivec2(0), size - 1), 0);
}

// By hand: not every device filters such formats.
vec4 between_texels(sampler2D image, vec2 at, ivec2 size)
{
    const vec2 low = floor(at - 0.5), share = at - 0.5 - low;
    const ivec2 texel = ivec2(low);
    return mix(mix(texel_of(image, texel, size), texel_of(image, texel + ivec2(1, 0), size), share.x),
               mix(texel_of(image, texel + ivec2(0, 1), size), texel_of(image, texel + ivec2(1, 1), size), share.x),
               share.y);
}

// Position in the effect's images.
vec2 image_pixel(vec2 pixel) { return (pixel - vec2(view.viewport[0], view.viewport[1])) * look.scale; }

vec4 sums_at(vec2 at)
{
    return SCALED ? between_texels(sums_image, at, ivec2(look.width, look.height))
                  : texelFetch(sums_image, ivec2(at), 0);
}

// What is missing of the sum of weights of the surface, as a part of the water is not there: `moved` are the sums of
// splat_sum.frag. It is subtracted from the sum of the weights of specks, moved.z. The sum of their weights times
// depth, moved.w, tells the two apart, with specks at the surface's depth; those in front of it are taken for fewer.
float missing_of(vec4 sums, vec4 moved)
{
    return max(moved.w * sums.w / max(sums.z, 1e-12) - moved.z, 0.0);
}

// Radius of most surfels at a view depth, in pixels of the images.
float surfel_px(float depth) { return look.surfel_scale * look.surfel_m / (look.pixel_angle * depth); }

float thickness_at(vec2 at)
{
    return between_texels(thickness_image, at / float(VIRGA_WATER_VOLUME_PX),
                          ivec2(look.volume_columns, look.volume_rows)).r;
}

// A normal that is turned away from the eye is blurred or rounded; there the surface is seen edge-on.
vec3 seen_normal(vec3 normal, vec3 incident)
{
    const float against = dot(normal, incident);
    return against > -0.02 ? normalize(normal - incident * (against + 0.02)) : normal;
}

#define THIN_PX 1.5 // surfels of this radius and below blur the border by themselves
#define WIDE_PX 3.0
#define MIN_SLOPE 0.02
#define MAX_SLOPE 0.3 // a steeper change is noise of few surfels; at 0.4 it shows as holes

// How much of the pixel is covered. The sum of weights is about 1 inside the water, and falls to 0 at its border. For
// large surfels it falls over many pixels; where it is 1/2, the border is drawn as wide as a pixel. For small ones it
// falls within a pixel or two. Then the sum is the coverage, but for its noise: it may not let the scene through where
// it is a little below 1. Sheets that are much thinner than a pixel keep half of their coverage. `slope`: change of the
// sum from a pixel to the next.
float coverage_of(float weight, float slope, float depth)
{
    const float radius_px = surfel_px(depth);
    const float sharp = clamp(0.5 + (weight - 0.5) / clamp(slope, MIN_SLOPE, MAX_SLOPE), 0.0, 1.0);
    const float soft = max(clamp(0.5 + 4.0 * (weight - 0.5), 0.0, 1.0), 0.5 * min(weight, 1.0));
    return mix(soft, sharp, smoothstep(THIN_PX, WIDE_PX, radius_px));
}
