// chance.glsl - random numbers in a range.

// The normal distribution, cut at two deviations, from a uniform number: z in [-2; 2]. The inverse error function is
// from M. Giles, "Approximating the erfinv function", 2010, the branch for |x| < 0.9963.
float normal_cut(float uniform_number)
{
    const float x = (2.0 * uniform_number - 1.0) * 0.9544997; // erf(2 / sqrt 2)
    const float w = -log((1.0 - x) * (1.0 + x)) - 2.5;
    float p = 2.81022636e-08;
    p = 3.43273939e-07 + p * w;
    p = -3.5233877e-06 + p * w;
    p = -4.39150654e-06 + p * w;
    p = 0.00021858087 + p * w;
    p = -0.00125372503 + p * w;
    p = -0.00417768164 + p * w;
    p = 0.246640727 + p * w;
    p = 1.50140941 + p * w;
    return clamp(1.41421356 * p * x, -2.0, 2.0);
}

// Normally distributed; the ends of the range are two deviations from the mean.
float normal_between(float low, float high, uint hash)
{
    return clamp(0.5 * (low + high) + 0.25 * (high - low) * normal_cut(virga_unit(hash)), low, high);
}

uint whole_between(float low, float high, uint hash)
{
    return uint(low + floor(virga_unit(hash) * (high - low + 1.0)));
}
