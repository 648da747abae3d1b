// group_scan.glsl - sums over the lanes before one's own, in a workgroup of SCAN_LANES.
//
// In three levels: a lane for each block of lanes adds up its numbers, one lane adds up the blocks, and every lane adds
// two numbers. That is three barriers; the usual doubling of reach (Hillis and Steele 1986) has seventeen, and on
// software Vulkan a barrier costs more than thirty additions. Few lanes look at many numbers: there each look is a loop
// over lanes, and when every lane added up what lies before it a scan took 40 us longer.
#ifndef SCAN_LANES
#define SCAN_LANES 256u
#endif
#define SCAN_BLOCK (SCAN_LANES < 256u ? 8u : 16u)

shared uvec2 scan_sums[SCAN_LANES], scan_blocks[SCAN_LANES / SCAN_BLOCK + 1u];

// What the lanes before this one have of two numbers; `all` gets what they all have. From all lanes alike: there are
// barriers in it, and one may be called once in a shader.
uvec2 scan_group(uvec2 own, out uvec2 all)
{
    const uint lane = gl_LocalInvocationIndex, blocks = SCAN_LANES / SCAN_BLOCK;
    scan_sums[lane] = own;
    barrier();
    if (lane < blocks) {
        uvec2 sum = uvec2(0u);
        for (uint i = lane * SCAN_BLOCK; i < (lane + 1u) * SCAN_BLOCK; i++) {
            const uvec2 one = scan_sums[i];
            scan_sums[i] = sum;
            sum += one;
        }
        scan_blocks[lane] = sum;
    }
    barrier();
    if (lane == 0u) {
        uvec2 sum = uvec2(0u);
        for (uint i = 0u; i < blocks; i++) {
            const uvec2 one = scan_blocks[i];
            scan_blocks[i] = sum;
            sum += one;
        }
        scan_blocks[blocks] = sum;
    }
    barrier();
    all = scan_blocks[blocks];
    return scan_sums[lane] + scan_blocks[lane / SCAN_BLOCK];
}
