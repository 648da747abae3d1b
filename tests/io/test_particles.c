/* test_particles.c - frames of particles: every format gives the same numbers, and what is wrong is one line. */
#include "../host/test_particles.h"
#include "check_io.h"
#include "particle_files.h"
#include "particles.h"

#include <math.h>

static void assert_particles(const particles *read, uint32_t count)
{
    assert_int_equal(read->count, count);
    assert_non_null(read->position);
    assert_non_null(read->velocity);
    assert_non_null(read->id);
    assert_non_null(read->density);
    for (uint32_t i = 0; i < count; i++) {
        const float position[3] = {(float)i, 0.5f * (float)i, -1.25f}, velocity[3] = {0.25f * (float)i, -2, 3};
        assert_memory_equal(read->position[i], position, sizeof position);
        assert_memory_equal(read->velocity[i], velocity, sizeof velocity);
        assert_int_equal(read->id[i], 1000 - i);
        assert_true(read->density[i] == 990.0f + (float)i);
    }
}

static void must_read(const char *path, particles *read)
{
    if (!particles_read(path, read, error, sizeof error))
        fail_msg("%s", error);
}

static void each_format_gives_the_same_particles(void **state)
{
    (void)state;
    for (int kind = 0; kind < FILE_KINDS; kind++)
        for (uint32_t count = 0; count <= 900; count += 300) {
            particle_file file = make_particle_file((particle_file_kind)kind, count);
            particle_file packed = gzip_particle_file(&file);
            particles read;
            put_file(in_folder("plain"), file.data, file.size);
            put_file(in_folder("packed"), packed.data, packed.size);
            must_read(in_folder("plain"), &read);
            assert_particles(&read, count);
            particles_free(&read);
            must_read(in_folder("packed"), &read);
            assert_particles(&read, count);
            particles_free(&read);
            free(file.data);
            free(packed.data);
        }
}

static void formats_are_known_by_their_first_bytes(void **state)
{
    (void)state;
    static const char *const names[] = {"PLY", "PLY", "PLY", "VTK", "VTK", "VTK", "VTK", "VTK", "bgeo", "bgeo"};
    for (int kind = 0; kind < FILE_KINDS; kind++) {
        particle_file file = make_particle_file((particle_file_kind)kind, 3);
        put_file(in_folder("named.yaml"), file.data, file.size);
        assert_string_equal(particles_format(in_folder("named.yaml")), names[kind]);
        free(file.data);
    }
    put_file(in_folder("named.ply"), "virga: 1\n", 9);
    assert_null(particles_format(in_folder("named.ply")));
    assert_null(particles_format(in_folder("none.ply")));
}

/* 16 bits have no room for the length of such a text, which is in the 32 behind them. */
static void long_texts_of_bgeo_are_skipped(void **state)
{
    (void)state;
    enum { LENGTH = 70000 };
    particle_file file = {0};
    particles read;
    FILE *to = open_memstream(&file.data, &file.size);
    put_bgeo_header(to, (const double[9]){5, 1, 0, 0, 0, 2, 0, 0, 0});
    put_number(to, FILE_BGEO, 4, 2, false);
    fputs("note", to);
    put_number(to, FILE_BGEO, 1, 2, false);
    put_number(to, FILE_BGEO, 4, 4, false); /* an indexed text */
    put_number(to, FILE_BGEO, 1, 4, false);
    put_number(to, FILE_BGEO, 0xffff, 2, false);
    put_number(to, FILE_BGEO, LENGTH, 4, false);
    for (int i = 0; i < LENGTH; i++)
        fputc('a' + i % 26, to);
    put_bgeo_attribute(to, "density", 1, 0);
    for (int k = 0; k < 6; k++)
        put_number(to, FILE_BGEO, k + 1, 4, true);
    fclose(to);
    put_file(in_folder("long.bgeo"), file.data, file.size);
    must_read(in_folder("long.bgeo"), &read);
    assert_int_equal(read.count, 1);
    assert_true(read.position[0][0] == 1 && read.position[0][2] == 3);
    assert_non_null(read.density);
    assert_true(read.density[0] == 6);
    particles_free(&read);
    free(file.data);
}

