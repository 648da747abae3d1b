/* shared/random.h - random numbers by counter, the same bits in C and in GLSL.
 *
 * There is no state: a random number is a hash of what it is for (seed, stream, id, step), so the order in which
 * invocations run can not change it. The mixing is triple32 of Chris Wellons's Hash Prospector (2018), a search for
 * multiply-xorshift hashes with the least avalanche bias. Its cheaper sibling lowbias32, with two multiplications, is
 * visibly uneven over consecutive counters (chi-square over 1,024 cells five deviations off after a million draws).
 * Words are absorbed one by one, each with the state added before the mixing and, multiplied, again inside it: were
 * it added once only, streams whose states happen to lie close together would be copies of each other, shifted by a
 * few steps.
 *
 * Give the word that changes fastest (step, index) last; virga_hash4 costs four mixings. */
#ifndef VIRGA_SHARED_RANDOM_H
#define VIRGA_SHARED_RANDOM_H

#include "types.h"

#ifdef VIRGA_GLSL
#define VIRGA_RANDOM_FN
#else
#define uint            virga_uint
#define VIRGA_RANDOM_FN static inline
#endif

/* Takes one more word into a hash. */
VIRGA_RANDOM_FN uint virga_hash_absorb(uint state, uint word)
{
    uint x = word + state;
    x ^= x >> 17;
    x *= 0xed5ad4bbu;
    x += state * 0x9e3779b1u;
    x ^= x >> 11;
    x *= 0xac4c1b51u;
    x ^= x >> 15;
    x *= 0x31848babu;
    x ^= x >> 14;
    return x;
}

/* Starts from the fractional part of the golden ratio, so that hashes of zeros are not zero. */
VIRGA_RANDOM_FN uint virga_hash1(uint a)
{
    return virga_hash_absorb(0x9e3779b9u, a);
}

VIRGA_RANDOM_FN uint virga_hash2(uint a, uint b)
{
    return virga_hash_absorb(virga_hash1(a), b);
}

VIRGA_RANDOM_FN uint virga_hash3(uint a, uint b, uint c)
{
    return virga_hash_absorb(virga_hash2(a, b), c);
}

VIRGA_RANDOM_FN uint virga_hash4(uint a, uint b, uint c, uint d)
{
    return virga_hash_absorb(virga_hash3(a, b, c), d);
}

/* A number in [0; 1) from the upper 24 bits: all that a float holds, so it is exact and never rounds up to 1. */
VIRGA_RANDOM_FN float virga_unit(uint hash)
{
#ifdef VIRGA_GLSL
    return float(hash >> 8u) * (1.0 / 16777216.0);
#else
    return (float)(hash >> 8u) * (1.0f / 16777216.0f);
#endif
}

#undef VIRGA_RANDOM_FN
#ifndef VIRGA_GLSL
#undef uint
#endif

#endif
