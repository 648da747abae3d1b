// rings.glsl - rings on puddles: where their records lie, and how deep a crater a drop opens.
layout(scalar, set = 0, binding = 15) buffer Rings
{
    virga_rings_gpu rings_head;
    virga_ring_gpu rings[VIRGA_RINGS];
};

#define LEAST_WATER_M 0.0008 // what is thinner carries no wave

// The crater of a drop of 2.5 mm is half as deep as that wide; it grows with the drop's surface (energy over the area of
// the crater), and is no deeper than half of the water.
float crater_depth(float diameter_m, float water_m)
{
    return min(0.5 * diameter_m * diameter_m / 0.0025, 0.5 * water_m);
}
