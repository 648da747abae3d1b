/* test_ply.c - point caches: round trip, other programs' files, an independent reader, failures. */
#include "check_io.h"
#include "ply.h"

#include <assimp/cimport.h>
#include <assimp/scene.h>

typedef struct point {
    float position[3], radius;
    double not_written;
    uint32_t id;
} point;

static const ply_property point_properties[] = {
    {"x", PLY_FLOAT, offsetof(point, position)},     {"y", PLY_FLOAT, offsetof(point, position) + 4},
    {"z", PLY_FLOAT, offsetof(point, position) + 8}, {"radius", PLY_FLOAT, offsetof(point, radius)},
    {"id", PLY_UINT, offsetof(point, id)},
};

static point *make_points(uint32_t count)
{
    point *points = calloc(count, sizeof *points);
    for (uint32_t i = 0; i < count; i++)
        points[i] = (point){{(float)i, 0.5f * (float)i, -1.25f}, 0.001f, 0, 0xFFFF0000u + i};
    return points;
}

static bool write_points(const char *path, uint32_t count)
{
    point *points = make_points(count);
    bool ok = ply_write(path, point_properties, COUNT(point_properties), points, sizeof *points, count, NULL, error,
                        sizeof error);
    free(points);
    return ok;
}

static void points_come_back(void **state)
{
    (void)state;
    ply_points read;
    assert_true(write_points(in_folder("p.ply"), 10000)); /* more than one block of output */
    assert_true(ply_read(in_folder("p.ply"), &read, error, sizeof error));
    assert_int_equal(read.count, 10000);
    assert_int_equal(read.property_count, 5);
    int y = ply_find(&read, "y"), id = ply_find(&read, "id");
    for (uint32_t i = 0; i < 10000; i++) {
        assert_true(read.values[i * 5 + (uint32_t)y].real == 0.5f * (float)i);
        assert_int_equal(read.values[i * 5 + (uint32_t)id].whole, 0xFFFF0000u + i);
    }
    assert_int_equal(ply_find(&read, "vx"), -1);
    assert_int_equal(folder_entries(false), 1);
    ply_free(&read);
}

static void the_header_is_as_published(void **state)
{
    (void)state;
    const char *comments[] = {"frame 3", "two\nelement lines", NULL};
    assert_true(
        ply_write(in_folder("p.ply"), point_properties + 3, 2, NULL, sizeof(point), 0, comments, error, sizeof error));
    size_t size;
    char *text = get_file(in_folder("p.ply"), &size);
    assert_string_equal(text, "ply\nformat binary_little_endian 1.0\ncomment frame 3\ncomment two\nelement vertex 0\n"
                              "property float radius\nproperty uint id\nend_header\n");
    free(text);
}

static void no_points_are_a_file(void **state)
{
    (void)state;
    ply_points read;
    assert_true(write_points(in_folder("p.ply"), 0));
    assert_true(ply_read(in_folder("p.ply"), &read, error, sizeof error));
    assert_int_equal(read.count, 0);
    ply_free(&read);
}

static void assimp_reads_the_same_points(void **state)
{
    (void)state;
    assert_true(write_points(in_folder("p.ply"), 100));
    const struct aiScene *scene = aiImportFile(in_folder("p.ply"), 0);
    if (!scene)
        fail_msg("assimp: %s", aiGetErrorString());
    assert_int_equal(scene->mNumMeshes, 1);
    assert_int_equal(scene->mMeshes[0]->mNumVertices, 100);
    const struct aiVector3D *last = &scene->mMeshes[0]->mVertices[99];
    assert_true(last->x == 99.0f && last->y == 49.5f && last->z == -1.25f);
    aiReleaseImport(scene);
}

static void other_programs_files_are_read(void **state)
{
    (void)state;
    static const char head[] = "ply\r\nformat binary_little_endian 1.0\r\ncomment by hand\r\nobj_info none\r\n"
                               "element vertex 2\r\nproperty float32 x\r\nproperty uint32 id\r\n"
                               "element face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n";
    const struct {
        float x;
        uint32_t id;
    } rows[] = {{1.5f, 7}, {-2.0f, 8}};
    char file[sizeof head - 1 + sizeof rows + 5] = {0};
    ply_points read;
    memcpy(file, head, sizeof head - 1);
    memcpy(file + sizeof head - 1, rows, sizeof rows);
    put_file(in_folder("p.ply"), file, sizeof file);
    if (!ply_read(in_folder("p.ply"), &read, error, sizeof error))
        fail_msg("%s", error);
    assert_int_equal(read.count, 2);
    assert_true(read.values[2].real == -2.0f);
    assert_int_equal(read.values[3].whole, 8);
    ply_free(&read);
}

