/* shared/random.h - counter-based random numbers, the same bits in C and in GLSL.
 *
 * There is no state. A random number is a hash of its purpose (seed, stream, id, step), so the order in which
 * invocations run cannot change it. The mixing function is triple32 of Chris Wellons's Hash Prospector (2018), a search
 * for multiply-xorshift hashes with the least avalanche bias. The cheaper lowbias32, with two multiplications, is
 * visibly uneven over consecutive counters: chi-square over 1,024 cells is five standard deviations off after a million
 * draws.
 *
 * Words are absorbed one by one. The state is added to each word before the mixing and, multiplied, again inside it.
 * With the first addition only, streams with nearly equal states would be copies of each other, shifted by a few steps.
 *
 * Pass the word that changes fastest (step, index) last. virga_hash4 costs four mixings. */
#ifndef VIRGA_SHARED_RANDOM_H
#define VIRGA_SHARED_RANDOM_H

#include "types.h"

#ifdef VIRGA_GLSL
#define VIRGA_RANDOM_FN
#else
#define uint            virga_uint
#define VIRGA_RANDOM_FN static inline
#endif

/* Absorbs one more word into a hash. */
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

/* Starts with the fractional part of the golden ratio, so that hashes of zeros are not zero. */
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

/* A number in [0; 1) from the upper 24 bits. A float holds exactly that many, so the result is exact and never rounds
 * up to 1. */
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
