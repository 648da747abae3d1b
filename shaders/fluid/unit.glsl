// unit.glsl - values that the eight lanes of a unit exchange by subgroup shuffles. A subgroup is one unit or several.
// All lanes of a unit call these together. Include it with the extensions of subgroups.
#define UNIT 8u

uint unit_lane() { return gl_SubgroupInvocationID % UNIT; }

// The value of lane k of the own unit.
vec3 unit_read(vec3 value, uint k) { return subgroupShuffle(value, gl_SubgroupInvocationID / UNIT * UNIT + k); }

uint unit_max(uint x)
{
    x = max(x, subgroupShuffleXor(x, 1u));
    x = max(x, subgroupShuffleXor(x, 2u));
    return max(x, subgroupShuffleXor(x, 4u));
}

uint unit_min(uint x) { return ~unit_max(~x); }

uint unit_sum(uint x)
{
    x += subgroupShuffleXor(x, 1u);
    x += subgroupShuffleXor(x, 2u);
    return x + subgroupShuffleXor(x, 4u);
}
