/* crown_sheet.h - the water of a crown: how much of it is in the wall, in the rim and in the fingers, how thin the wall
 * is, and when and how fast holes open in it. The same formulas in C and in GLSL. Internal to Virga.
 *
 * All follow from the crown's outline (splash/shape.glsl): `share` s is the fraction of its life, its height is
 * 4 s (1 - s) of the highest, its radius sqrt(2 s) of the widest until s = 1/2. Lengths in m, times in s. */
#ifndef VIRGA_SHARED_CROWN_SHEET_H
#define VIRGA_SHARED_CROWN_SHEET_H

#ifdef VIRGA_GLSL
#define VIRGA_CROWN_FN
#define VIRGA_CROWN_SQRT    sqrt
#define VIRGA_CROWN_EXP     exp
#define VIRGA_CROWN_CBRT(x) pow(x, 1.0 / 3.0)
#define VIRGA_CROWN_MIN     min
#define VIRGA_CROWN_MAX     max
#else
#include <math.h>
#define VIRGA_CROWN_FN   static inline
#define VIRGA_CROWN_SQRT sqrtf
#define VIRGA_CROWN_EXP  expf
#define VIRGA_CROWN_CBRT cbrtf
#define VIRGA_CROWN_MIN  fminf
#define VIRGA_CROWN_MAX  fmaxf
#endif

#define VIRGA_CROWN_DENSITY 998.2f  /* kg/m^3 */
#define VIRGA_CROWN_TENSION 0.0728f /* N/m */
#define VIRGA_CROWN_PI      3.1415927f
/* Water of a crown in drops: most of it is the pool's, which the cavity pushes up and which sinks back. With it the rim
 * is a fifth of a drop thick, and some 15 fingers rise from the crown of a drop of 2 mm and 25 from one of 4 mm. */
#define VIRGA_CROWN_DROPS   6.0f
#define VIRGA_CROWN_WEDGE   2.8f  /* the wall thins upwards by e to the power of this */
#define VIRGA_CROWN_FED     0.25f /* share of its life after which no more water comes up */
#define VIRGA_CROWN_FINGERS 0.4f  /* share of the gathered water that is in the fingers, the rest is in the rim */
#define VIRGA_CROWN_TIP     0.4f  /* share of a finger's water that is in the drop at its tip */
/* The wall's radius over that of the crown: at the foot, and what is added at the square of the height. Then its mean
 * over the height, a + b / 3. */
#define VIRGA_CROWN_FOOT  0.72f
#define VIRGA_CROWN_FLARE 0.1575f
#define VIRGA_CROWN_MEAN  0.7725f
#define VIRGA_CROWN_REACH 1.38f /* height that fingers may reach, over that of the rim */
/* Length of the fastest growing wave of a cylinder over its radius: 2 pi / 0.697 (Rayleigh 1878). The number of drops
 * of crowns follows from it (Zhang, Brunet, Eggers and Deegan 2010). */
#define VIRGA_CROWN_WAVE 9.01f
/* Growth from a hundredth of the radius to all of it, at the rate 0.343 sqrt(tension / (density radius^3)). */
#define VIRGA_CROWN_BREAKS 13.4f
/* Share of a foot's sheet that flies off as drops: what its fingers hold when it is highest, FINGERS of a half. */
#define VIRGA_CROWN_SHED 0.2f

/* Share of its water that has come up. */
VIRGA_CROWN_FN float virga_crown_fed(float share)
{
    return VIRGA_CROWN_MIN(share / VIRGA_CROWN_FED, 1.0f);
}

/* Share of that which has gathered at the edge. While the crown rises the wall's water is faster than the rim and runs
 * into it. */
VIRGA_CROWN_FN float virga_crown_gathered(float share)
{
    return VIRGA_CROWN_MIN(share, 0.5f);
}

/* Water of a crown (m^3) without that of its droplets, which is `flown` of it. */
VIRGA_CROWN_FN float virga_crown_water(float diameter_m, float flown)
{
    return VIRGA_CROWN_DROPS * (1.0f - flown) * VIRGA_CROWN_PI / 6.0f * diameter_m * diameter_m * diameter_m;
}

/* Mean thickness of the wall when the crown is highest. The wall's water, half of all, over its area. */
VIRGA_CROWN_FN float virga_crown_thinnest(float water_m3, float widest_m, float highest_m)
{
    return 0.5f * water_m3 / VIRGA_CROWN_MAX(2.0f * VIRGA_CROWN_PI * VIRGA_CROWN_MEAN * widest_m * highest_m, 1e-12f);
}

/* The mean thickness at another time, over that. Water over area is fed (1 - s) / (sqrt(2 s) 4 s (1 - s)), which is
 * 1 / sqrt(2 s) while water comes up and 1 / (4 sqrt(2) s^1.5) then, and a half when the crown is highest. When it
 * falls, its foot sinks into the water below, and the wall above stays as it is. */
VIRGA_CROWN_FN float virga_crown_thinning(float share)
{
    const float s = VIRGA_CROWN_MIN(VIRGA_CROWN_MAX(share, 1e-4f), 0.5f), root = VIRGA_CROWN_SQRT(2.0f * s);
    return s < VIRGA_CROWN_FED ? 2.0f / root : 1.0f / (root * root * root);
}

/* The share of its life at which a part of the wall that is `thinnest` thick in the end gets as thin as `hole`. 1: it
 * never does. */
