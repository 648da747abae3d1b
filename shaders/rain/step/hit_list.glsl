// hit_list.glsl - buffers for drops that hit a pane: impacts, with positions on the pane.
layout(scalar, set = 0, binding = 18) buffer Hits
{
    virga_impacts_gpu hit_head;
    virga_impact_gpu hits[VIRGA_RAIN_MAX_HITS];
};
layout(scalar, set = 0, binding = 19) buffer HitOffsets
{
    uint hit_offsets[]; // per entry of the slot list: its number of hits, then the index of its first
};
