// histogram.glsl - for the search for the median: VIRGA_GRID_BINS counts for each axis.
layout(std430, set = 0, binding = 1) buffer Histogram { uint histogram[]; };