VIRGA_CROWN_FN float virga_crown_opens(float thinnest_m, float hole_m)
{
    const float ratio = thinnest_m / VIRGA_CROWN_MAX(hole_m, 1e-9f), fed = 2.0f * ratio * ratio;
    if (ratio >= 1.0f)
        return 1.0f;
    return fed < VIRGA_CROWN_FED ? fed : 0.5f * VIRGA_CROWN_CBRT(ratio * ratio);
}

/* How thick the wall is at a fraction of its height over its mean: a wedge, thick at the foot and thin below the rim,
 * c exp(-k y). Over the wall's area, where the circumference goes with a + b y^2, its mean is 1 with
 * c = (a + b / 3) / (a I0 + b I2), I0 = (1 - exp(-k)) / k, I2 = (2 - (k^2 + 2 k + 2) exp(-k)) / k^3: 3.101. */
VIRGA_CROWN_FN float virga_crown_profile(float up)
{
    return 3.101f * VIRGA_CROWN_EXP(-VIRGA_CROWN_WEDGE * up);
}

/* Speed at which an edge of a sheet of water retracts (Taylor 1959, Culick 1960). */
VIRGA_CROWN_FN float virga_crown_retracts(float thickness_m)
{
    return VIRGA_CROWN_SQRT(2.0f * VIRGA_CROWN_TENSION / (VIRGA_CROWN_DENSITY * VIRGA_CROWN_MAX(thickness_m, 1e-7f)));
}

/* Water in the wall, if it is whole, in the rim and in the fingers (m^3). `left`: share of the droplets that have left
 * the fingers, `flown_m3` the water of all of them. */
VIRGA_CROWN_FN float virga_crown_wall(float water_m3, float share)
{
    const float rising = virga_crown_fed(share) * (1.0f - virga_crown_gathered(share));
    return water_m3 * (share < 0.5f ? rising : 2.0f * share * (1.0f - share));
}

VIRGA_CROWN_FN float virga_crown_rim(float water_m3, float share)
{
    return water_m3 * (1.0f - VIRGA_CROWN_FINGERS) * virga_crown_fed(share) * virga_crown_gathered(share);
}

VIRGA_CROWN_FN float virga_crown_fingers(float water_m3, float share, float flown_m3, float left)
{
    return virga_crown_fed(share) *
           (water_m3 * VIRGA_CROWN_FINGERS * virga_crown_gathered(share) + flown_m3 * (1.0f - left));
}

/* Share of its droplets that have left: between 0.15 and 0.45 of its life, see start_pile. */
VIRGA_CROWN_FN float virga_crown_left(float share)
{
    return VIRGA_CROWN_MIN(VIRGA_CROWN_MAX((share - 0.15f) / 0.3f, 0.0f), 1.0f);
}

/* Radius of a rod, and of a ball. */
VIRGA_CROWN_FN float virga_crown_rod(float area_m2)
{
    return VIRGA_CROWN_SQRT(area_m2 / VIRGA_CROWN_PI);
}

VIRGA_CROWN_FN float virga_crown_ball(float water_m3)
{
    return VIRGA_CROWN_CBRT(0.75f / VIRGA_CROWN_PI * water_m3);
}

/* Fingers of a crown, an even number: the rim breaks up where its fastest wave has crests, when the last water comes
 * up. */
VIRGA_CROWN_FN float virga_crown_count(float water_m3, float widest_m)
{
    const float around = 2.0f * VIRGA_CROWN_PI * widest_m * VIRGA_CROWN_SQRT(2.0f * VIRGA_CROWN_FED);
    const float radius = virga_crown_rod(virga_crown_rim(water_m3, VIRGA_CROWN_FED) / VIRGA_CROWN_MAX(around, 1e-9f));
    const float pairs = around / VIRGA_CROWN_MAX(2.0f * VIRGA_CROWN_WAVE * radius, 1e-9f);
    return 2.0f * VIRGA_CROWN_MIN(VIRGA_CROWN_MAX(pairs, 3.0f), 30.0f);
}

/* Length of a finger with that water: its body is on average 0.6 as thick as the rim, or as long as there is room. */
VIRGA_CROWN_FN float virga_crown_finger(float water_m3, float rim_m, float room_m)
{
    const float body = 0.6f * rim_m;
    return VIRGA_CROWN_MIN((1.0f - VIRGA_CROWN_TIP) * water_m3 / VIRGA_CROWN_MAX(VIRGA_CROWN_PI * body * body, 1e-12f),
                           room_m);
}

/* Radius of its body at a fraction of its length, so that it holds the rest of its water: it narrows to a quarter. The
 * integral of (1.6 - 1.2 x)^2 is 1.12. */
VIRGA_CROWN_FN float virga_crown_tapers(float water_m3, float length_m, float along)
{
    const float area = (1.0f - VIRGA_CROWN_TIP) * water_m3 / VIRGA_CROWN_MAX(length_m, 1e-7f);
    return virga_crown_rod(area / 1.12f) * (1.6f - 1.2f * along);
}

/* Time in which a rod of water breaks into drops. */
VIRGA_CROWN_FN float virga_crown_breaks(float radius_m)
{
    return VIRGA_CROWN_BREAKS *
           VIRGA_CROWN_SQRT(VIRGA_CROWN_DENSITY * radius_m * radius_m * radius_m / VIRGA_CROWN_TENSION);
}

#undef VIRGA_CROWN_FN
#undef VIRGA_CROWN_SQRT
#undef VIRGA_CROWN_CBRT
#undef VIRGA_CROWN_EXP
#undef VIRGA_CROWN_MIN
#undef VIRGA_CROWN_MAX

#endif
