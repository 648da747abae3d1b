// live_list.glsl - buffers of the live list: the slots in use first, then free ones, both in order. It covers only
// workgroups that have a slot in use; spawn_scan.comp appends the free slots beyond them that a tick needs.
#define COMPACT_GROUP VIRGA_GLASS_GROUP
#define COMPACT_SELECTION_BINDING 3
#define COMPACT_LIST_BINDING 4
