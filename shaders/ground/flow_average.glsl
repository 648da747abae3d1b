// flow_average.glsl - removes the oscillation of flow.comp's pairs from the depth that is shown. In an even sheet each
// pass moves a round's flow from every second cell to its neighbour, and the next pass along that axis moves it on.
// After a pass, cells deviate from the sheet by up to a sixth; in the middle of their last passes they do not. So the
// depth shown is that without half of what the cell gained in its last pass along x and in its last along z.
layout(scalar, set = 0, binding = 20) buffer Swings { uint swings[]; }; // these halves (um) as two int16: x, z

uint with_swing(uint packed, bool along_z, int half_um)
{
    return bitfieldInsert(packed, uint(clamp(half_um, -32768, 32767)), along_z ? 16 : 0, 16);
}

int swing_um(uint packed) { return bitfieldExtract(int(packed), 0, 16) + bitfieldExtract(int(packed), 16, 16); }
