// kernel_types.glsl - a kernel, as the passes read it that sum them up.
layout(constant_id = 0) const uint KERNEL = VIRGA_WATER_ISOTROPIC;

struct Kernel {
    vec4 center;  // w: the factor of its density
    vec3 squares; // its shape: elements xx, yy, zz of a matrix; the unit matrix is the ball of radius h
    vec3 products; // xy, xz, yz
    vec3 velocity;
    float cover; // see surface/cover.comp
};

// The shape times a vector.
vec3 shaped(Kernel kernel, vec3 v)
{
    if (KERNEL == VIRGA_WATER_ISOTROPIC)
        return v;
    return kernel.squares * v + kernel.products.xxy * v.yxx + kernel.products.yzz * v.zzy;
}
