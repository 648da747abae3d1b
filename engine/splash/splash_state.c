/* splash/splash_state.c - checks a saved state of splashes, see gpu/state_check.h. */
#include "splash/splash_internal.h"

#include "core/settings.h"
#include "gpu/state_check.h"

#include <virga/shared/handed_droplet.h>
#include <virga/shared/impact.h>

/* Workgroups of passes over this many slots, which may begin within a workgroup. */
static double groups_over(double slots)
{
    return slots / VIRGA_SPLASH_GROUP + 1;
}

static void check_groups(const virga_splash *splash, const virga_splash_state_gpu *saved, virga_state_check *check)
{
    const double droplets = groups_over(splash->def.max_droplets), splashes = groups_over(splash->def.max_splashes);
    const double larger = droplets > splashes ? droplets : splashes;
    virga_state_expect_groups(check, "splash.state.droplet_groups", saved->droplet_groups, droplets);
    virga_state_expect_groups(check, "splash.state.splash_groups", saved->splash_groups, splashes);
    virga_state_expect_groups(check, "splash.state.spawn_groups", saved->spawn_groups,
                              groups_over(splash->def.max_spawns));
    virga_state_expect_groups(check, "splash.state.fall_groups", saved->fall_groups, droplets);
    virga_state_expect_groups(check, "splash.state.find_groups", saved->find_groups, larger);
    virga_state_expect_groups(check, "splash.state.find_droplet_groups", saved->find_droplet_groups, droplets);
    virga_state_expect_groups(check, "splash.state.find_splash_groups", saved->find_splash_groups, splashes);
    virga_state_expect_groups(check, "splash.state.sprite_groups", saved->sprite_groups, 3 * droplets + splashes);
    virga_state_expect_groups(check, "splash.state.view_groups", saved->view_groups, droplets);
}

static void check_counts(const virga_splash *splash, const virga_splash_state_gpu *saved, virga_state_check *check)
{
    const double droplets = splash->def.max_droplets, returns = splash->def.max_returned_droplets;
    virga_state_expect(check, "splash.state.end_droplet", saved->end_droplet, 0, droplets);
    virga_state_expect(check, "splash.state.staying", saved->staying, 0, droplets);
    virga_state_expect(check, "splash.state.tick_droplet", saved->tick_droplet, 0, droplets);
    /* Numbers of splashes only grow, modulo 2^32. */
    virga_state_expect(check, "splash.state.end_splash - first_splash",
                       (uint32_t)(saved->end_splash - saved->first_splash), 0, splash->def.max_splashes);
    virga_state_expect(check, "splash.state.returns", saved->returns, 0, returns);
    virga_state_expect(check, "splash.state.returns_before", saved->returns_before, 0, returns);
}

static void check_lists(const virga_splash *splash, virga_state_check *check)
{
    const virga_impacts_gpu *returns = virga_state_saved_buffer(check, splash->returned_droplets);
    const virga_handed_droplets_gpu *handed = virga_state_saved_buffer(check, splash->handed);
    virga_state_expect(check, "splash.returns.count", returns->count, 0, splash->def.max_returned_droplets);
    virga_state_expect_groups(check, "splash.returns.group_count", returns->group_count,
                              groups_over(splash->def.max_returned_droplets));
    if (!handed)
        return;
    virga_state_expect(check, "splash.handed.count", handed->count, 0, splash->def.max_handed);
    virga_state_expect(check, "splash.handed.capacity", handed->capacity, 0, splash->def.max_handed);
    virga_state_expect(check, "splash.handed.drips", handed->drips, 0, 4.0 * splash->def.max_drips);
    virga_state_expect_groups(check, "splash.handed.group_count", handed->group_count,
                              groups_over(splash->def.max_handed));
}

void splash_check_state(const void *object, virga_state_check *check)
{
    const virga_splash *splash = object;
    const virga_splash_state_gpu *saved = virga_state_saved_buffer(check, splash->state);
    const double *anchor_m = VIRGA_STATE_SAVED(check, splash->anchor_m);
    for (uint32_t axis = 0; axis < 3; axis++)
        virga_state_expect(check, "splash.anchor_m", anchor_m[axis], -2 * VIRGA_MAX_COORDINATE_M,
                           2 * VIRGA_MAX_COORDINATE_M);
    virga_state_expect(check, "splash.current", VIRGA_STATE_SAVED(check, splash->current), 0, 1);
    virga_state_expect(check, "splash.ticks", (double)VIRGA_STATE_SAVED(check, splash->ticks), 0,
                       VIRGA_STATE_MAX_TICKS);
    check_counts(splash, saved, check);
    check_groups(splash, saved, check);
    check_lists(splash, check);
}
