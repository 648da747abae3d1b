// vectors.glsl - arrays of the shared headers as vectors, and vectors as words.
vec3 to_vec(float a[3]) { return vec3(a[0], a[1], a[2]); }

mat4 to_mat(float a[16])
{
    return mat4(a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9], a[10], a[11], a[12], a[13], a[14], a[15]);
}

// A pair of half floats, the first in the low bits; what is beyond their range becomes their end.
uint halves(float a, float b) { return packHalf2x16(clamp(vec2(a, b), vec2(-65000.0), vec2(65000.0))); }

// Where all corners go of what is not drawn. Beyond the picture they would have to be clipped, and software Vulkan
// takes a thousand triangles the long way for one of those.
#define DRAWN_NOWHERE vec4(0.0, 0.0, 0.0, 1.0)
