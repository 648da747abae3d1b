/* gpu/effect_targets.h - an effect's pipelines for the classes of targets. Internal. */
#ifndef VIRGA_GPU_EFFECT_TARGETS_H
#define VIRGA_GPU_EFFECT_TARGETS_H

#include "gpu/effect_type.h"
#include "gpu/target.h"

/* Creates the pipelines of an effect for the class of a target, unless it has them. */
virga_result virga_effect_attach(virga_effect *effect, const char *call, const virga_target *target);

/* Creates the pipelines that other settings want, for all targets. On failure, those that were created stay. */
virga_result virga_effect_want_draws(virga_effect *effect, const void *settings);

/* The pipelines for a class; NULL: there are none. */
virga_effect_target *virga_effect_target_of(const virga_effect *effect, const virga_target_class *class_of);

/* Whether any target has motion vectors. */
bool virga_effect_wants_motion(const virga_effect *effect);

/* Releases the pipelines of all targets. */
void virga_effect_retire_targets(virga_effect *effect);

/* For all effects of a context: releases pipelines whose targets are all destroyed. Not before the next frame, so that
 * a host may destroy its targets before it creates compatible ones. */
void virga_effects_free_targets(virga_context *context);

/* A target is being destroyed, and then its render pass. Pipelines that are still to be built for it are created again
 * for another target of its class, if there is one. */
void virga_effects_forget_target(const virga_target *target);

#endif
