/* transfer.c - the published formulas of transfer curves. */
#include "transfer.h"

#include <math.h>
#include <stddef.h>

static const char *const names[TRANSFER_COUNT] = {"auto",    "linear", "srgb",  "rec709",
                                                  "acescct", "cineon", "logc3", "slog3"};

const char *transfer_name(transfer_curve curve)
{
    return curve < TRANSFER_COUNT ? names[curve] : NULL;
}

/* ---- a straight line near black and a power above, odd around 0 */

/* code = slope * light up to `cut`, (1 + offset) * light^exponent - offset above. */
typedef struct power_curve {
    double slope, cut, offset, exponent;
} power_curve;

static const power_curve srgb = {12.92, 0.0031308, 0.055, 1 / 2.4};

/* BT.709 rounds its constants to 1.099 and 0.018. These are the ones with which line and power meet (BT.2020). */
static const power_curve rec709 = {4.5, 0.018053968510807, 0.09929682680944, 0.45};

static double power_to_light(const power_curve *c, double code)
{
    const double size = fabs(code);
    const double light =
        size <= c->slope * c->cut ? size / c->slope : pow((size + c->offset) / (1 + c->offset), 1 / c->exponent);
    return copysign(light, code);
}

static double power_to_code(const power_curve *c, double light)
{
    const double size = fabs(light);
    const double code = size <= c->cut ? c->slope * size : (1 + c->offset) * pow(size, c->exponent) - c->offset;
    return copysign(code, light);
}

/* ---- a straight line near black and a logarithm above */

/* code = line * light + foot up to `cut`, scale * log10(gain * light + shift) + base above. */
typedef struct log_curve {
    double cut, line, foot, scale, gain, shift, base;
} log_curve;

#define LOG10_2 0.30102999566398119521

/* ACEScct: (log2(light) + 9.72) / 17.52. */
static const log_curve acescct = {0.0078125, 10.5402377416545, 0.0729055341958355, 1 / (17.52 * LOG10_2), 1,
                                  0,         9.72 / 17.52};

/* ARRI, ALEXA Log C curve, 2012: exposure index 800, scene light. */
static const log_curve logc3 = {0.010591, 5.367655, 0.092809, 0.247190, 5.555556, 0.052272, 0.385537};

/* Sony, technical summary for S-Gamut3 and S-Log3, 2016. */
static const log_curve slog3 = {
    0.01125, (171.2102946929 - 95) / (0.01125 * 1023), 95.0 / 1023, 261.5 / 1023, 1 / 0.19, 0.01 / 0.19, 420.0 / 1023};

static double log_to_light(const log_curve *c, double code)
{
    if (code <= c->line * c->cut + c->foot)
        return (code - c->foot) / c->line;
    return (pow(10, (code - c->base) / c->scale) - c->shift) / c->gain;
}

static double log_to_code(const log_curve *c, double light)
{
    return light <= c->cut ? c->line * light + c->foot : c->scale * log10(c->gain * light + c->shift) + c->base;
}

/* ---- Cineon */

/* Kennel and Snider 1993: 0.002 printing density a code, a negative's gamma of 0.6. Light below that of black is cut:
 * the logarithm ends at -CINEON_BLACK / (1 - CINEON_BLACK). */
#define CINEON_BLACK 0.0107977516232771 /* 10^((95 - 685) * 0.002 / 0.6) */

static double cineon_to_light(double code)
{
    return (pow(10, (1023 * code - 685) * 0.002 / 0.6) - CINEON_BLACK) / (1 - CINEON_BLACK);
}

static double cineon_to_code(double light)
{
    const double least = pow(10, -685 * 0.002 / 0.6); /* code 0 */
    return (685 + log10(fmax(light * (1 - CINEON_BLACK) + CINEON_BLACK, least)) * 0.6 / 0.002) / 1023;
}

/* ---- all of them */

double transfer_to_light(transfer_curve curve, double code)
{
    switch (curve) {
    case TRANSFER_SRGB: return power_to_light(&srgb, code);
    case TRANSFER_REC709: return power_to_light(&rec709, code);
    case TRANSFER_ACESCCT: return log_to_light(&acescct, code);
    case TRANSFER_LOGC3: return log_to_light(&logc3, code);
    case TRANSFER_SLOG3: return log_to_light(&slog3, code);
    case TRANSFER_CINEON: return cineon_to_light(code);
    default: return code;
    }
}

double transfer_to_code(transfer_curve curve, double light)
{
    switch (curve) {
    case TRANSFER_SRGB: return power_to_code(&srgb, light);
    case TRANSFER_REC709: return power_to_code(&rec709, light);
    case TRANSFER_ACESCCT: return log_to_code(&acescct, light);
    case TRANSFER_LOGC3: return log_to_code(&logc3, light);
    case TRANSFER_SLOG3: return log_to_code(&slog3, light);
    case TRANSFER_CINEON: return cineon_to_code(light);
    default: return light;
    }
}
