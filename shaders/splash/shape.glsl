// shape.glsl - how large crowns, cones and disks are, and how long they last.
//
// Fits to pictures of drops on deep water (Worthington 1908; Mizukami et al., figures 2 (b) and 5): a crown of a drop
// of 2 mm is 1.5 drops high and 6 wide and lasts for 50 ms, of 4 mm 3 high and 9 wide for 100 ms. The powers of the
// Weber number are those of a height that its energy against its surface gives, and of Clanet's spread.

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
#define MOST_SHEET 0.75 // height of a low sheet over that of a crown
#define SHEET_S 0.09 // of the low sheet of a scattering splash, and of what shows one from afar
