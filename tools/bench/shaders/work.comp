// work.comp - one kind of work of model.h, many times: what a lane of this device takes for it. WORK is the kind.
#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Words { uint words[]; };
// The trips of the loop are no constant, as compilers unroll short loops.
layout(set = 0, binding = 1) readonly buffer Settings { uint trips, settings[7]; };
layout(set = 0, binding = 3) uniform Constants { uvec4 constants[2]; };
layout(set = 0, binding = 2) uniform sampler2D texels;

const uint MASK = 65535u; // 256 KiB: they stay in a cache
shared uint kept[256];

// A trip of each kind. Of what is quick there is so much that the loop around it is little. Values stay finite and
// normal.
#define SUMS                    \
    x = x * 0.5 + y;            \
    y = max(y * 0.25, x - 3.0); \
    x = min(abs(x - 1.0), 8.0); \
    y = y * 0.5 + 0.25 * x;     \
    x = x * 0.75 + y;           \
    y = max(y * 0.5, x - 2.0);  \
    x = min(abs(x - 2.0), 8.0); \
    y = y * 0.5 + 0.125 * x;
#define FUNCTIONS           \
    x = sqrt(x + 1.0);      \
    y = 1.0 / (y + x);      \
    x = inversesqrt(x + y); \
    y = x / (y + 1.0);      \
    x = exp2(-x);           \
    sum *= 3u + i;
#define FOUR(what) what what what what
#if WORK == 1 // arithmetic
#define TRIP FOUR(SUMS) FOUR(SUMS)
#elif WORK == 2 // roots, quotients, a power of two, a product of integers
#define TRIP FOUR(FUNCTIONS)
#elif WORK == 3 // loads and stores
#define TRIP                                        \
    sum += words[(lane + (i << 6)) & MASK];         \
    sum += words[(lane + (i << 8) + sum) & MASK];   \
    sum += words[(lane * 3u + i) & MASK];           \
    words[(lane + i) & MASK] = sum;
#elif WORK == 4 // of workgroup memory
#define TRIP                               \
    sum += kept[(local + i) & 255u];       \
    kept[(local + (i << 6)) & 255u] = sum; \
    sum += kept[(sum + local) & 255u];
#elif WORK == 5 // texels
#define TRIP                                                              \
    x += texelFetch(texels, ivec2((lane + i) & 255u, i & 255u), 0).x;     \
    x += texelFetch(texels, ivec2((lane + i) & 255u, (i + lane) & 255u), 0).y;
#elif WORK == 6 // filtered texels
#define TRIP                                    \
    x += textureLod(texels, vec2(y, x), 0.0).x; \
    y += textureLod(texels, vec2(x, y), 0.0).y;
#elif WORK == 7 // atomics
#define TRIP                                                \
    sum += atomicAdd(words[(lane + (i << 6)) & MASK], 1u);  \
    sum += atomicMax(words[(sum + (i << 6)) & MASK], i);
#elif WORK == 8 // loads that are the same for all lanes
#define TRIP            \
    sum += settings[0]; \
    sum ^= settings[1]; \
    sum += settings[2]; \
    sum ^= settings[3]; \
    sum += settings[4]; \
    sum ^= settings[5];
#elif WORK == 9 // branches: of the loop itself
#define TRIP sum ^= i;
#elif WORK == 10 // barriers
#define TRIP  \
    barrier(); \
    sum ^= i; \
    barrier();
#elif WORK == 11 // loads of a uniform buffer
#define TRIP               \
    sum += constants[0].x; \
    sum ^= constants[0].y; \
    sum += constants[0].z; \
    sum ^= constants[0].w; \
    sum += constants[1].x; \
    sum ^= constants[1].y;
#endif

void main()
{
#if WORK != 0 // else: starts
    const uint lane = gl_GlobalInvocationID.x, local = gl_LocalInvocationID.x;
    float x = 1.0 + float(local) * 0.01, y = x + 0.5;
    uint sum = lane;
    for (uint i = 0; i < trips; i++) {
        TRIP
    }
    words[lane & MASK] = floatBitsToUint(x + y) + sum;
#endif
}
