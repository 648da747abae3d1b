// group_scan.glsl - sums over the lanes before one's own, in a workgroup of 256.
//
// In two levels: 16 lanes add up 16 numbers each, then every lane what lies before it. That is two barriers; the usual doubling
// of reach (Hillis and Steele 1986) has seventeen, and on software Vulkan a barrier costs more than thirty additions.
#define SCAN_LANES 256u
#define SCAN_BLOCK 16u

shared uvec2 scan_sums[SCAN_LANES], scan_blocks[SCAN_LANES / SCAN_BLOCK];

// What the lanes before this one have of two numbers; `all` gets what they all have. From all lanes alike: there are barriers
// in it, and one may be called once in a shader.
uvec2 scan_group(uvec2 own, out uvec2 all)
{
    const uint lane = gl_LocalInvocationIndex, block = lane / SCAN_BLOCK;
    scan_sums[lane] = own;
    barrier();
    if (lane < SCAN_LANES / SCAN_BLOCK) {
        uvec2 sum = uvec2(0u);
        for (uint i = 0u; i < SCAN_BLOCK; i++)
            sum += scan_sums[lane * SCAN_BLOCK + i];
        scan_blocks[lane] = sum;
    }
    barrier();
    uvec2 before = uvec2(0u);
    all = uvec2(0u);
    for (uint i = 0u; i < SCAN_LANES / SCAN_BLOCK; i++) {
        before += i < block ? scan_blocks[i] : uvec2(0u);
        all += scan_blocks[i];
    }
    for (uint i = block * SCAN_BLOCK; i < lane; i++)
        before += scan_sums[i];
    return before;
}
