// live_list.glsl - the list of places: those in use first, then the free ones, both in order. Only as far as
// workgroups go
// that have any in use: of the free ones beyond a tick lists those that it takes (spawn_scan.comp).
#define COMPACT_GROUP VIRGA_GLASS_GROUP
#define COMPACT_PICKS_BINDING 3
#define COMPACT_LIST_BINDING 4
