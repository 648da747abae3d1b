/* ground/ground.h - the part of the ground that a scene uses besides its public functions. Internal. */
#ifndef VIRGA_GROUND_GROUND_H
#define VIRGA_GROUND_GROUND_H

#include "gpu/effect.h"

#include <virga/ground.h>

extern const virga_effect_type ground_type;

/* Refuses wheels and feet with a line in the log, as a step does. */
virga_result ground_check_wheels_and_feet(const virga_log *log, const virga_wheel *wheels, uint32_t wheel_count,
                                          const virga_foot *feet, uint32_t foot_count);

#endif
