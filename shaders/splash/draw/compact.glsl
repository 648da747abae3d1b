// compact.glsl - where splash's passes keep what they pick, see gpu/compact_buffers.glsl.
//
// Slots of sprites are droplets that are lines, all other droplets, then their piles, then splashes, each as many as
// the workgroups over them have invocations; slots of sheets are splashes again, behind. A list of sprites, then one of
// sheets.
#define COMPACT_GROUP VIRGA_SPLASH_GROUP
#define COMPACT_PICKS_BINDING 10
#define COMPACT_LIST_BINDING 11
#define COMPACT_LISTS 2
#define SPRITES 0u
#define SHEETS 1u
