/* water/spray_kernel.c - solves for the kernel of droplets. */
#include "water/spray_kernel.h"

#include <math.h>

/* The largest density that a ball of water can have at its own radius, see water_spray_kernel: 105/16 (2 / sqrt(27))^3,
 * less a little. */
#define MAX_BALL_LEVEL 0.374

/* The kernel of droplets (equation 4 of the paper and the condition below it): h' with W''(R_s, h') = level.
 *
 * With R_s^3 = 3 v / (4 pi V) the volume v / V is 4/3 pi R_s^3, and with x = R_s / h'
 *
 *     W''(R_s, h') = 315 / (64 pi h'^9) (h'^2 - R_s^2)^3 v / V = 105/16 x^3 (1 - x^2)^3,
 *
 * which does not depend on V. So x - x^3 = c with c = (16 level / 105)^(1/3). The larger of the two solutions is the
 * more compact kernel: x = 2 / sqrt(3) cos(acos(-c sqrt(27) / 2) / 3) (Viete's formula). The paper does not say that
 * there is none for c > 2 / sqrt(27), a level above 0.374; droplets then have their surface at that level instead. They
 * have a surface of their own, so nothing else depends on it. */
void water_spray_kernel(double level, double *ratio, double *factor, double *used_level)
{
    *used_level = level < MAX_BALL_LEVEL ? level : MAX_BALL_LEVEL;
    const double c = cbrt(16 * *used_level / 105), x = 2 / sqrt(3) * cos(acos(-c * sqrt(27) / 2) / 3);
    *ratio = 1 / x;
    *factor = 105.0 / 16 * x * x * x;
}