static void read_text(const char *text, particles *read)
{
    put_file(in_folder("text"), text, strlen(text));
    must_read(in_folder("text"), read);
}

static void attributes_may_be_missing(void **state)
{
    (void)state;
    particles read;
    read_text("ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float y\r\n"
              "property float z\r\nproperty float vx\r\nproperty float vy\r\nend_header\r\n1 2 3 4 5\r\n",
              &read);
    assert_true(read.position[0][2] == 3);
    assert_null(read.velocity); /* without vz */
    assert_null(read.id);
    assert_null(read.density);
    particles_free(&read);
}

static void names_of_attributes_vary(void **state)
{
    (void)state;
    static const char *const names[][5] = {
        {"vx", "vy", "vz", "id", "density"},
        {"velocity_x", "velocity_y", "velocity_z", "particle_id", "rho"},
        {"VEL0", "VEL1", "VEL2", "ID", "Density"},
        {"velocity[0]", "velocity[1]", "velocity[2]", "ids", "dens"},
    };
    for (size_t i = 0; i < COUNT(names); i++) {
        char text[512];
        particles read;
        snprintf(text, sizeof text,
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                 "property float %s\nproperty float %s\nproperty float %s\nproperty float %s\nproperty float %s\n"
                 "end_header\n1 2 3 4 5 6 7 8\n",
                 names[i][0], names[i][1], names[i][2], names[i][3], names[i][4]);
        read_text(text, &read);
        assert_non_null(read.velocity);
        assert_true(read.velocity[0][0] == 4 && read.velocity[0][2] == 6);
        assert_non_null(read.id);
        assert_int_equal(read.id[0], 7);
        assert_non_null(read.density);
        assert_true(read.density[0] == 8);
        particles_free(&read);
    }
}

static void positions_that_are_no_numbers_are_kept(void **state)
{
    (void)state;
    particles read;
    read_text("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
              "end_header\nnan -nan(ind) 1\ninf 1e300 0\n",
              &read);
    assert_int_equal(read.count, 2);
    assert_true(isnan(read.position[0][0]) && isnan(read.position[0][1]));
    assert_true(isinf(read.position[1][0]) && isinf(read.position[1][1]));
    particles_free(&read);
}

#define PLY   "ply\nformat ascii 1.0\n"
#define XYZ   "property float x\nproperty float y\nproperty float z\n"
#define VTK   "# vtk DataFile Version 3.0\ntitle\n"
#define DATA  VTK "ASCII\nDATASET POLYDATA\n"
#define GEO_5 "BgeoV\0\0\0\5"
#define ZERO  "\0\0\0\0"

