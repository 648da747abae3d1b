/* glass/glass.h - declares what a scene uses of this effect, in addition to its public functions. Internal. */
#ifndef VIRGA_GLASS_GLASS_H
#define VIRGA_GLASS_GLASS_H

#include "gpu/effect.h"

#include <virga/glass.h>

extern const virga_effect_type glass_type;

virga_result glass_pose_check(const virga_log *log, const virga_glass_pose *pose);

#endif
