// flow_average.glsl - what a cell swings by in flow.comp's pairs: in an even sheet each pass moves a round's flow
// out of every
// second cell into its neighbour, and the next pass of that axis moves it on. What cells hold after a pass is up to a
// sixth beside what the sheet has; what they hold in the middle of their last passes is not. So that is what is shown:
// each cell without half of what it gained in the last pass along x and in the last along z.
layout(scalar, set = 0, binding = 20) buffer Swings { uint swings[]; }; // those halves (um), two int16: x, z

uint with_swing(uint packed, bool along_z, int half_um)
{
    return bitfieldInsert(packed, uint(clamp(half_um, -32768, 32767)), along_z ? 16 : 0, 16);
}

int swing_um(uint packed) { return bitfieldExtract(int(packed), 0, 16) + bitfieldExtract(int(packed), 16, 16); }
