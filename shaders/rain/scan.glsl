// scan.glsl - one workgroup: counts of groups into places, in order. Each lane takes a run of groups.
#include "scan_buffers.glsl"

shared uint lane_sums[VIRGA_RAIN_GROUP];

// Gives the groups their places from `first` on, and returns (to all lanes) the number of picks.
uint scan_picks(uint groups, uint first)
{
    const uint lane = gl_LocalInvocationIndex;
    const uint run = (groups + VIRGA_RAIN_GROUP - 1u) / VIRGA_RAIN_GROUP;
    const uint begin = min(lane * run, groups), end = min(begin + run, groups);
    uint sum = 0u;
    for (uint i = begin; i < end; i++)
        sum += picks[i * PICK_STRIDE + PICK_WORDS];
    lane_sums[lane] = sum;
    barrier();
    uint place = first, total = 0u;
    for (uint i = 0u; i < VIRGA_RAIN_GROUP; i++) {
        place += i < lane ? lane_sums[i] : 0u;
        total += lane_sums[i];
    }
    for (uint i = begin; i < end; i++) {
        picks[i * PICK_STRIDE + PICK_WORDS + 1] = place;
        place += picks[i * PICK_STRIDE + PICK_WORDS];
    }
    return total;
}
