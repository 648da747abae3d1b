// stream.glsl - waves on water that runs: of what length and height, by the water's own depth and speed.
//
// What is known of shallow streams over a rough bed (Dolcetti et al. 2016, Frequency-wavenumber spectrum of the free
// surface of shallow turbulent flows over a rough boundary, Phys. Fluids 28, 105105): where the surface runs faster
// than the slowest waves, most of its waves stand still over the stones that make them, and waves of about that length
// go out to all sides and are carried along (here: a third). Slower water shows the turbulence below, as bumps that it
// carries along.
//
// The surface is u fast, and waves of number k on depth h go c(k) = omega / k in it:
//
//     omega^2 = (g k + sigma k^3 / rho) tanh(k h)
//
// Stones. Over a bed of heights b cos(k x) steady water has the surface eta (Lamb 1932, Hydrodynamics, par. 246, with
// surface tension, and with u the component along x)
//
//     eta / b = 1 / (cosh(k h) D),   D = 1 - c^2 / u^2
//
// It is large where c = u. Damping gamma (1/s, see ring_table.h) limits it: D = 0 becomes 2 i gamma / omega. A bed has
// waves in all directions phi: the component is u cos(phi). Near the angle of resonance, cos(phi0) = c / u, D changes
// by -2 tan(phi0) for each radian, and there is one such angle on each side of the stream:
//
//     int |D|^-2 dphi = pi omega / (2 gamma tan(phi0))
//
// so that the octave around k, k^2 ln 2 wide, of a bed of spectrum S (m^4) has a surface of the variance
//
//     k^2 ln 2 S / cosh^2(k h) pi omega / (2 gamma tan(phi0))
//
// tan(phi0) is at least a third, as it is in the mean over the octave that begins at c = u. Stones as wide as they are
// thick, k_s, are uncorrelated beyond that: S = b^2 k_s^2 / (4 pi) exp(-k^2 k_s^2 / 4), of standard deviation
// b = k_s / 4.43 (Flack and Schultz 2010, Review of hydraulic roughness scales in the fully rough regime). Manning's n
// of the material gives k_s = (21.1 n)^6 m (Strickler 1923).
//
// Turbulence. Its pressure is about that of the shear on the bed, rho g h S (S: the slope of the stream), and lifts the
// surface by h S. The eddies are four to six times as long as the water is deep (Nezu and Nakagawa 1993, Turbulence in
// open-channel flows). S is that of Manning's formula, n^2 v^2 / h^(4/3).
const float STREAM_WAVES_M[VIRGA_STREAM_OCTAVES] = float[VIRGA_STREAM_OCTAVES](VIRGA_STREAM_WAVE_LIST);
#define STREAM_GRAVITY   9.80665
#define STREAM_TENSION   7.293e-5 // sigma / rho, m^3/s^2
#define STREAM_VISCOSITY 1.004e-6 // m^2/s
#define STREAM_EDDY      5.0      // its length, in depths
#define STREAM_LEAST_M   2e-4     // what is shallower is a film that follows the stones
// A wave does not lift the surface by more than a quarter of the depth, nor is it steeper than this: the highest ones
// are then near to breaking.
#define STREAM_OF_DEPTH 0.25
#define STREAM_STEEPEST 0.2

#define STREAM_STANDING 0.667 // share of the stones' variance that stands still

struct StreamWave {
    float standing_m; // standard deviation of what stands still
    float height_m;   // and of what is carried along
    float turn_rad_s; // of that, for one who goes with the water; 0: it is carried along as it is
};

float stream_number(int octave) { return 6.28318531 / STREAM_WAVES_M[octave]; }

// tanh and the like of large numbers overflow.
float stream_deep(float k, float h) { return min(k * h, 20.0); }

float stream_omega(float k, float h)
{
    return sqrt((STREAM_GRAVITY * k + STREAM_TENSION * k * k * k) * tanh(stream_deep(k, h)));
}

// Variance of the surface over stones, of the octave around k.
float stream_of_stones(float k, float h, float surface_m_s, float manning)
{
    const float omega = stream_omega(k, h), c = omega / k, ratio = surface_m_s / c;
    const float bed_m = pow(21.1 * manning, 6.0), stones_m = bed_m / 4.43;
    const float bed = stones_m * bed_m * stones_m * bed_m / 12.5663706 * exp(-0.25 * k * k * bed_m * bed_m);
    const float gamma = 2.0 * STREAM_VISCOSITY * k * k +
                        sqrt(0.5 * STREAM_VISCOSITY * omega) * k / sinh(2.0 * stream_deep(k, h));
    const float tangent = sqrt(max(ratio * ratio - 1.0, 0.111));
    const float felt = 1.0 / cosh(stream_deep(k, h));
    const float variance = 0.69314718 * k * k * bed * felt * felt * 1.57079633 * omega / (gamma * tangent);
    return variance * smoothstep(1.0, 1.2, ratio);
}

// Variance of the surface over turbulence, of the octave around k: one of eddies' length has all of it, one that is
// half or twice as long none.
float stream_of_eddies(float k, float h, float mean_m_s, float manning)
{
    const float slope = manning * manning * mean_m_s * mean_m_s / (h * pow(h, 1.0 / 3.0));
    const float octaves = abs(log2(6.28318531 / (k * STREAM_EDDY * h)));
    return h * h * slope * slope * max(1.0 - octaves, 0.0);
}

// The waves of an octave on water that runs `mean_m_s` fast, `h` (m) deep.
StreamWave stream_wave(int octave, float h, float mean_m_s, float manning)
{
    const float k = stream_number(octave), surface_m_s = mean_m_s / MEAN_SHARE;
    if (h < STREAM_LEAST_M)
        return StreamWave(0.0, 0.0, 0.0);
    const float omega = stream_omega(k, h), ratio = surface_m_s * k / omega;
    const float stones = stream_of_stones(k, h, surface_m_s, manning);
    const float eddies = stream_of_eddies(k, h, mean_m_s, manning);
    const float most = min(STREAM_OF_DEPTH * h, STREAM_STEEPEST / k) / sqrt(float(VIRGA_STREAM_OCTAVES));
    const float less = min(most / max(sqrt(stones + eddies), 1e-9), 1.0);
    return StreamWave(less * sqrt(STREAM_STANDING * stones), less * sqrt((1.0 - STREAM_STANDING) * stones + eddies),
                      omega * smoothstep(0.8, 1.2, ratio));
}
