// tiles.glsl - the parts of the picture that water is drawn in, see contact_tiles.comp.
//
// A tile is a word: column, row, and its side in tiles (12, 12 and 8 bits). First those that are drawn without contact
// lines, then those with them.
#ifndef TILES_ACCESS
#define TILES_ACCESS readonly
#endif
layout(scalar, set = 0, binding = 32) TILES_ACCESS buffer Tiles
{
    virga_water_tiles_gpu tiles;
    uint tile_words[];
};

uvec2 tile_count() { return (uvec2(look.width, look.height) + VIRGA_WATER_TILE_PX - 1) / VIRGA_WATER_TILE_PX; }

// Index of the first word of tiles with contact lines.
uint first_contact_tile() { return tile_count().x * tile_count().y; }

#define TILE_CORNERS 6  // of two triangles
#define FIRST_CORNER 3u // the vertices before it are of the triangle over all of the view
