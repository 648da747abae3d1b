// handed.glsl - the list of droplets that splash takes (shared/handed_droplet.h).
#include "shared/handed_droplet.h"
layout(scalar, set = 0, binding = 17) buffer Handed
{
    virga_handed_droplets_gpu handed_head;
    virga_handed_droplet_gpu handed[];
};
