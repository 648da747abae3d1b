/* ground_limits.h - limits and names that ground's C and GLSL share with the code that reads its output. */
#ifndef VIRGA_SHARED_GROUND_LIMITS_H
#define VIRGA_SHARED_GROUND_LIMITS_H

/* cells along the side of a tile: the unit that enters the window, leaves it and is cached */
#define VIRGA_GROUND_TILE       64
#define VIRGA_GROUND_TILE_CELLS 4096
#define VIRGA_GROUND_MAX_TILES  4096 /* in the window: 64 x 64, a window of 4096 x 4096 cells */
#define VIRGA_GROUND_MATERIALS  32
#define VIRGA_GROUND_SPOTS      8 /* bits along the side of a cell in its bit mask of dark spots */
/* Diameter of a dark spot over the diameter of its drop, on porous materials. On smooth ones a drop spreads to We^(1/4)
 * times its diameter, 4 to 7 in rain (Clanet et al. 2004, Maximal deformation of an impacting drop). */
#define VIRGA_GROUND_SPREAD 3.0
/* max pieces in which the water of an impact that represents many drops is scattered */
#define VIRGA_GROUND_MAX_PIECES 32
#define VIRGA_GROUND_SCATTER_M  2.0  /* m, max distance of the pieces from the impact */
#define VIRGA_GROUND_DROP_M     0.09 /* m, radius of the disk that each represented drop covers */
/* s, time between the pieces of an impact. Drops that an impact stands for fall one after the other, so that splashes
 * and rings come as those of single drops do: as many in a tick as in a Poisson process, not in batches. */
#define VIRGA_GROUND_PIECE_S  0.0167
#define VIRGA_GROUND_CROWNS_M 2.0 /* m, max distance from a splash of the crowns drawn for it */

/* Ring waves on puddles: the table of waves, and how many rings are drawn individually. */
#define VIRGA_RING_DEPTHS     8 /* water depths in the table; a ring uses the nearest */
#define VIRGA_RING_DEPTH_LIST 0.001, 0.002, 0.003, 0.005, 0.008, 0.014, 0.026, 0.05 /* m */
/* Widths of craters in the table. A drop's ring uses the nearest of the first two; the last is that of wakes, and
 * fits a foot. Waves of a wider crater are longer and live longer: a list has an item for each width. */
#define VIRGA_RING_WIDTHS      3
#define VIRGA_RING_DROP_WIDTHS 2
#define VIRGA_RING_WIDTH_LIST  0.004, 0.01, 0.07 /* m */
/* s, lifetime of a ring. Viscosity alone would leave waves of 3 cm for seconds, but rain mixes the water below its
 * surface, which calms them sooner (Tsimplis 1992, The effect of rain in calming the sea). */
#define VIRGA_RING_LIFE_LIST  0.5, 0.7, 2.0
#define VIRGA_RING_MAX_LIFE_S 0.7 /* of drops' rings */
#define VIRGA_WAKE_LIFE_S     2.0
#define VIRGA_RING_LAYERS     24    /* WIDTHS * DEPTHS: width * DEPTHS + depth */
#define VIRGA_RING_TIMES      200   /* time samples of the table, from 0 to the end of a life */
#define VIRGA_RING_OPENS_S    0.005 /* s, time in which a drop's crater opens */
#define VIRGA_WAKE_OPENS_S    0.05  /* and that of a wake: a foot treads down, a tyre passes */
/* part of its life after which a ring fades: 1 - smoothstep(FADES, 1, age / life) */
#define VIRGA_RING_FADES 0.7
/* samples from radius 0 to the front of the waves: 6 per wavelength where a wave has 2 % of the max amplitude */
#define VIRGA_RING_RADII 256
/* The front is at START + FRONT t (m). START is five crater widths, four for wakes; FRONT is the group velocity (m/s)
 * of the shortest waves. A wake's are so long that the depth h holds them back, to sqrt(g h) at most: the first
 * WAKE_SHALLOW depths have another front than the others. */
#define VIRGA_RING_START_LIST    0.02, 0.05, 0.28
#define VIRGA_RING_FRONT_LIST    0.45, 0.3, 0.56
#define VIRGA_WAKE_SHALLOW       5
#define VIRGA_WAKE_SHALLOW_FRONT 0.31
/* live or still to come at once; if more drops fall, a random choice of them gets rings */
#define VIRGA_MAX_RINGS              6144
#define VIRGA_RING_VERTICES(for_gpu) ((for_gpu) ? 12u : 6u) /* of a ring: of a hexagon's triangles or a square's */
/* Craters of wakes, behind those of drops: a new one replaces the oldest. Four wheels leave 60 of them in a metre. */
#define VIRGA_MAX_WAKES 512

/* The states of a cell, as in sections 2.1 and 4.6 of Mizukami et al. */
#define VIRGA_GROUND_NONE      0 /* no ground */
#define VIRGA_GROUND_DRY       1 /* absorbs the water that falls on it; dry or damp */
#define VIRGA_GROUND_WET       2 /* saturated, with less than 3 mm of water on it */
#define VIRGA_GROUND_PUDDLE_3  3 /* 3 mm of water or more */
#define VIRGA_GROUND_PUDDLE_5  4 /* 5 mm or more */
#define VIRGA_GROUND_PUDDLE_10 5 /* 10 mm or more */
#define VIRGA_GROUND_STATES    6

#endif
