/* stage_internal.h - what the files of the stage share. */
#ifndef DRIVE_STAGE_INTERNAL_H
#define DRIVE_STAGE_INTERNAL_H

#include "stage.h"

/* Chooses s->show_format. */
bool stage_images_choose(stage *s, char *error, size_t error_size);

/* Creates the images if there are none or the size of the window has changed, and sets *resized. Waits for the device.
 * */
bool stage_images_fit(stage *s, bool *resized, char *error, size_t error_size);
bool stage_images_again(stage *s, bool *resized, char *error, size_t error_size);
void stage_images_destroy(stage *s);

#endif
