// shape.glsl - how large crowns, cones and disks are, and how long they last.
//
// Fitted to pictures of drops on deep water (Worthington 1908; Mizukami et al., figures 2 (b) and 5): the crown of a
// drop of 2 mm is 1.5 drops high, 6 wide and lasts 50 ms, that of 4 mm is 3 high, 9 wide and lasts 100 ms. The powers
// of the Weber number are those of a height by kinetic energy over surface energy, and of Clanet's spread.

float crown_height(float diameter_m, float weber) { return 0.045 * sqrt(weber) * diameter_m; }
float crown_radius(float diameter_m, float weber) { return 0.55 * sqrt(sqrt(weber)) * diameter_m; }

// It rises as if thrown upwards to its height, and falls for as long.
float crown_time(float height_m) { return 2.0 * sqrt(2.0 * height_m / GRAVITY); }

// Fraction of its height at a fraction of its life.
float crown_rise(float t) { return 4.0 * t * (1.0 - t); }

// Fraction of its radius: grows with the square root of time (Yarin and Weiss 1995) until the crown is highest, then
// stays.
float crown_spread(float t) { return sqrt(clamp(2.0 * t, 0.0, 1.0)); }

// The speed of the cone at its foot: a cone as high as 0.0018 We diameters, times 0.5 to 1.5.
float cone_speed(float diameter_m, float weber, float chance)
{
    return sqrt(2.0 * GRAVITY * 0.0018 * weber * diameter_m * (0.5 + chance));
}

// A drop that flattens on a surface that does not absorb it: Clanet et al. 2004, a width of D We^1/4.
float disk_radius(float diameter_m, float weber) { return 0.5 * diameter_m * max(sqrt(sqrt(weber)), 1.0); }

#define DISK_S 2.0
#define DOT_S 0.05
#define MAX_SHEET 0.75 // max height of a low sheet, relative to a crown
#define SHEET_S 0.09   // life of the low sheet of a scattering splash, and of what shows a splash from afar
