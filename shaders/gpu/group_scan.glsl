// group_scan.glsl - prefix sum over the invocations of one workgroup of SCAN_LANES.
//
// In three levels: one invocation per block adds up the block, one invocation adds up the blocks, then each adds two
// numbers. That takes three barriers. The usual doubling (Hillis and Steele 1986) takes seventeen, and on software
// Vulkan a barrier costs more than thirty additions. Only few invocations read many numbers, because there each read is
// a loop over the lanes: when every invocation added up what lies before it, a scan took 40 us longer.
#ifndef GROUP_SCAN
#define GROUP_SCAN
#ifndef SCAN_LANES
#define SCAN_LANES 256u
#endif
#define SCAN_BLOCK (SCAN_LANES < 256u ? 8u : 16u)

shared uvec2 scan_sums[SCAN_LANES], scan_blocks[SCAN_LANES / SCAN_BLOCK + 1u];

// Returns the sum of both numbers over the invocations before this one; `all` gets the sum over all. Has barriers: call
// it from all invocations, and only once in a shader.
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
#endif
