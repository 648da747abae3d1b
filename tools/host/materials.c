/* materials.c - names of materials, and keywords that guess them. */
#include "materials.h"

#include <ctype.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

static const char *const names[] = {"default", "asphalt", "concrete", "stone", "brick", "grass",
                                    "sand",    "soil",    "wood",     "metal", "glass", "water",
                                    "leaves",  "cloth",   "plastic",  "tile",  "drain"};

/* The first one that matches counts: "grass-road" is grass. */
static const struct {
    const char *keyword;
    uint32_t material;
} keywords[] = {
    {"asphalt", 1},  {"tarmac", 1},   {"grass", 5},   {"lawn", 5},   {"sand", 6},    {"gravel", 6},  {"soil", 7},
    {"dirt", 7},     {"earth", 7},    {"mud", 7},     {"cobble", 3}, {"stone", 3},   {"rock", 3},    {"granite", 3},
    {"brick", 4},    {"window", 10},  {"glass", 10},  {"water", 11}, {"puddle", 11}, {"leaf", 12},   {"leaves", 12},
    {"foliage", 12}, {"tree", 12},    {"arbor", 12},  {"bush", 12},  {"cloth", 13},  {"fabric", 13}, {"awning", 13},
    {"canvas", 13},  {"plastic", 14}, {"rubber", 14}, {"tire", 14},  {"wood", 8},    {"bark", 8},    {"plank", 8},
    {"metal", 9},    {"steel", 9},    {"iron", 9},    {"lamp", 9},   {"truck", 9},   {"pylon", 9},   {"concrete", 2},
    {"pavement", 2}, {"sidewalk", 2}, {"curb", 2},    {"kerb", 2},   {"plaster", 2}, {"wall", 2},    {"barr", 2},
    {"building", 2}, {"house", 2},    {"roof", 2},    {"bridge", 2}, {"road", 1},    {"street", 1},  {"tile", 15},
    {"gully", 16},   {"drain", 16},
};

static bool contains(const char *text, const char *part)
{
    for (; *text; text++) {
        size_t i = 0;
        while (part[i] && tolower((unsigned char)text[i]) == part[i])
            i++;
        if (!part[i])
            return true;
    }
    return false;
}

uint32_t host_guess_material(const char *name)
{
    for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++)
        if (contains(name, keywords[i].keyword))
            return keywords[i].material;
    return 0;
}

bool host_material_find(const char *name, uint32_t *material)
{
    for (uint32_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!strcmp(names[i], name)) {
            *material = i;
            return true;
        }
    return false;
}

bool host_name_contains(const char *name, const char *part)
{
    return contains(name, part);
}

bool host_is_ground(const char *name, uint32_t material)
{
    static const char *const not_ground[] = {
        "house", "building", "church", "wall",   "roof",    "window", "door",    "shutter", "car",     "truck", "bin",
        "lamp",  "lantern",  "bench",  "crate",  "bollard", "bar",    "balcony", "tree_",   "pole",    "pylon", "tire",
        "fence", "sign",     "box",    "awning", "poutre",  "border", "person",  "bicycle", "umbrella"};
    if (material >= 10 && material <= 14) /* glass, water, leaves, cloth and plastic */
        return false;
    for (size_t i = 0; i < sizeof not_ground / sizeof *not_ground; i++)
        if (contains(name, not_ground[i]))
            return contains(name, "pit"); /* the pit around a tree is ground */
    return true;
}

const char *host_material_name(uint32_t material)
{
    return material < sizeof names / sizeof *names ? names[material] : names[0];
}
