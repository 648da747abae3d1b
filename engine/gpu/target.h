/* gpu/target.h - the target of draws, and graphics pipelines for it. Internal. */
#ifndef VIRGA_GPU_TARGET_H
#define VIRGA_GPU_TARGET_H

#include "gpu/pipelines.h"

/* Targets whose pipelines are the same. It exists as long as a target or an effect's pipelines belong to it. */
typedef struct virga_target_class {
    struct virga_target_class *next; /* of the context */
    uint32_t serial;                 /* no other class of the context has or had it */
    virga_target_def like;           /* of any of its targets; two with all bytes equal are of one class */
    uint32_t targets, users;         /* targets, and effects that have pipelines for them */
} virga_target_class;

struct virga_target {
    virga_context *context;
    virga_target_def def;
    virga_target_class *class_of;
    virga_target *next_target; /* of the context */
};

/* A new target joins the class of its definition, which is created if it is the first. */
virga_result virga_target_class_join(virga_context *context, virga_target *target);

/* An effect has, or no longer has, pipelines for a class. */
void virga_target_class_use(virga_target_class *class_of);
void virga_target_class_leave(virga_context *context, virga_target_class *class_of);

/* The outputs of a target besides the colour. */
virga_target_outputs virga_target_outputs_of(const virga_target *target);

/* Creates a graphics pipeline for a target. The target determines some members of `def`, which are filled first. */
virga_result virga_target_pipeline(const virga_target *target, virga_graphics_def def, virga_pipeline **pipeline);

#endif
