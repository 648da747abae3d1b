/* modes.h - the list of all view modes. */
#ifndef VIRGA_VIEW_MODES_H
#define VIRGA_VIEW_MODES_H

#include "effect.h"
#include "shot/shot.h"

#include "view/shaders/view_modes.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VIEW_MAX_MODES 64

typedef struct view_mode_row {
    const char *name; /* one word, for scripts */
    const char *title;
    const char *help;
    uint32_t shader; /* (no view) mode of view.frag */
    /* Of an effect: */
    const tool_effect *effect; /* NULL: none */
    uint32_t effect_index;
    const tool_layer *layer; /* its layer, or */
    const tool_view *view;   /* one of its views */
} view_mode_row;

/* The mode with an index; NULL after the last. The first is the picture. */
const view_mode_row *view_mode(uint32_t mode);

/* The index of a name; view_mode_count() if there is none. */
uint32_t view_mode_find(const char *name);
uint32_t view_mode_count(void);

/* Number of items of a mode (layers, maps, panes) in this shot. 0: the mode shows nothing here. */
uint32_t view_mode_items(const shot *s, uint32_t mode);

/* Text of the control that selects an item, with %d for its number. */
void view_mode_print_item(const shot *s, uint32_t mode, uint32_t item, char *text, size_t size);

/* The legend of a mode: sets a color and returns its meaning. NULL after the last. */
const char *view_mode_legend(uint32_t mode, uint32_t index, float color[3]);

#ifdef __cplusplus
}
#endif
#endif
