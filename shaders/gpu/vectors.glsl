// vectors.glsl - arrays of the shared headers as vectors; two half floats in a word.
vec3 to_vec(float a[3]) { return vec3(a[0], a[1], a[2]); }

mat4 to_mat(float a[16])
{
    return mat4(a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9], a[10], a[11], a[12], a[13], a[14], a[15]);
}

// Two half floats, the first in the low bits. Values are clamped to the range of half floats.
uint halves(float a, float b) { return packHalf2x16(clamp(vec2(a, b), vec2(-65000.0), vec2(65000.0))); }

// All vertices of something that is not drawn go here: a triangle without area. Vertices outside the picture would be
// clipped instead, and for one of those software Vulkan takes its slow path for a thousand triangles.
#define DRAWN_NOWHERE vec4(0.0, 0.0, 0.0, 1.0)
