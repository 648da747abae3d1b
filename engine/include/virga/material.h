/* virga/material.h - numbers of surface materials. Needs no Vulkan.
 *
 * They are used in virga_occluder.material, in impacts, in the ground's table (what water does on a material) and in
 * the splash table (what drops do on a material). */
#ifndef VIRGA_MATERIAL_H
#define VIRGA_MATERIAL_H

#ifdef __cplusplus
extern "C" {
#endif

/* Materials for which ground and splash have defaults. A host may change all of them, or use the free numbers. */
typedef enum virga_material {
    VIRGA_MATERIAL_DEFAULT = 0, /* as concrete */
    VIRGA_MATERIAL_ASPHALT = 1,
    VIRGA_MATERIAL_CONCRETE = 2,
    VIRGA_MATERIAL_STONE = 3,
    VIRGA_MATERIAL_BRICK = 4,
    VIRGA_MATERIAL_GRASS = 5,
    VIRGA_MATERIAL_SAND = 6,
    VIRGA_MATERIAL_SOIL = 7,
    VIRGA_MATERIAL_WOOD = 8,
    VIRGA_MATERIAL_STEEL = 9, /* the griddle of the paper */
    VIRGA_MATERIAL_GLASS = 10,
    VIRGA_MATERIAL_WATER = 11,
    VIRGA_MATERIAL_LEAVES = 12,
    VIRGA_MATERIAL_CLOTH = 13,
    VIRGA_MATERIAL_PLASTIC = 14,
    VIRGA_MATERIAL_TILE = 15,
    VIRGA_MATERIAL_DRAIN = 16,
    VIRGA_MATERIAL_CUSTOM = 17 /* first free number: from here to VIRGA_GROUND_MATERIALS - 1 they are the host's */
} virga_material;

#ifdef __cplusplus
}
#endif
#endif
