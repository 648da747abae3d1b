// grid.glsl - the neighbour grid with the uniform block of the water.
#define VIRGA_GLSL
#include "shared/water_gpu.h"
#define GRID_STEP virga_water_step_gpu
#include "particles/grid.glsl"
