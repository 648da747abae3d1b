// outline.glsl - the outline of a drop on a pane that ran or merged: an ellipse, and a tail. Both change back by
// themselves, and only what changes them writes them, with the tick. So a drop at rest costs a tick nothing.
//
// An ellipse is its strain s (cos 2p, sin 2p): the logarithm of length over width, and twice the angle p of its length
// from u towards v. With the base's area and the height of a round cap it holds the water of one. A paraboloid on an
// ellipse solves Laplace's equation of a flat drop as the one on a disc does: its curvature is even.
//
// A tail is a vector from the drop's head to where it lies, with the length 1 for one that is fully drawn out.
#define MAX_STRAIN 1.2 // length over width of 3.3

// A contact line moves at a speed that goes with its angle, whatever the drop's size (Cox 1986; Voinov 1976), slowed
// down by the glass: drops that merge need some 0.1 s to become round, a million times what the water's viscosity
// alone would let them have (Andrieu et al. 2002; from memory, and the speed is an estimate).
#define LINE_M_S 0.02

// What is left of the strain of a drop at rest on glass that holds rims as firmly as any: length over width of 1.2. An
// estimate. Half of the drops on photographs exceed 1.8, neighbours that touch included; uneven glass and gravity make
// ours longer too.
#define HELD_STRAIN 0.2

vec2 unpack_strain(uint packed) { return MAX_STRAIN * unpackSnorm2x16(packed); }
uint pack_strain(vec2 strain) { return packSnorm2x16(strain * (1.0 / max(MAX_STRAIN, length(strain)))); }
vec2 unpack_tail(uint packed) { return unpackSnorm2x16(packed); }
uint pack_tail(vec2 tail) { return packSnorm2x16(tail / max(1.0, length(tail))); }

// The part of a change that is left after some time, for a drop with a base of radius a. In the end none: a drop that
// has long stood still is drawn as it was before, to the bit, see tiles.glsl.
float outline_left(float age_s, float a)
{
    const float left = exp(-age_s * LINE_M_S / max(a, 1e-6));
    return left < 5e-5 ? 0.0 : left;
}

// A strain, `left` of whose excess over what the glass holds is left.
vec2 strain_left(vec2 strain, float left)
{
    const float size = length(strain);
    return size <= HELD_STRAIN ? strain : strain * mix(HELD_STRAIN / size, 1.0, left);
}

// The strain in the direction of a vector, whose length does not matter.
vec2 strain_along(vec2 way, float size)
{
    return vec2(way.x * way.x - way.y * way.y, 2.0 * way.x * way.y) * (size / max(dot(way, way), 1e-20));
}
