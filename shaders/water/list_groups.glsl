// list_groups.glsl - dispatches over a list of cells, with a workgroup for each entry.
#define LIST_COLUMNS 32768u // workgroups on the first axis: devices allow no more than 65,535

// The entry that a workgroup works on. It may be past the end.
uint list_item() { return gl_WorkGroupID.y * LIST_COLUMNS + gl_WorkGroupID.x; }

uint[3] list_groups(uint count)
{
    return uint[3](min(count, LIST_COLUMNS), (count + LIST_COLUMNS - 1u) / LIST_COLUMNS, 1u);
}
