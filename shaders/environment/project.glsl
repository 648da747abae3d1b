// project.glsl - sums of light times spherical harmonics over the texels of an image, each with its solid angle. The
// includer defines texel_count() and sample_at().
layout(local_size_x = VIRGA_ENVIRONMENT_GROUP) in;
layout(scalar, set = 0, binding = 1) writeonly buffer Sums { virga_environment_sum_gpu sums[]; };

shared float parts[VIRGA_ENVIRONMENT_GROUP][28];

struct Sample {
    vec3 d, light; // towards the texel, in the world
    float solid;   // sr
};

uint texel_count();
Sample sample_at(uint texel);

void main()
{
    const uint each = info.groups * VIRGA_ENVIRONMENT_GROUP, own = gl_LocalInvocationIndex;
    float sum[28], y[9];
    for (uint k = 0u; k < 28u; k++)
        sum[k] = 0.0;
    for (uint texel = gl_WorkGroupID.x * VIRGA_ENVIRONMENT_GROUP + own; texel < texel_count(); texel += each) {
        const Sample s = sample_at(texel);
        harmonics(s.d, y);
        for (uint k = 0u; k < 27u; k++)
            sum[k] += s.light[k % 3u] * y[k / 3u] * s.solid;
        sum[27] += s.solid;
    }
    parts[own] = sum;
    for (uint half_count = VIRGA_ENVIRONMENT_GROUP / 2; half_count > 0u; half_count /= 2u) {
        barrier();
        if (own < half_count)
            for (uint k = 0u; k < 28u; k++)
                parts[own][k] += parts[own + half_count][k];
    }
    if (own > 0u)
        return;
    for (uint k = 0u; k < 27u; k++)
        sums[gl_WorkGroupID.x].sh[k] = parts[0][k];
    sums[gl_WorkGroupID.x].weight = parts[0][27];
}
