/* test_model.c - model files as they come: broken ones give one clear line, incomplete ones are repaired. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "plate_fixture.h"
#include "texture.h"

static char folder[] = "/tmp/virga-model-XXXXXX";

static const char *write_file(const char *name, const char *text)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    return path;
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    *state = f;
    if (!fixture_begin(f)) {
        fprintf(stderr, "no device to load onto: %s\n", f->error);
        exit(77);
    }
    return mkdtemp(folder) ? 0 : -1;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    uint32_t wrong = fixture_end(f);
    free(f);
    static const char *const names[] = {"plain.obj",   "hurt.gltf",   "empty.obj",  "text.glb",
                                        "picture.obj", "picture.mtl", "lamps.gltf", "lamps.glb",
                                        "plane.obj",   "ridge.obj",   "feet.obj"};
    char path[256];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        unlink(path);
    }
    rmdir(folder);
    return wrong ? -1 : 0;
}

/* A triangle whose third point has a NaN. */
static const char hurt_triangle[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes"
    "\":[{\"mesh\":0,\"name\":\"n\"}],\""
    "meshes\":[{\"name\":\"hurt\",\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{\"bufferVie"
    "w\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],\"bufferViews\":["
    "{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;"
    "base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAwH8AAAAA\"}]}";

static void refuses(fixture *f, const char *path, const char *expected)
{
    host_mesh mesh;
    f->error[0] = 0;
    if (host_mesh_load(&f->device, path, NULL, &mesh, f->error, sizeof f->error))
        fail_msg("%s was loaded", path);
    if (!strstr(f->error, expected) || !strstr(f->error, path))
        fail_msg("\"%s\" does not name %s and say \"%s\"", f->error, path, expected);
    assert_null(strchr(f->error, '\n'));
}

static void bad_files(void **state)
{
    fixture *f = *state;
    refuses(f, "/nowhere/model.glb", "no such model file");
    refuses(f, folder, "no such model file");
    refuses(f, write_file("text.glb", "this is no model"), "cannot be read as a model");
    refuses(f, write_file("empty.obj", "v 0 0 0\nv 1 0 0\n"), "");
    refuses(f, write_file("hurt.gltf", hurt_triangle), "position of vertex 2 is not a finite number");
}

/* No normals, no uvs, no material. */
static void plain_triangle(void **state)
{
    fixture *f = *state;
    host_mesh mesh;
    const char *path = write_file("plain.obj", "o asphalt_lane\nv 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n");
    const float up_by_two[12] = {1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1, 0};
    assert_true(host_mesh_load(&f->device, path, up_by_two, &mesh, f->error, sizeof f->error));
    assert_int_equal(mesh.primitive_count, 1);
    assert_int_equal(mesh.index_count, 3);
    assert_float_equal(mesh.low[1], 2.0, 1e-6);
    assert_float_equal(mesh.high[0], 1.0, 1e-6);
    assert_string_equal(host_material_name(mesh.primitives[0].surface), "asphalt");

    virga_occluder occluder;
    assert_int_equal(host_mesh_occluders(&mesh, &occluder, 1), 1);
    assert_int_equal(occluder.index_count, 3);
    assert_int_equal(occluder.vertex_stride, sizeof(host_vertex));
    assert_int_equal(occluder.material, 1);
    assert_float_equal(occluder.cover, 1.0, 0.0);
    host_mesh_destroy(&f->device, &mesh);
}

/* A binary glTF file: the JSON, filled up with spaces to four bytes, and the points of a triangle. */
static const char *write_glb(const char *name, const char *json)
{
    static const float points[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t length = (uint32_t)strlen(json), size = (length + 3) / 4 * 4;
    const uint32_t head[5] = {0x46546c67, 2, 28 + size + sizeof points, size, 0x4e4f534a},
                   chunk[2] = {sizeof points, 0x4e4942};
    const char *path = write_file(name, "");
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fwrite(head, sizeof head, 1, file);
    fprintf(file, "%s%.*s", json, (int)(size - length), "   ");
    fwrite(chunk, sizeof chunk, 1, file);
    fwrite(points, sizeof points, 1, file);
    assert_int_equal(fclose(file), 0);
    return path;
}

/* Lamps: a triangle each, with the materials in `materials`; lamp i has material order[i]. */
static const char *write_lamps(const char *materials, const int order[3], bool binary)
{
    static char json[4096];
    char primitives[1024] = "";
    for (int i = 0; i < 3; i++)
        snprintf(primitives + strlen(primitives), sizeof primitives - strlen(primitives),
                 "%s{\"attributes\":{\"POSITION\":0},\"material\":%d}", i ? "," : "", order[i]);
    const char *buffer = binary ? ""
                                : ",\"uri\":\"data:application/octet-stream;base64,"
                                  "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"";
    const int length =
        snprintf(json, sizeof json,
                 "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
                 "\"extensionsUsed\":[\"KHR_materials_emissive_strength\"],\"meshes\":[{\"primitives\":[%s]}],"
                 "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":"
                 "[0,0,0],\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{"
                 "\"byteLength\":36%s}],\"materials\":[%s]}",
                 primitives, buffer, materials);
    assert_true(length > 0 && length < (int)sizeof json - 4);
    return binary ? write_glb("lamps.glb", json) : write_file("lamps.gltf", json);
}

#define LAMP(name, factor, strength)                                                               \
    "{" name "\"emissiveFactor\":" factor ",\"extensions\":{\"KHR_materials_emissive_strength\":{" \
    "\"emissiveStrength\":" strength "}}}"

/* Loads lamps and returns their radiance, times that of a lamp with the same factor and no strength. */
static void load_lamps(fixture *f, const char *materials, const int order[3], bool binary, float times[3])
{
    static const float factor[3] = {1.0f, 0.5f, 0.1f};
    host_mesh mesh;
    f->warning[0] = 0;
    if (!host_mesh_load(&f->device, write_lamps(materials, order, binary), NULL, &mesh, f->error, sizeof f->error))
        fail_msg("%s", f->error);
    assert_int_equal(mesh.primitive_count, 3);
    for (int i = 0; i < 3; i++) {
        const float *emissive = mesh.materials[mesh.primitives[i].material].emissive;
        times[i] = emissive[0] / factor[0];
        for (int c = 1; c < 3; c++)
            if (fabsf(emissive[c] - factor[c] * times[i]) > 1e-5f * emissive[c])
                fail_msg("lamp %d: color %d is %g", i, c, (double)emissive[c]);
    }
    host_mesh_destroy(&f->device, &mesh);
}

/* KHR_materials_emissive_strength, in text and binary files; the primitives use materials in another order. */
static void lamps_have_their_strength(void **state)
{
    fixture *f = *state;
    static const char materials[] = "{\"name\":\"plain\",\"emissiveFactor\":[1,0.5,0.1]}," LAMP(
        "\"name\":\"strong\",", "[1,0.5,0.1]", "50") "," LAMP("", "[1,0.5,0.1]", "2.5");
    const int order[3] = {1, 2, 0};
    for (int binary = 0; binary < 2; binary++) {
        float times[3];
        load_lamps(f, materials, order, binary, times);
        assert_float_equal(times[0], 50.0, 1e-4);
        assert_float_equal(times[1], 2.5, 1e-5);
        assert_float_equal(times[2], 1.0, 1e-6);
        assert_string_equal(f->warning, "");
    }
}

#define CLOTH(name, factor)                                                           \
    "{\"name\":\"" name "\",\"extensions\":{\"KHR_materials_diffuse_transmission\":{" \
    "\"diffuseTransmissionFactor\":" factor "}}}"

/* KHR_materials_diffuse_transmission: what is no share is 0 or the nearer end. */
static void cloth_has_the_share_that_comes_through(void **state)
{
    fixture *f = *state;
    static const char *const materials[2] = {CLOTH("a", "0.35") ",{\"name\":\"b\"}," CLOTH("c", "\"much\""),
                                             CLOTH("a", "-1") "," CLOTH("b", "1.5") "," CLOTH("c", "1")};
    static const double expected[2][3] = {{0.35, 0, 0}, {0, 1, 1}};
    const int order[3] = {0, 1, 2};
    for (int k = 0; k < 2; k++) {
        host_mesh mesh;
        if (!host_mesh_load(&f->device, write_lamps(materials[k], order, k == 1), NULL, &mesh, f->error,
                            sizeof f->error))
            fail_msg("%s", f->error);
        for (int i = 0; i < 3; i++) {
            const host_material *material = &mesh.materials[mesh.primitives[i].material];
            assert_float_equal((double)material->passes, expected[k][material->name[0] - 'a'], 1e-6);
        }
        host_mesh_destroy(&f->device, &mesh);
    }
}

static void strengths_that_make_no_sense_are_one(void **state)
{
    fixture *f = *state;
    const int order[3] = {0, 1, 2};
    float times[3];
    load_lamps(f,
               LAMP("\"name\":\"a\",", "[1,0.5,0.1]", "-3") "," LAMP(
                   "\"name\":\"b\",", "[1,0.5,0.1]", "\"many\"") "," LAMP("\"name\":\"c\",", "[1,0.5,0.1]", "1e300"),
               order, false, times);
    for (int i = 0; i < 3; i++)
        assert_float_equal(times[i], 1.0, 1e-6);
    load_lamps(f,
               LAMP("\"name\":\"a\",", "[1,0.5,0.1]", "3") "," LAMP("\"name\":\"a\",", "[1,0.5,0.1]", "4") "," LAMP(
                   "\"name\":\"c\",", "[1,0.5,0.1]", "5"),
               order, false, times);
    assert_non_null(strstr(f->warning, "several materials are called \"a\""));
    assert_float_equal(times[0], 3.0, 1e-5);
    assert_float_equal(times[2], 5.0, 1e-5);
}

static void missing_picture(void **state)
{
    fixture *f = *state;
    host_mesh mesh;
    write_file("picture.mtl", "newmtl brick\nKd 0.5 0.25 0.125\nmap_Kd absent.png\n");
    const char *path = write_file("picture.obj", "mtllib picture.mtl\nv 0 0 0\nv 0 0 1\nv 1 0 0\nvt 0 0\nvt 1 0\n"
                                                 "vt 0 1\nusemtl brick\nf 1/1 2/2 3/3\n");
    f->warning[0] = 0;
    assert_true(host_mesh_load(&f->device, path, NULL, &mesh, f->error, sizeof f->error));
    assert_non_null(strstr(f->warning, "absent.png"));
    assert_int_equal(mesh.materials[mesh.primitives[0].material].base_texture, -1);
    host_mesh_destroy(&f->device, &mesh);
}

/* Cut-out texels keep their share in every mip, and lend no colour to their neighbours. */
static void mips_keep_coverage(void **state)
{
    (void)state;
    enum { SIDE = 64 };
    uint8_t *rgba = calloc(SIDE * SIDE, 4);
    assert_non_null(rgba);
    uint32_t bits = 1;
    for (int i = 0; i < SIDE * SIDE; i++) {
        bits = bits * 1664525u + 1013904223u;
        bool leaf = bits >> 24 < 90;
        rgba[i * 4 + 1] = leaf ? 200 : 0;
        rgba[i * 4 + 3] = leaf ? 255 : 0;
    }
    host_picture picture;
    assert_true(host_picture_from_rgba(rgba, SIDE, SIDE, &picture));
    assert_true(picture.alpha);
    assert_true(host_picture_make_mips(&picture, 0.5f));
    assert_int_equal(picture.levels, 7);
    int covered = 0;
    const uint8_t *third = picture.texels + (SIDE * SIDE + SIDE * SIDE / 4) * 4;
    for (int i = 0; i < SIDE * SIDE / 16; i++) {
        covered += third[i * 4 + 3] >= 128;
        if (third[i * 4 + 3] > 0)
            assert_in_range(third[i * 4 + 1], 198, 202);
    }
    assert_in_range(covered, SIDE * SIDE / 16 * 30 / 100, SIDE * SIDE / 16 * 42 / 100); /* 35 % of the first level */
    host_picture_free(&picture);
    free(rgba);
}

/* glTF's occlusion, of a picture of two texels: it is kept beside the color, which it does not weight. */
static void joints_are_beside_the_color(void **state)
{
    (void)state;
    const uint8_t color[8] = {200, 100, 50, 255, 20, 10, 0, 255},
                  occlusion[16] = {7, 0, 0, 255, 7, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255};
    host_picture plain, depth, both;
    assert_true(host_picture_from_rgba(color, 2, 1, &plain));
    assert_true(host_picture_from_rgba(occlusion, 4, 1, &depth));
    assert_true(host_picture_add_joints(&plain, &depth, &both));
    const uint8_t expected[8] = {200, 100, 50, 7, 20, 10, 0, 255};
    assert_memory_equal(both.texels, expected, sizeof expected);
    assert_true(host_picture_make_mips(&plain, -1) && host_picture_make_mips(&both, -1));
    assert_int_equal(both.levels, 2);
    assert_memory_equal(both.texels + 8, plain.texels + 8, 3);
    assert_int_equal(both.texels[11], 131);
    host_picture_free(&plain);
    host_picture_free(&depth);
    host_picture_free(&both);
}

#define BASE  "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}"
#define DEPTH "\"occlusionTexture\":{\"index\":1}"
#define SAYS  "\"extras\":{\"virga_joints\":true}"

/* What is cut out or transparent has alpha of its own, and occlusion is mostly just that. */
static void opaque_materials_that_say_so_have_joints(void **state)
{
    fixture *f = *state;
    const int order[3] = {0, 1, 2};
    host_mesh mesh;
    const char *path = write_lamps(
        "{\"name\":\"a\"," BASE "," DEPTH "," SAYS "},{\"name\":\"b\"," BASE "," DEPTH "},"
        "{\"name\":\"c\",\"alphaMode\":\"BLEND\"," DEPTH "," SAYS ","
        "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},\"baseColorFactor\":[1,1,1,0.5]}}],"
        "\"textures\":[{\"source\":0},{\"source\":1}],\"images\":[{\"uri\":\"data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mM4kWIEAANWAV/W6lf+AAAAAElFTkSuQmCC\"},{\"uri\":"
        "\"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAAAAADRSSBWAAAAC0lEQVR42mNg+A8AAQIBANEay48AAAAASUV"
        "ORK5CYII=\"}",
        order, false);
    if (!host_mesh_load(&f->device, path, NULL, &mesh, f->error, sizeof f->error))
        fail_msg("%s", f->error);
    for (int i = 0; i < 3; i++) {
        const host_material *material = &mesh.materials[mesh.primitives[i].material];
        assert_true(material->base_texture >= 0);
        assert_int_equal(material->joints, material->name[0] == 'a');
    }
    host_mesh_destroy(&f->device, &mesh);
}

/* The plane y = 2 + 0.1 x - 0.05 z; and the same with two of six vertices 0.6 m higher: the mean plane is 0.2 m higher
 * then. */
static void ground_has_a_plane(void **state)
{
    fixture *f = *state;
    const char *plane = "o plane\nv 0 2 0\nv 4 2.4 0\nv 4 2.2 4\nv 0 1.8 4\nf 4 3 2 1\n";
    const char *ridge =
        "o ridge\nv 0 2 0\nv 2 2.8 0\nv 4 2.4 0\nv 4 2.2 4\nv 2 2.6 4\nv 0 1.8 4\nf 6 5 2 1\nf 5 4 3 2\n";
    for (int bent = 0; bent < 2; bent++) {
        host_mesh mesh;
        const char *path = write_file(bent ? "ridge.obj" : "plane.obj", bent ? ridge : plane);
        if (!host_mesh_load(&f->device, path, NULL, &mesh, f->error, sizeof f->error))
            fail_msg("%s", f->error);
        const host_primitive *ground = &mesh.primitives[0];
        assert_float_equal(ground->slope[0], 0.1, 1e-5);
        assert_float_equal(ground->slope[1], -0.05, 1e-5);
        assert_float_equal(ground->middle[1], 2 + 0.1 * 2 - 0.05 * 2 + (bent ? 0.2 : 0), 1e-5);
        assert_float_equal(ground->off, bent ? 0.4 : 0, 1e-5);
        host_mesh_destroy(&f->device, &mesh);
    }
}

static double area_of(const host_vertex *v, const uint32_t *corners)
{
    double u[3], w[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)v[corners[1]].position[k] - (double)v[corners[0]].position[k];
        w[k] = (double)v[corners[2]].position[k] - (double)v[corners[0]].position[k];
    }
    return 0.5 * sqrt(pow(u[1] * w[2] - u[2] * w[1], 2) + pow(u[2] * w[0] - u[0] * w[2], 2) +
                      pow(u[0] * w[1] - u[1] * w[0], 2));
}

/* A road, two walls of 3 m that meet in a corner, and a bridge, which is less than 2 % of the ground. The walls are cut
 * 0.15 m above the road, with points at the corner that both have, and lose no area; what is lower comes first. */
static void walls_are_cut_above_the_ground(void **state)
{
    fixture *f = *state;
    const char *text = "o road\nv -5 0 -5\nv 5 0 -5\nv 5 0 5\nv -5 0 5\nf 4 3 2 1\n"
                       "o house\nv -4 0 -4\nv 3 0 -4\nv 3 3 -4\nv -4 3 -4\nf 5 6 7 8\n"
                       "v 3 0 4\nv 3 3 4\nf 6 9 10 7\n"
                       "o bridge_road\nv 4 5 0\nv 5 5 0\nv 5 5 1\nv 4 5 1\nf 14 13 12 11\n";
    host_mesh mesh;
    host_vertex *v;
    uint32_t *indices, corner_points = 0, low_count = 0;
    double area = 0;
    if (!host_mesh_load_kept(&f->device, write_file("feet.obj", text), NULL, &mesh, &v, &indices, f->error,
                             sizeof f->error))
        fail_msg("%s", f->error);
    for (uint32_t p = 0; p < mesh.primitive_count; p++) {
        const host_primitive *primitive = &mesh.primitives[p];
        const uint32_t first = primitive->first_index, steep = primitive->level_count, count = primitive->index_count;
        assert_int_equal(primitive->ground_count, primitive->ground ? count : 0);
        assert_int_equal(steep, primitive->ground ? count : 0);
        low_count += host_mesh_low_count(&mesh, primitive, steep, count - steep, 0.14f);
        for (uint32_t i = first + steep; i < first + count; i += 3) {
            const float *heights[3] = {v[indices[i]].position, v[indices[i + 1]].position, v[indices[i + 2]].position};
            const float foot = fminf(heights[0][1], fminf(heights[1][1], heights[2][1]));
            const float top = fmaxf(heights[0][1], fmaxf(heights[1][1], heights[2][1]));
            assert_true(foot == mesh.feet[i / 3] && (top <= 0.15f || foot >= 0.15f));
            assert_true(i == first + steep || mesh.feet[i / 3 - 1] <= foot);
            area += area_of(v, &indices[i]);
            for (int k = 0; k < 3; k++)
                corner_points += heights[k][1] == 0.15f && heights[k][0] == 3.0f && heights[k][2] == -4.0f;
        }
    }
    printf("%u of the walls' indices are low, %u corners in their corner, %.6f m2\n", low_count, corner_points, area);
    assert_true(low_count > 0 && low_count < 24 && corner_points >= 4);
    assert_float_equal(area, 7 * 3 + 8 * 3, 1e-4);
    free(v);
    free(indices);
    host_mesh_destroy(&f->device, &mesh);
}

static void materials_have_names(void **state)
{
    (void)state;
    assert_string_equal(host_material_name(host_guess_material("TR-Asphalt-2")), "asphalt");
    assert_string_equal(host_material_name(host_guess_material("grass-aa.rgb")), "grass");
    assert_string_equal(host_material_name(host_guess_material("nothing known")), "default");
    assert_int_equal(host_guess_material(""), 0);
    assert_string_equal(host_material_name(255), "default");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_files),
        cmocka_unit_test(plain_triangle),
        cmocka_unit_test(lamps_have_their_strength),
        cmocka_unit_test(cloth_has_the_share_that_comes_through),
        cmocka_unit_test(strengths_that_make_no_sense_are_one),
        cmocka_unit_test(missing_picture),
        cmocka_unit_test(mips_keep_coverage),
        cmocka_unit_test(joints_are_beside_the_color),
        cmocka_unit_test(opaque_materials_that_say_so_have_joints),
        cmocka_unit_test(ground_has_a_plane),
        cmocka_unit_test(walls_are_cut_above_the_ground),
        cmocka_unit_test(materials_have_names),
    };
    return fixture_result(cmocka_run_group_tests(tests, set_up, tear_down));
}
