// compact_crowns.glsl - the same for crowns, whose slots are splashes.
#define COMPACT_GROUP VIRGA_SPLASH_GROUP
#define COMPACT_PICKS_BINDING 12
#define COMPACT_LIST_BINDING 13
