/* checkpoint.h - saved states of a shot, one file each: DIR/checkpoint.%04u.virga is the state after the step of that
 * frame, DIR/checkpoint.preroll.virga that after the pre-roll. A render that goes on from one gives the same bytes as
 * a render from the beginning. */
#ifndef VIRGA_TOOL_CHECKPOINT_H
#define VIRGA_TOOL_CHECKPOINT_H

#include "shot_state.h"

/* Saves the state that the shot is in. Waits for the device. Does nothing if the file is there already. */
bool checkpoint_save(shot *s, const char *directory, char *error, size_t error_size);

/* Finds the checkpoint of the scene that is nearest before `frame`, and later than the state that the shot is in.
 * Returns whether there is one; *found is its frame, first - 1 for the end of the pre-roll. Files of other scenes and
 * devices are skipped, as are damaged ones; each reason is printed once. */
bool checkpoint_find(const shot *s, const char *directory, uint32_t frame, uint32_t *found);

/* Goes on from a checkpoint. Waits for the device. False, and `error` says why: the shot is as it was; or, with *torn,
 * a part of the file was refused after others had been loaded, and the shot can not go on. */
bool checkpoint_load(shot *s, const char *directory, uint32_t frame, bool *torn, char *error, size_t error_size);

/* The same in memory: keeps the state that the shot is in, until the shot is closed or a checkpoint is saved or loaded,
 * and goes back to it as often as it is asked for. The settings that the simulation depends on must be those of the
 * time when it was kept. Both wait for the device. */
bool checkpoint_keep(shot *s, char *error, size_t error_size);
bool checkpoint_return(shot *s, char *error, size_t error_size);

#endif
