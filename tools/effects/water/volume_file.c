/* volume_file.c - the density of the newest step as a volume, for the program's files. */
#include "water_state.h"

#include "volume.h"
#include "water/volume_blocks.h"

#include <string.h>

static bool write(shot *s, void *state, const char *path, char *error, size_t error_size)
{
    const scene_water *from = scene_water_of(s->scene);
    field made;
    if (!water_make_field(s, state, &made, error, error_size))
        return false;
    volume v = field_volume(&made);
    v.surface = from->level;
    memcpy(v.origin_m, from->position_m, sizeof v.origin_m);
    const bool ok = volume_write(path, &v, error, error_size);
    field_destroy(&made);
    return ok;
}

const tool_volume water_density_volume = {
    .name = "water_density",
    .help = "density and velocity of water as OpenVDB (isotropic kernel)",
    .write = write,
};
