// compact.glsl - bindings of ordered compaction in splash, see gpu/compact_buffers.glsl.
//
// Slots of sprites: droplets that are lines, all other droplets, their piles, splashes; each as many as the workgroups
// over them have invocations. Then slots of sheets: the splashes again. The first list has the sprites, the second the
// sheets.
#define COMPACT_GROUP VIRGA_SPLASH_GROUP
#define COMPACT_SELECTION_BINDING 10
#define COMPACT_LIST_BINDING 11
#define COMPACT_LISTS 2
#define SPRITES 0u
#define SHEETS 1u
