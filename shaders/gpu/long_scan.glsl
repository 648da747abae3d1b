// long_scan.glsl - group_scan.glsl for a pass of one workgroup over a long list, of which each invocation takes a run.
// On a GPU such a pass takes as long as one invocation does, so there the workgroup is larger; software Vulkan has one
// of SOFTWARE_LANES, which the includer defines. Declares the local size. The sums are the same for all sizes.
layout(local_size_x = SOFTWARE_LANES, local_size_x_id = 5) in; // constant 5: see gpu/pipeline_build.c
#define SCAN_LANES gl_WorkGroupSize.x
#include "gpu/group_scan.glsl"
