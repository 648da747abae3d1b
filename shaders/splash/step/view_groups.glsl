// view_groups.glsl - the sizes of the passes of a view over `droplets` droplets in the air.
#define FEW_GROUPS 8u // up to this many workgroups, one dispatch marks both droplets and splashes

void set_view_groups(uint droplets)
{
    state.view_groups = ring_groups(0u, droplets);
    state.sprite_groups = uint[3](3u * state.view_groups[0] + state.splash_groups[0], 1u, 1u);
    const uint max_groups = max(state.view_groups[0], state.splash_groups[0]);
    const bool both = max_groups <= FEW_GROUPS;
    state.find_groups = uint[3](both ? max_groups : 0u, 1u, 1u);
    state.find_droplet_groups = uint[3](both ? 0u : state.view_groups[0], 1u, 1u);
    state.find_splash_groups = uint[3](both ? 0u : state.splash_groups[0], 1u, 1u);
}
