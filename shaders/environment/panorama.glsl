// panorama.glsl - a panorama of the surroundings, each texel the mean of four directions. The includer defines
// around().
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D panorama;

vec3 around(vec3 d, float spread); // `spread`: angle of a quarter of a texel (rad)

void main()
{
    const ivec2 size = imageSize(panorama), at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= size.x || at.y >= size.y)
        return;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; i++) {
        const vec2 where = (vec2(at) + 0.25 + 0.5 * vec2(i & 1, i >> 1)) / vec2(size);
        const float azimuth = (where.x - 0.5) * 2.0 * PI, polar = where.y * PI;
        sum += around(vec3(sin(polar) * sin(azimuth), cos(polar), -sin(polar) * cos(azimuth)), PI / float(size.x));
    }
    imageStore(panorama, at, vec4(min(0.25 * sum, vec3(60000.0)), 1.0));
}
