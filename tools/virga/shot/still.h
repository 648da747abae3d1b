/* still.h - one shot for many photographs: each is shown in turn, with its camera and light, and rains from the same
 * state. So device, pipelines and memory are made once. */
#ifndef VIRGA_TOOL_STILL_H
#define VIRGA_TOOL_STILL_H

#include "depth_map.h"
#include "picture.h"
#include "shot/shot.h"

typedef struct shot_still {
    const char *picture, *depth;         /* files; depth NULL: footage.depth_m of the scene */
    bool has_depth_def;                  /* false: the scene says what depths are */
    depth_map_def depth_def;             /* kind, scale, baseline and focal length of the depth */
    bool fills_depth;                    /* see depth_map_fill */
    picture *decoded;                    /* what is in the file; shot_show takes its memory */
    host_camera_calibration calibration; /* focal_px 0, 0: the scene's camera */
    double at_m[2];                      /* where in the rain the camera is: added to x and z of the scene's camera */
    double right_m;                      /* and so far to its right */
    double speed_m_s;                    /* level and ahead */
} shot_still;

/* Shows another picture in a shot that was opened with options.stills, at the time of a frame. Waits for the device.
 * Whose fault an error is: s->input_wrong. After a fault that is not the input's, the shot can only be closed. */
bool shot_show(shot *s, const shot_still *still, uint32_t frame, char *error, size_t error_size);

#endif
