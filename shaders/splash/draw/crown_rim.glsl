// crown_rim.glsl - the rim of a crown: its height around the crown, as a factor of the crown's height.
#define CROWN_REACH 1.38 // factor of the highest finger
#define CROWN_BEAD 0.32  // thickness of the rim in drop diameters: surface tension forms a bead at an edge

// The height, and its change with the angle. Fingers rise out of the rim and have round ends. Without fingers the rim
// is level.
vec2 rim_height(float finger_angle, float slow_angle, float fingers)
{
    if (fingers <= 0.0)
        return vec2(1.0, 0.0);
    const float wave = 0.5 + 0.5 * cos(finger_angle), slow = sin(slow_angle), tall = 0.3 + 0.1 * slow;
    const float gains = -fingers * wave * sin(finger_angle) * tall + 2.0 * cos(slow_angle) * (0.1 + 0.1 * wave * wave);
    return vec2(0.88 + 0.1 * slow + tall * wave * wave, gains);
}
