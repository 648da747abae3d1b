// compact.glsl - bindings of ordered compaction in rain, see gpu/compact_buffers.glsl.
#define COMPACT_GROUP VIRGA_RAIN_GROUP
#define COMPACT_SELECTION_BINDING 5
#define COMPACT_LIST_BINDING 16
