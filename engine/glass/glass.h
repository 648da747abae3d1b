/* glass/glass.h - declares what a scene uses of this effect, in addition to its public functions. Internal. */
#ifndef VIRGA_GLASS_GLASS_H
#define VIRGA_GLASS_GLASS_H

#include "gpu/effect.h"

#include <virga/glass.h>

extern const virga_effect_type glass_type;

/* Panes that show the same picture share its copies: what is known of them between the prepares of one call. All 0 at
 * first. The picture must not change, and no pane may be prepared otherwise, before the last of them is prepared. */
typedef struct glass_plate {
    const virga_glass *owner; /* the pane whose copies were made; NULL: none yet */
    VkImageView copies;
} glass_plate;

/* virga_glass_prepare_view with the copies of `plate` where they can be used. Else the pane makes its own, and `plate`
 * becomes these. */
virga_result glass_prepare_sharing(virga_glass *glass, VkCommandBuffer cmd, const virga_view *view,
                                   const virga_glass_pose *pose, double time_s, glass_plate *plate,
                                   virga_prepared *prepared);

virga_result glass_pose_check(const virga_log *log, const virga_glass_pose *pose);

#endif
