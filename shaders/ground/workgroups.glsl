// workgroups.glsl - number of the workgroup in passes over cells.

// A device may allow no more than 65,535 workgroups in x, so passes over cells are dispatched in rows.
uint group_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
