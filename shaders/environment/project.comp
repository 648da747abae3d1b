// project.comp - the harmonics of a panorama or a picture: sums of parts of its texels. Of a picture, how much its
// light differs from what is taken for the rest of the surroundings. One invocation per texel, and more of them on
// large images. Reads: the image. Writes: sums.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "environment.glsl"
#include "project.glsl"

uint texel_count() { return info.width * info.height; }

Sample panorama_at(uvec2 at)
{
    const vec2 size = vec2(info.width, info.height);
    const float azimuth = ((float(at.x) + 0.5) / size.x - 0.5) * 2.0 * PI, polar = (float(at.y) + 0.5) / size.y * PI;
    const vec3 d = vec3(sin(polar) * sin(azimuth), cos(polar), -sin(polar) * cos(azimuth));
    // Of a row: the difference of the cosines at its borders.
    const float solid = 2.0 * PI / size.x * 2.0 * sin(polar) * sin(0.5 * PI / size.y);
    return Sample(world_from_image() * d, light_of(texelFetch(image, ivec2(at), 0).rgb), solid);
}

// A pixel's area on the plane one metre ahead, seen at an angle.
Sample picture_at(uvec2 at)
{
    const vec2 size = vec2(info.width, info.height), ndc = (vec2(at) + 0.5) / size * 2.0 - 1.0;
    const vec3 right = to_vec(info.right), up = to_vec(info.up);
    const vec3 ray = right * ndc.x + up * ndc.y + to_vec(info.ahead), d = normalize(ray);
    const float area = length(cross(right, up)) * 4.0 / (size.x * size.y), far = length(ray);
    const vec3 light = light_of(texelFetch(image, ivec2(at) + ivec2(info.left, info.top), 0).rgb);
    return Sample(d, light - rest(d), area / (far * far * far));
}

Sample sample_at(uint texel)
{
    const uvec2 at = uvec2(texel % info.width, texel / info.width);
    if (info.kind == KIND_PICTURE)
        return picture_at(at);
    return panorama_at(at);
}
