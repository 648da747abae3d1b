/* transfer.h - transfer curves: what light a code value of a picture stands for. */
#ifndef VIRGA_IO_TRANSFER_H
#define VIRGA_IO_TRANSFER_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum transfer_curve {
    TRANSFER_AUTO,    /* by the file: sRGB for whole numbers, linear for floats */
    TRANSFER_LINEAR,  /* the code is the light */
    TRANSFER_SRGB,    /* IEC 61966-2-1: photographs, textures */
    TRANSFER_REC709,  /* ITU-R BT.709: what a video camera does; nothing of the display is undone */
    TRANSFER_ACESCCT, /* S-2016-001: ACES for grading */
    TRANSFER_CINEON,  /* Kodak, printing density: white at code 685 of 1023, black at 95 */
    TRANSFER_LOGC3,   /* ARRI, exposure index 800 */
    TRANSFER_SLOG3,   /* Sony */
    TRANSFER_COUNT,
} transfer_curve;

/* As scene files have it; NULL for no curve. */
const char *transfer_name(transfer_curve curve);

/* Code [0; 1] (of 8 bits: the byte / 255) to linear light, and back. The curves go on straight or in their own formula
 * outside [0; 1], so both are inverse to each other everywhere. Log curves have codes for light slightly below zero,
 * which is the noise of a sensor; it stays. TRANSFER_AUTO is linear. Color primaries are not changed. */
double transfer_to_light(transfer_curve curve, double code);
double transfer_to_code(transfer_curve curve, double light);

#ifdef __cplusplus
}
#endif
#endif
