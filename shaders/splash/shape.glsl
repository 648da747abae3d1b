// shape.glsl - how large crowns, cones and disks are, and how long they last.
//
// Crowns of rain on deep water are two to three drops high and four wide, and last 30 to 80 ms (after the pictures of
// Worthington 1908 and of Mizukami et al., figures 2 (b) and 5). Their height is taken as 0.045 We^1/2 diameters, their
// greatest radius as 0.55 We^1/4: the balance of the drop's energy with gravity and with surface tension.

float crown_height(float diameter_m, float weber) { return 0.045 * sqrt(weber) * diameter_m; }
float crown_radius(float diameter_m, float weber) { return 0.55 * sqrt(sqrt(weber)) * diameter_m; }

// It rises as if thrown to its height, and falls as long.
float crown_time(float height_m) { return 2.0 * sqrt(2.0 * height_m / GRAVITY); }

// Share of its height at a share of its time.
float crown_rise(float t) { return 4.0 * t * (1.0 - t); }

// Share of its radius: as the square root of time (Yarin and Weiss 1995) until it is highest, then it stays.
float crown_spread(float t) { return sqrt(clamp(2.0 * t, 0.0, 1.0)); }

// The cone's speed at its foot: a cone as high as 0.0018 We diameters, 0.5 to 1.5 times.
float cone_speed(float diameter_m, float weber, float chance)
{
    return sqrt(2.0 * GRAVITY * 0.0018 * weber * diameter_m * (0.5 + chance));
}

// A drop that flattens on what does not take it up: Clanet et al. 2004, D We^1/4 across.
float disk_radius(float diameter_m, float weber) { return 0.5 * diameter_m * max(sqrt(sqrt(weber)), 1.0); }

#define DISK_S 2.0
#define DOT_S 0.05
#define SHEET_S 0.09 // of the low sheet of a scattering splash, and of what shows one from afar
