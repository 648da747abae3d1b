/* ground_limits.h - sizes and names that ground's C, its GLSL and its readers agree on. */
#ifndef VIRGA_SHARED_GROUND_LIMITS_H
#define VIRGA_SHARED_GROUND_LIMITS_H

#define VIRGA_GROUND_TILE       64 /* cells along a tile's side: what comes into the window, leaves it and is kept */
#define VIRGA_GROUND_TILE_CELLS 4096
#define VIRGA_GROUND_MAX_TILES  4096 /* in the window: 64 x 64, a window of 4096 x 4096 cells */
#define VIRGA_GROUND_MATERIALS  32
#define VIRGA_GROUND_SPOTS      8 /* a cell's dark spots are this many bits along its side */
/* A spot's diameter over its drop's, on what is porous. On what is smooth a drop spreads to We^(1/4) of its own, 4 to 7
 * in rain (Clanet et al. 2004, Maximal deformation of an impacting drop). */
#define VIRGA_GROUND_SPREAD     3.0
#define VIRGA_GROUND_MAX_PIECES 32   /* pieces at most that an impact which stands for many drops is scattered in, */
#define VIRGA_GROUND_SCATTER_M  2.0  /* within so far (m) of it at most: */
#define VIRGA_GROUND_DROP_M     0.09 /* each drop that it stands for takes a disk of this radius (m) */
#define VIRGA_GROUND_CROWNS_M   2.0  /* crowns that one splash shows stand within so far (m) of it at most */

/* Rings on puddles: the table of waves, and how many rings are drawn one by one. */
#define VIRGA_RING_DEPTHS     8 /* of water: a ring takes the nearest of them */
#define VIRGA_RING_DEPTH_LIST 0.001, 0.002, 0.003, 0.005, 0.008, 0.014, 0.026, 0.05 /* m */
#define VIRGA_RING_TIMES      200
#define VIRGA_RING_TIME_S     0.5   /* a ring is forgotten then: others have run over it */
#define VIRGA_RING_OPENS_S    0.005 /* in which its crater opens */
#define VIRGA_RING_RADII      256  /* from 0 to how far the waves have come: 6 a wave where one is 2 % of the highest */
#define VIRGA_RING_START_M    0.02 /* that is START_M + FRONT_M_S t: five crater radii, and the group of the shortest */
#define VIRGA_RING_FRONT_M_S  0.45
#define VIRGA_MAX_RINGS       3072 /* live at once; of more that fall, some are taken by lot */

/* The states of a cell, as section 2.1 and 4.6 of Mizukami et al. have them. */
#define VIRGA_GROUND_NONE      0 /* no ground there */
#define VIRGA_GROUND_DRY       1 /* takes up what falls on it; also while it is damp */
#define VIRGA_GROUND_WET       2 /* saturated, and less than 3 mm of water on it */
#define VIRGA_GROUND_PUDDLE_3  3 /* 3 mm of water and more */
#define VIRGA_GROUND_PUDDLE_5  4 /* 5 mm and more */
#define VIRGA_GROUND_PUDDLE_10 5 /* 10 mm and more */
#define VIRGA_GROUND_STATES    6

#endif
