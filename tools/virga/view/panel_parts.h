// panel_parts.h - shared by the files of the panel: its parts, and helpers for controls.
#ifndef VIEW_PANEL_PARTS_H
#define VIEW_PANEL_PARTS_H

#include "view/view.h"

#include <imgui.h>

namespace view_panel
{

const ImVec4 COLOR_HINT(0.62f, 0.66f, 0.72f, 1), COLOR_WARN(1.0f, 0.72f, 0.3f, 1), COLOR_GOOD(0.45f, 0.8f, 1.0f, 1);

/* ---- panel_parts.cpp */

/* The tooltip of the newest control. */
void tooltip(const char *text);

/* Begins a part of the panel and returns whether it is open. Scripts open and close parts too. */
bool part(viewer *v, const char *title, bool open);

/* ---- panel_settings.cpp: what is in the scene's schema, as controls */

void edit_setting(viewer *v, scene_setting &s);

/* The settings of the scene, in parts of their own. */
void sections(viewer *v);

/* ---- panel_controls.cpp: the parts that are more than a list */

void part_time(viewer *v);
void part_presets(viewer *v);
void part_weather(viewer *v);
void part_views(viewer *v);
void part_camera(viewer *v);
void part_files(viewer *v);

/* ---- panel_numbers.cpp: what is measured, as graphs and bars */

void part_times(viewer *v);
void part_counts(viewer *v);
void part_water(viewer *v);

} // namespace view_panel

#endif