static void assert_refused(const char *text, size_t size, const char *reason)
{
    ply_points read;
    put_file(in_folder("bad.ply"), text, size);
    assert_false(ply_read(in_folder("bad.ply"), &read, error, sizeof error));
    assert_error("bad.ply", reason);
    assert_null(read.values);
}

#define HEAD "ply\nformat binary_little_endian 1.0\n"

static void broken_files_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *reason;
    } files[] = {
        {"", "no end"},
        {"hello\nworld\n", "expected 'ply'"},
        {"ply\nformat ascii 1.0\n", "binary_little_endian"},
        {HEAD "element vertex 1\nproperty float x\n", "no end"},
        {HEAD "element face 1\nend_header\n", "element vertex"},
        {HEAD "element vertex 1\nproperty double x\nend_header\n", "float or uint"},
        {HEAD "element vertex 1\nproperty float\nend_header\n", "property TYPE NAME"},
        {HEAD "element vertex 1\nend_header\n", "element vertex"},
        {HEAD "element vertex 2\nproperty float x\nend_header\n1234", "expected 2 rows of 4"},
        {HEAD "element vertex 99999999999999999999\nproperty float x\nend_header\n1234", "rows of 4"},
    };
    for (size_t i = 0; i < COUNT(files); i++)
        assert_refused(files[i].text, strlen(files[i].text), files[i].reason);
}

static void wrong_properties_are_refused(void **state)
{
    (void)state;
    static const struct {
        ply_property property;
        const char *reason;
    } wrong[] = {
        {{"", PLY_FLOAT, 0}, "property name"},
        {{"a b", PLY_FLOAT, 0}, "'a b'"},
        {{"far", PLY_FLOAT, 9}, "outside its row"},
        {{NULL, PLY_FLOAT, 0}, "property name"},
    };
    const ply_property twice[] = {{"x", PLY_FLOAT, 0}, {"x", PLY_FLOAT, 4}};
    float row[3] = {0};
    for (size_t i = 0; i < COUNT(wrong); i++) {
        assert_false(ply_write(in_folder("p.ply"), &wrong[i].property, 1, row, 12, 1, NULL, error, sizeof error));
        assert_error("p.ply", wrong[i].reason);
    }
    assert_false(ply_write(in_folder("p.ply"), twice, 2, row, 12, 1, NULL, error, sizeof error));
    assert_error("p.ply", "twice");
    assert_int_equal(folder_entries(false), 0);
}

static void a_missing_folder_is_one_line(void **state)
{
    (void)state;
    assert_false(write_points(in_folder("none/p.ply"), 1));
    assert_error("none/p.ply", "No such file or directory");
}

static void a_full_disk_is_one_line(void **state)
{
    (void)state;
    struct stat info;
    assert_false(write_points("/dev/full", 1));
    assert_error("/dev/full", "No space left on device");
    assert_int_equal(stat("/dev/full", &info), 0);
    assert_true(S_ISCHR(info.st_mode)); /* a device is never renamed over */
}

static void failing_in_the_middle_leaves_the_old_file(void **state)
{
    (void)state;
    size_t size;
    put_file(in_folder("p.ply"), "old", 3);
    limit_files(100000);
    bool ok = write_points(in_folder("p.ply"), 100000);
    unlimit_files();
    assert_false(ok);
    assert_error("p.ply", "File too large");
    assert_int_equal(folder_entries(false), 1);
    char *text = get_file(in_folder("p.ply"), &size);
    assert_string_equal(text, "old");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(points_come_back),
        TEST_IN_FOLDER(the_header_is_as_published),
        TEST_IN_FOLDER(no_points_are_a_file),
        TEST_IN_FOLDER(assimp_reads_the_same_points),
        TEST_IN_FOLDER(other_programs_files_are_read),
        TEST_IN_FOLDER(broken_files_are_refused),
        TEST_IN_FOLDER(wrong_properties_are_refused),
        TEST_IN_FOLDER(a_missing_folder_is_one_line),
        TEST_IN_FOLDER(a_full_disk_is_one_line),
        TEST_IN_FOLDER(failing_in_the_middle_leaves_the_old_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
