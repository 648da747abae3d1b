// crown_rim.glsl - the rim of a crown: how high it is where, of the crown's height.
#define CROWN_REACH 1.38 // that of the highest finger
#define CROWN_BEAD 0.32  // how thick it is: water draws itself together at an edge, to a bead, of the drop's diameter

// Height, and what it gains with the angle. Fingers are drawn out of the rim, and are round at their ends. Without any
// the rim is level.
vec2 crown_rim(float finger_angle, float slow_angle, float fingers)
{
    if (fingers <= 0.0)
        return vec2(1.0, 0.0);
    const float wave = 0.5 + 0.5 * cos(finger_angle), slow = sin(slow_angle), tall = 0.3 + 0.1 * slow;
    const float gains = -fingers * wave * sin(finger_angle) * tall +
                        2.0 * cos(slow_angle) * (0.1 + 0.1 * wave * wave);
    return vec2(0.88 + 0.1 * slow + tall * wave * wave, gains);
}
