// workgroups.glsl - the number of a workgroup in passes over cells.

// Of passes over cells: a device may take no more than 65,535 workgroups in a row, so they come in rows.
uint group_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
