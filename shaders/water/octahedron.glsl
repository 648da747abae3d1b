// octahedron.glsl - a unit vector in 32 bits: octahedral coordinates as two signed 16-bit integers (Cigolle et al.
// 2014).
vec2 signs(vec2 v) { return vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0); }

uint pack_octahedron(vec3 n)
{
    const vec3 p = n / max(abs(n.x) + abs(n.y) + abs(n.z), 1e-20);
    return packSnorm2x16(p.z >= 0.0 ? p.xy : (1.0 - abs(p.yx)) * signs(p.xy));
}

vec3 unpack_octahedron(uint packed)
{
    const vec2 e = unpackSnorm2x16(packed);
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    if (n.z < 0.0)
        n.xy = (1.0 - abs(n.yx)) * signs(n.xy);
    return normalize(n);
}
