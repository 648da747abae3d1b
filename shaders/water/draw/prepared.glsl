// prepared.glsl - counts and indirect arguments that the passes of a prepare write.
layout(scalar, set = 0, binding = 8) buffer Prepared { virga_water_prepared_gpu prepared; };
