// pieces.glsl - the droplets of splash particles, in two halves as the splash particles.
layout(scalar, set = 0, binding = 11) buffer Pieces { virga_water_piece_gpu pieces[]; };

uint piece_now(uint splash, uint i) { return splash_now(splash) * VIRGA_WATER_PIECES + i; }
uint piece_before(uint splash, uint i) { return splash_before(splash) * VIRGA_WATER_PIECES + i; }
