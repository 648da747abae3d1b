// compact.glsl - where splash's passes keep what they pick, see gpu/compact_buffers.glsl.
//
// Slots of sprites: droplets, then their piles, then splashes, each as many as the ring's workgroups in use.
#define COMPACT_GROUP VIRGA_SPLASH_GROUP
#define COMPACT_PICKS_BINDING 10
#define COMPACT_LIST_BINDING 11
