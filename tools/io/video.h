/* video.h - frames of a video by their number, as code values: through FFmpeg's libraries, a module that is loaded with
 * the first video. */
#ifndef VIRGA_IO_VIDEO_H
#define VIRGA_IO_VIDEO_H

#include "picture.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct video video; /* opaque */

/* Whether a name ends as that of a video: .mov, .mp4, .m4v, .mkv, .avi, .mxf or .webm. */
bool video_is_name(const char *name);

/* Opens the first picture stream of a file, and finds all its frames: reads the file once, without decoding it. On
 * failure *v is NULL and `error` has one line. */
bool video_open(video **v, const char *path, char *error, size_t error_size);
void video_close(video **v); /* accepts NULL in it */

/* Number of frames, in the order in which they are shown. */
uint32_t video_count(const video *v);

/* Decodes frame `index`, from 0: exactly that one, in any order of calls. A frame is fastest behind the one before.
 * p->rgb is to be freed by free(). p->format is PNG of 8 or 16 bits, which holds all codes of the video. Codes of RGB
 * are exact. Those of YUV become RGB by the matrix and the range that the video has, BT.709 where it has none from 720
 * rows on, else BT.601; the transfer curve stays. A picture that is to be turned stays as it is stored. */
bool video_read(video *v, uint32_t index, picture *p, char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
