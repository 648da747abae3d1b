// kernel.glsl - the kernel and what walls add to it.
//
// The cubic spline (Monaghan 1992, Smoothed Particle Hydrodynamics, section 2) with the spacing d as smoothing length,
// and so a radius of 2 d. Times the volume d^3 of a particle, with q = r / d:
//
//     V W(q) = ((2 - q)^3 - 4 (1 - q)^3) / (4 pi),        both powers 0 for negative bases.
//
// Summed over a cubic lattice of spacing d this is 0.9996: particles at rest have the density 1.
#define KERNEL_FACTOR 0.0795774715 // 1 / (4 pi)
#define KERNEL_SELF   0.3183098862 // V W(0) = 1 / pi

float kernel(float q)
{
    const float a = max(2.0 - q, 0.0), b = max(1.0 - q, 0.0);
    return KERNEL_FACTOR * (a * a * a - 4.0 * (b * b * b));
}

// 4 pi V W'(q) / q: times x / d it is the gradient, in 1 / d. Without the factor, which is the same for a whole sum.
// 0 at distance 0.
float slope(float r2)
{
    const float inverse = inversesqrt(max(r2, 1e-12)), q = r2 * inverse;
    const float a = max(2.0 - q, 0.0), b = max(1.0 - q, 0.0);
    return (12.0 * (b * b) - 3.0 * (a * a)) * inverse;
}

// 4 pi V W and slope() of a pair, which share most of their terms.
vec2 kernel_and_slope(float r2)
{
    const float inverse = inversesqrt(max(r2, 1e-12)), q = r2 * inverse;
    const float a = max(2.0 - q, 0.0), b = max(1.0 - q, 0.0);
    return vec2(a * a * a - 4.0 * (b * b * b), (12.0 * (b * b) - 3.0 * (a * a)) * inverse);
}

// Walls. Behind a flat wall we think layers of water at rest, at the distances d/2, 3d/2, ... from its face, each
// spread evenly over its plane. The kernel's integral over a plane at the distance s (in d) is, with
// int_s^a (a - r)^3 r dr = a (a - s)^4 / 4 - (a - s)^5 / 5,
//
//     P(s) = 2 pi int_s^2 W(r) r dr = ((2 - s)^4 / 2 - (2 - s)^5 / 5 - (1 - s)^4 + 4 (1 - s)^5 / 5) / 2.
//
// A particle at z has P(z + 1/2) + P(z + 3/2) of its density from the wall. The integral over the half space behind the
// wall is not used: the particles are in layers themselves, and at z = 1/2, where the first layer rests, it gives 0.188
// where a lattice has 0.150, which P(1) gives.
float plane(float s)
{
    const float a = max(2.0 - s, 0.0), b = max(1.0 - s, 0.0), a2 = a * a, b2 = b * b;
    return 0.5 * (a2 * a2 * (0.5 - 0.2 * a) - b2 * b2 * (1.0 - 0.8 * b));
}

// P'(s) = -2 pi s W(s)
float plane_slope(float s) { return -6.2831853072 * s * kernel(s); }

// Of the two walls of an axis at these distances (in d, not negative): their part of the density, its change with the
// velocity along the axis, and their part of the sum of |x_ij . grad W|, for the pressure.
//
// The water behind the wall does not stand still: it is the mirror image of the water before it, and comes to meet it.
// So the change is twice P'. The same factor stands in the force, where it says that the pressure behind the wall is
// that before it (Koschier et al. 2019, equation 84). One operator is then the transpose of the other, and walls add no
// energy.
//
// The sum over a plane is 2 pi int_s^2 r^2 |W'(r)| dr = 2 pi s^2 W(s) + 2 P(s).
float plane_density(float z) { return plane(max(z, 0.0) + 0.5) + plane(max(z, 0.0) + 1.5); }

vec3 wall(float z)
{
    const float near = z + 0.5, far = z + 1.5, planes = plane(near) + plane(far);
    const float near_slope = plane_slope(near), far_slope = plane_slope(far);
    return vec3(planes, 2.0 * (near_slope + far_slope), 2.0 * planes - near * near_slope - far * far_slope);
}

vec3 axis_walls(float low, float high)
{
    const vec3 l = wall(low), h = wall(high);
    return vec3(l.x + h.x, l.y - h.y, l.z + h.z);
}

// What a wall carries of a particle's weight. In water at rest the pressure behind a wall is not the same as before it:
// it changes by g s from a particle to a layer at the distance s. If it were the same, water would press on its floor
// as if it stood half a spacing higher, and a body would float too high by as much. So we let the pressure go on behind
// the wall with its gradient (Band et al. 2018, MLS Pressure Boundaries for Divergence-Free and Viscous SPH Fluids). An
// integral over a plane is s |P'(s)| for the direction across it, and P(s) for each direction in it. This adds
//
//     across the wall: -grad p sum_s s |P'(s)|,        along it: -grad p sum_s P(s).
//
// The first sum is 1/2 at z = 1/2. Nothing moves through a wall at rest: the gradient across it is that of gravity.
float carried_across(float z) { return -(z + 0.5) * plane_slope(z + 0.5) - (z + 1.5) * plane_slope(z + 1.5); }

// For each axis, of the walls of the box: the share that they carry of gravity, and of the pressure's gradient along
// them. In edges they carry the same water once.
struct BoxCarries {
    vec3 across, along;
};

BoxCarries box_carries(vec3 p, vec3 low, vec3 high)
{
    vec3 across, left;
    for (uint axis = 0u; axis < 3u; axis++) {
        const float from_low = max(p[axis] - low[axis], 0.0), from_high = max(high[axis] - p[axis], 0.0);
        across[axis] = min(carried_across(from_low) + carried_across(from_high), 1.0);
        left[axis] = 1.0 - min(plane_density(from_low) + plane_density(from_high), 1.0);
    }
    const vec3 others = left.yzx * left.zxy;
    return BoxCarries(across * others, 1.0 - others);
}

struct BoxWalls {
    float density;
    vec3 gradient; // 1/d
    float pull;    // sum of |x_ij . grad W|
};

// In edges and corners parts of the layers of two walls are the same water: 1 minus the product of what each axis
// leaves over counts it once.
BoxWalls box_walls(vec3 p, vec3 low, vec3 high)
{
    const vec3 from_low = max(p - low, 0.0), from_high = max(high - p, 0.0);
    const vec3 x = axis_walls(from_low.x, from_high.x), y = axis_walls(from_low.y, from_high.y),
               z = axis_walls(from_low.z, from_high.z);
    const vec3 left = 1.0 - vec3(x.x, y.x, z.x), others = left.yzx * left.zxy;
    return BoxWalls(1.0 - left.x * left.y * left.z, vec3(x.y, y.y, z.y) * others, dot(vec3(x.z, y.z, z.z), others));
}