static void wrong_files_are_one_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t size;
        const char *place, *reason;
    } files[] = {
#define TEXT(text) text, sizeof text - 1
        {TEXT(""), "byte 0:", "expected PLY, legacy VTK or bgeo"},
        {TEXT("hello"), "byte 0:", "expected PLY"},
        {TEXT("\177NSJb"), "byte 0:", "classic format, version 5"},
        {TEXT("scf1"), "byte 0:", "blosc"},
        {TEXT("ply\nformat ascii 2.0\n"), "line 2:", "'format ascii 2.0', expected 'format ascii 1.0'"},
        {TEXT(PLY "element vertex -1\n"), "line 3:", "expected 'element NAME COUNT'"},
        {TEXT(PLY "element vertex 1\n" XYZ), "line 7:", "the file ends here"},
        {TEXT(PLY "element vertex 1\nproperty quad x\n"), "line 4:", "expected a type"},
        {TEXT(PLY "element vertex 1\nproperty float x\nend_header\n1\n"), "line 5:", "properties x, y and z"},
        {TEXT(PLY "element face 1\n" XYZ "end_header\n1 2 3\n"), "line 7:", "an element vertex"},
        {TEXT(PLY "element vertex 2\n" XYZ "end_header\n1 2 3\n4 5\n"), "line 10:", "the file ends here"},
        {TEXT(PLY "element vertex 2\n" XYZ "end_header\n1 2 3\n4 5,5 6\n"), "line 9:", "'5,5', expected a number"},
        {TEXT(PLY "element vertex 1\n" XYZ "property int id\nend_header\n1 2 3 1.5\n"), "line 9:", "id 1.5"},
        {TEXT(PLY "element vertex 99999999999999999999\n" XYZ "end_header\n1 2 3\n"), "line 7:", "at most 33554432"},
        {TEXT("ply\nformat binary_little_endian 1.0\nelement vertex 3\n" XYZ "end_header\n0123456789"), "byte",
         "the file ends at byte"},
        {TEXT(VTK "ASCII\nDATASET STRUCTURED_POINTS\n"), "line 4:", "expected DATASET POLYDATA or UNSTRUCTURED_GRID"},
        {TEXT(VTK "BINARIES\n"), "line 3:", "expected ASCII or BINARY"},
        {TEXT(DATA "POINTS many float\n"), "line 5:", "expected a count"},
        {TEXT(DATA "POINTS 1 quad\n"), "line 5:", "expected a type"},
        {TEXT(DATA "POINTS 1 float\n1 2 3\nPOINT_DATA 2\n"), "line 7:", "as many rows as points"},
        {TEXT(DATA "POINTS 1 float\n1 2 3\nCOLOURS 2\n"), "line 7:", "'COLOURS 2', expected a section"},
        {TEXT(DATA "POINTS 1 float\n1 2 3\nPOINT_DATA 1\nFIELD f 1\nid 1 3 int\n1 2 3\n"),
         "line 9:", "'id' has 3 rows, expected 1"},
        {TEXT(DATA "VERTICES 0 0\n"), "line", "expected POINTS"},
        {TEXT(GEO_5 ZERO), "byte 13:", "the file ends at byte 13"},
        {TEXT("BgeoV\0\0\0\6" ZERO ZERO ZERO ZERO ZERO ZERO ZERO ZERO), "byte 37:", "version 6, expected 5"},
        {TEXT(GEO_5 "\377\0\0\0" ZERO ZERO ZERO ZERO ZERO ZERO ZERO), "byte 37:", "4278190080 particles"},
        {TEXT(GEO_5 ZERO ZERO ZERO ZERO "\0\0\0\1" ZERO ZERO ZERO "\0\1P\0\1\0\0\0\3"), "byte 46:", "'P' of type 3"},
        {TEXT(GEO_5 ZERO ZERO ZERO ZERO "\0\0\0\1" ZERO ZERO ZERO "\0\4note\0\1\0\0\0\2"),
         "byte 49:", "attribute 'note' of type 2, expected 0"},
        {TEXT("\x1f\x8b\x08\0\0\0\0\0\0\3abcdefgh"), "byte", "gzip"},
    };
    for (size_t i = 0; i < COUNT(files); i++) {
        particles read;
        put_file(in_folder("bad.particles"), files[i].text, files[i].size);
        assert_false(particles_read(in_folder("bad.particles"), &read, error, sizeof error));
        assert_error(files[i].place, files[i].reason);
        assert_error("cannot read ", "bad.particles: ");
        assert_null(read.position);
        assert_int_equal(read.count, 0);
    }
}

static void what_has_no_end_is_refused(void **state)
{
    (void)state;
    particles read;
    assert_false(particles_read("/dev/zero", &read, error, sizeof error));
    assert_error("/dev/zero", "expected a regular file");
    assert_false(particles_read(folder, &read, error, sizeof error));
    assert_error(folder, "expected a regular file");
    assert_false(particles_read(in_folder("none"), &read, error, sizeof error));
    assert_error("none", "No such file or directory");
}

