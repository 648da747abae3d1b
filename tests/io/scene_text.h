/* scene_text.h - scene files from text: the smallest one, and ways to load a test's text. */
#ifndef VIRGA_TESTS_IO_SCENE_TEXT_H
#define VIRGA_TESTS_IO_SCENE_TEXT_H

#include "check_io.h"

#include <math.h>

#include "effect.h"
#include "scene_file.h"

/* Four lines. */
static const char smallest[] = "virga: 1\n"
                               "camera:\n"
                               "  keys:\n"
                               "    - {position_m: [0, 2, 8], look_at_m: [0, 2, 0]}\n";

static inline void put_text(const char *name, const char *text)
{
    put_file(in_folder(name), text, strlen(text));
}

static inline bool load(const char *text, const char *const *overrides, size_t count, scene_file **scene)
{
    put_text("s.yaml", text);
    return scene_file_load(in_folder("s.yaml"), tool_effect_sections, overrides, count, scene, error, sizeof error);
}

static inline scene_file *loaded(const char *text, const char *const *overrides, size_t count)
{
    scene_file *scene;
    if (!load(text, overrides, count, &scene))
        fail_msg("%s", error);
    return scene;
}

static inline void near(double value, double wanted)
{
    if (!(fabs(value - wanted) <= 1e-12 * fabs(wanted)))
        fail_msg("got %.17g, expected %.17g", value, wanted);
}

#endif
