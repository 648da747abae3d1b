// kernels.glsl - the kernels that the surface is made of: for each sorted particle near it a center with the volume
// that counts, and a shape. Before kernel.comp, the shape holds the covariance of the neighbours, and `shifts` the mean
// of their offsets with the sum of their weights.
layout(constant_id = 0) const uint KERNEL = VIRGA_WATER_ISOTROPIC;

layout(std430, set = 0, binding = 9) buffer Shifts { vec4 shifts[]; };
layout(std430, set = 0, binding = 11) buffer Shapes { vec4 shapes[]; }; // xx, yy, zz, xy; xz, yz, 0, 0
layout(std430, set = 0, binding = 12) writeonly buffer Centers { vec4 centers[]; };