/* A header promises 32 million particles; with 256 MB more address space the reader may not take them. */
static void memory_is_taken_as_rows_come(void **state)
{
    (void)state;
    static const char head[] = "ply\nformat binary_little_endian 1.0\nelement vertex 33554432\n" XYZ "end_header\n";
    char file[sizeof head - 1 + 12000] = {0};
    struct rlimit limit, less;
    particles read;
    long pages = 0;
    FILE *own = fopen("/proc/self/statm", "r");
    assert_non_null(own);
    assert_int_equal(fscanf(own, "%ld", &pages), 1);
    fclose(own);
    memcpy(file, head, sizeof head - 1);
    put_file(in_folder("short.ply"), file, sizeof file);
    getrlimit(RLIMIT_AS, &limit);
    less = limit;
    less.rlim_cur = (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE) + ((rlim_t)256 << 20);
    setrlimit(RLIMIT_AS, &less);
    const bool ok = particles_read(in_folder("short.ply"), &read, error, sizeof error);
    setrlimit(RLIMIT_AS, &limit);
    assert_false(ok);
    assert_error("short.ply", "the file ends at byte");
}

/* ---- every scalar type of PLY */

static const char *const formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};

typedef struct ply_type {
    const char *name;
    int size;
    bool real;
    double value; /* what only this type has: its end, or all bits of a float */
} ply_type;

static const ply_type ply_types[] = {
    {"char", 1, false, -128},
    {"int8", 1, false, 127},
    {"uchar", 1, false, 255},
    {"uint8", 1, false, 128},
    {"short", 2, false, -32768},
    {"int16", 2, false, 32767},
    {"ushort", 2, false, 65535},
    {"uint16", 2, false, 32768},
    {"int", 4, false, -2147483648.0},
    {"int32", 4, false, 16711935},
    {"uint", 4, false, 4294967040.0},
    {"uint32", 4, false, 2147483648.0},
    {"long", 8, false, -1099511627776.0},
    {"int64", 8, false, 1099511627776.0},
    {"ulong", 8, false, 281474959933440.0},
    {"uint64", 8, false, 4294967296.0},
    {"float", 4, true, 0x1.fffffep-3},
    {"float32", 4, true, -0x1.000002p20},
    {"double", 8, true, 0x1.fffffep-30},
    {"float64", 8, true, -0x1.8p100},
};

/* Every column has this type, and a column that is skipped is behind each. The value goes through all columns. */
static void read_ply_type(particle_file_kind kind, const ply_type *type, const ply_type *beside)
{
    static const char *const columns[] = {"x", "y", "z", "vx", "vy", "vz", "density"};
    enum { COLUMNS = COUNT(columns), ROWS = 2 * COLUMNS };
    particle_file file = {0};
    particles read;
    FILE *to = open_memstream(&file.data, &file.size);
    fprintf(to, "ply\nformat %s 1.0\nelement vertex %d\n", formats[kind], ROWS);
    for (int k = 0; k < COLUMNS; k++)
        fprintf(to, "property %s %s\nproperty %s skipped%d\n", type->name, columns[k], beside->name, k);
    fputs("end_header\n", to);
    for (int i = 0; i < ROWS; i++)
        for (int k = 0; k < COLUMNS; k++) {
            put_number(to, kind, i % COLUMNS == k ? type->value : 1 + k, type->size, type->real);
            put_number(to, kind, beside->value, beside->size, beside->real);
        }
    fclose(to);
    put_file(in_folder("typed.ply"), file.data, file.size);
    must_read(in_folder("typed.ply"), &read);
    assert_int_equal(read.count, ROWS);
    assert_non_null(read.velocity);
    assert_non_null(read.density);
    for (int i = 0; i < ROWS; i++)
        for (int k = 0; k < COLUMNS; k++) {
            const float got = k < 3 ? read.position[i][k] : k < 6 ? read.velocity[i][k - 3] : read.density[i];
            const double expected = i % COLUMNS == k ? type->value : 1 + k;
            if ((double)got != expected)
                fail_msg("%s, property %s %s is %.9g, expected %.9g", formats[kind], type->name, columns[k],
                         (double)got, expected);
        }
    particles_free(&read);
    free(file.data);
}

