// list.glsl - the list of places: those in use first, then the free ones, both in order.
#define COMPACT_GROUP VIRGA_GLASS_GROUP
#define COMPACT_PICKS_BINDING 3
#define COMPACT_LIST_BINDING 4
