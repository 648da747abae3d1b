// sources.glsl - the list of particles that make foam: indices of sorted particles.
#include "shared/compact.h"
layout(scalar, set = 0, binding = 13) readonly buffer SourceList
{
    virga_list_gpu source_list;
    uint sources[];
};
