// pattern.glsl - points in the unit ball: directions on a spiral with the golden angle, at radii that fill the ball
// evenly (the cube root of the van der Corput sequence).
vec3 pattern_point(uint id, uint i, uint count)
{
    const float angle = 2.39996323 * float(i) + 6.28318531 * virga_unit(virga_hash1(id));
    const float z = 1.0 - (2.0 * float(i) + 1.0) / float(count);
    const float radius = pow(float(bitfieldReverse(i + 1u) >> 8u) * (1.0 / 16777216.0), 1.0 / 3.0);
    return radius * vec3(sqrt(max(1.0 - z * z, 0.0)) * vec2(cos(angle), sin(angle)), z);
}
