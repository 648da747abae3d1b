// pyramid.glsl - sums of the water's thickness in a pyramid of texels. A level has texels twice as wide as the level
// before it. A particle is added to the level whose texels are about as wide as the particle, so each costs nine
// additions, however near it is. Sums are integers, so their order does not matter.
layout(std430, set = 0, binding = 10) buffer Pyramid { uint pyramid[]; };

uvec2 level_size(uint level) { return (uvec2(look.volume_columns, look.volume_rows) + (1u << level) - 1u) >> level; }
