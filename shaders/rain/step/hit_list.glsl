// hit_list.glsl - where drops that met a pane are written: as impacts, with places on the pane.
layout(scalar, set = 0, binding = 18) buffer Hits
{
    virga_impacts_gpu hit_head;
    virga_impact_gpu hits[VIRGA_RAIN_MAX_HITS];
};
layout(scalar, set = 0, binding = 19) buffer HitPlaces
{
    uint hit_places[]; // by entry of the list of slots: how many it has, then where they go
};
