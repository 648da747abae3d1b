// surface.glsl - unpacks a texel of a mesh map's surface image: material in the low 8 bits, normal above.
uint surface_material(uint surface) { return surface & 255u; }

vec3 unpack_normal(uint surface)
{
    // Octahedral encoding, 12 bits per axis, above the 8 bits of material (Cigolle et al. 2014).
    const vec2 e = vec2((surface >> 8) & 4095u, surface >> 20) * (2.0 / 4095.0) - 1.0;
    vec3 n = vec3(e.x, 1.0 - abs(e.x) - abs(e.y), e.y);
    if (n.y < 0.0)
        n.xz = (1.0 - abs(n.zx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.z >= 0.0 ? 1.0 : -1.0);
    return normalize(n);
}
