/* wrong_words.h - breaks a saved state, for tests that load it. */
#ifndef VIRGA_TESTS_WRONG_WORDS_H
#define VIRGA_TESTS_WRONG_WORDS_H

#include <virga/shared/random.h>
#include <virga/vulkan.h>

enum { STATE_HEADER = 64 }; /* bytes of the head of a state */

/* Values that break what they are used for: indices, counts, floats, signs. */
static inline uint32_t wrong_word(uint32_t old, uint32_t hash)
{
    const uint32_t values[8] = {UINT32_MAX, 0x7fc00000u, 0x7f800000u, 0x80000000u,
                                old + 1,    old - 1,     old << 9,    virga_hash1(hash)};
    return hash >> 3 & 1 ? values[hash & 7] : old ^ 1u << (hash >> 4 & 31);
}

/* Half of them in the first words of a part, where the counts are: after a word that is 0, or a part's end, it goes
 * back to the beginning of what is not 0. */
static inline VkDeviceSize wrong_place(const uint32_t *words, VkDeviceSize count, uint32_t hash)
{
    VkDeviceSize at = STATE_HEADER / 4 + virga_hash1(hash) % (count - STATE_HEADER / 4);
    for (uint32_t i = 0; (hash & 1) && i < 4096 && at > STATE_HEADER / 4 && (words[at - 1] || words[at - 2]); i++)
        at--;
    return at;
}

/* Breaks one to four words of a state; `number` says which, and how. Its hash is wrong then. */
static inline void wrong_words(uint32_t *words, VkDeviceSize bytes, uint32_t number)
{
    for (uint32_t k = 0; k <= virga_hash2(number, 0) % 4; k++) {
        const uint32_t hash = virga_hash2(number, 1 + k);
        const VkDeviceSize at = wrong_place(words, bytes / 4, hash);
        words[at] = wrong_word(words[at], virga_hash1(hash + 1));
    }
}

#endif