static void each_type_of_ply_is_read_exactly(void **state)
{
    (void)state;
    for (int kind = FILE_PLY_ASCII; kind <= FILE_PLY_BIG; kind++)
        for (size_t i = 0; i < COUNT(ply_types); i++)
            read_ply_type((particle_file_kind)kind, &ply_types[i], &ply_types[(i + 7) % COUNT(ply_types)]);
}

/* Floats too: programs with one type for all columns write ids so. */
static void each_type_of_ply_can_be_an_id(void **state)
{
    (void)state;
    for (int kind = FILE_PLY_ASCII; kind <= FILE_PLY_BIG; kind++)
        for (size_t i = 0; i < COUNT(ply_types); i++) {
            const ply_type *type = &ply_types[i];
            const double id = type->size == 1 || type->value < 0 || type->size == 8 || type->real ? 100 : type->value;
            particle_file file = {0};
            particles read;
            FILE *to = open_memstream(&file.data, &file.size);
            fprintf(to, "ply\nformat %s 1.0\nelement vertex 1\n" XYZ "property %s id\nend_header\n", formats[kind],
                    type->name);
            for (int k = 0; k < 3; k++)
                put_number(to, (particle_file_kind)kind, k, 4, true);
            put_number(to, (particle_file_kind)kind, id, type->size, type->real);
            fclose(to);
            put_file(in_folder("id.ply"), file.data, file.size);
            must_read(in_folder("id.ply"), &read);
            assert_non_null(read.id);
            assert_true((double)read.id[0] == id);
            particles_free(&read);
            free(file.data);
        }
}

/* Files of another program; they are not part of the project. */
static void files_of_splishsplash_are_read(void **state)
{
    (void)state;
    particles ply, vtk, geo;
    char path[1024];
    if (!test_particles_have("dam_break_0060.ply"))
        skip();
    snprintf(path, sizeof path, "%s", test_particles_path("dam_break_0060.ply"));
    must_read(path, &ply);
    memcpy(strrchr(path, '.'), ".vtk", 5);
    must_read(path, &vtk);
    snprintf(strrchr(path, '.'), 6, ".bgeo");
    must_read(path, &geo);
    assert_int_equal(ply.count, 7290);
    assert_int_equal(vtk.count, 7290);
    assert_int_equal(geo.count, 7290);
    assert_memory_equal(vtk.position, geo.position, 7290 * sizeof *geo.position);
    assert_memory_equal(vtk.velocity, geo.velocity, 7290 * sizeof *geo.velocity);
    assert_memory_equal(vtk.density, geo.density, 7290 * sizeof *geo.density);
    for (uint32_t i = 0; i < geo.count; i++)
        assert_memory_equal(geo.position[i], ply.position[geo.id[i]], sizeof *geo.position);
    particles_free(&ply);
    particles_free(&vtk);
    particles_free(&geo);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(each_format_gives_the_same_particles),
        TEST_IN_FOLDER(formats_are_known_by_their_first_bytes),
        TEST_IN_FOLDER(long_texts_of_bgeo_are_skipped),
        TEST_IN_FOLDER(attributes_may_be_missing),
        TEST_IN_FOLDER(names_of_attributes_vary),
        TEST_IN_FOLDER(positions_that_are_no_numbers_are_kept),
        TEST_IN_FOLDER(wrong_files_are_one_line),
        TEST_IN_FOLDER(what_has_no_end_is_refused),
        TEST_IN_FOLDER(memory_is_taken_as_rows_come),
        TEST_IN_FOLDER(each_type_of_ply_is_read_exactly),
        TEST_IN_FOLDER(each_type_of_ply_can_be_an_id),
        TEST_IN_FOLDER(files_of_splishsplash_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
