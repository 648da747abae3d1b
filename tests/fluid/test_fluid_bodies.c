/* Bodies in the water: what each does to the other. */
#include "body_fixture.h"

static fluid_fixture f;

/* ---- measures: over the density of water */

static void add_momentum(const fluid_fixture *at, double sum[3])
{
    const double each = pow((double)at->settings.spacing_m, 3);
    for (uint32_t i = 0; i < at->count; i++)
        for (int axis = 0; axis < 3; axis++)
            sum[axis] += each * (double)at->particles[i].velocity[axis];
}

/* Momentum, and angular momentum about the origin. */
static void add_spin(const fluid_fixture *at, double sum[3])
{
    const double each = pow((double)at->settings.spacing_m, 3);
    for (uint32_t i = 0; i < at->count; i++)
        for (int axis = 0; axis < 3; axis++) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const virga_particle_gpu *p = &at->particles[i];
            sum[axis] += each * ((double)p->position[u] * (double)p->velocity[v] -
                                 (double)p->position[v] * (double)p->velocity[u]);
        }
}

static double speed2(const float v[3])
{
    return (double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2];
}

/* Energy of water and a cube (m^5/s^2). */
static double total_energy(double side, double density)
{
    const virga_fluid_pose pose = pose_of(&f, 0);
    const double mass = density * pow(side, 3);
    return pow((double)f.settings.spacing_m, 3) * f.count * fluid_energy(&f) +
           mass * (0.5 * speed2(pose.velocity_m_s) + GRAVITY * (double)pose.center_m[1] +
                   0.5 * side * side / 6 * speed2(pose.spin_rad_s));
}

/* ---- */

static double kernel(double q)
{
    return (pow(fmax(2 - q, 0), 3) - 4 * pow(fmax(1 - q, 0), 3)) / (4 * M_PI);
}

/* The kernel's integral over the planes half a spacing and one and a half behind a wall at the distance z. */
static double layers(double z)
{
    double sum = 0;
    for (int i = 0; i < 4000; i++) {
        const double r = 2 * (i + 0.5) / 4000, ring = 2 * M_PI * r * 2 / 4000;
        sum += (kernel(hypot(z + 0.5, r)) + kernel(hypot(z + 1.5, r))) * ring;
    }
    return sum;
}

static double half_word(uint32_t word, int which)
{
    return (double)(int16_t)(word >> (16 * which) & 0xffff) / 32767;
}

/* Nodes over the middle of a face have what the walls of the box have; those over an edge have less. */
static void a_flat_face_is_a_wall(void **state)
{
    (void)state;
    const double d = 0.1;
    const box_mesh box = box_of(1, 1, 1);
    const body_mesh mesh = {box.corners[0], sizeof box.corners[0], 8, cube_indices, 36};
    body_mass mass;
    body_map map;
    body_mass_of(&mesh, &mass);
    assert_float_equal(mass.volume, 1, 1e-6);
    assert_float_equal(mass.area, 6, 1e-6);
    for (int k = 0; k < 6; k++)
        assert_float_equal(mass.inertia[k], k < 3 ? 1.0 / 6 : 0, 1e-6);
    const uint64_t count = body_map_size(&mass, d, &map);
    uint32_t(*nodes)[4] = calloc(count, sizeof *nodes);
    void *memory = calloc(1, body_map_bytes(&mesh, &map));
    REQUIRE(nodes && memory);
    assert_int_equal(body_map_fill(&mesh, &mass, &map, d, memory, nodes), BODY_MAP_DONE);
    const uint32_t half = map.dims[0] / 2;
    for (uint32_t x = 0; x < 6; x++) {
        const uint32_t *node = nodes[(half * map.dims[1] + half) * map.dims[0] + x];
        const double z = (-0.5 - (map.low[0] + x * map.node)) / d;
        const double slope = z > 0 ? (layers(z + 1e-3) - layers(fmax(z - 1e-3, 0))) / 1e-3 : 0;
        float distance;
        memcpy(&distance, &node[2], sizeof distance);
        assert_float_equal(distance, fmin(z, VIRGA_FLUID_MAP_REACH), 1e-5);
        assert_float_equal(half_word(node[1], 1), layers(fmax(z, 0)), 1e-3);
        if (z > 0.01)
            assert_float_equal(VIRGA_FLUID_MAP_GRADIENT * half_word(node[0], 0), -slope, 5e-3);
    }
    const uint32_t edge = (uint32_t)((-0.5 - map.low[0]) / map.node + 0.5);
    const uint32_t *at_edge = nodes[(half * map.dims[1] + edge) * map.dims[0] + edge];
    REQUIRE(half_word(at_edge[1], 1) <= layers(0) + 1e-3);
    const uint32_t *off_edge = nodes[(half * map.dims[1] + edge - 1) * map.dims[0] + edge - 1];
    REQUIRE(half_word(off_edge[1], 1) < 0.75 * layers(M_SQRT1_2));
    free(nodes);
    free(memory);
}

/* What a body's map says at a position (spacings), between its nodes as in shaders/fluid/bodies.glsl. */
typedef struct map_sample {
    double gradient[3], density, distance;
} map_sample;

static bool sample_map(const body_map *map, uint32_t (*nodes)[4], const double p[3], map_sample *out)
{
    double part[3];
    uint32_t first[3];
    *out = (map_sample){{0}, 0, 0};
    for (int axis = 0; axis < 3; axis++) {
        const double at = (p[axis] - map->low[axis]) / map->node;
        if (at < 0 || at >= map->dims[axis] - 1)
            return false;
        first[axis] = (uint32_t)at;
        part[axis] = at - first[axis];
    }
    for (uint32_t corner = 0; corner < 8; corner++) {
        double weight = 1;
        uint32_t index = 0;
        float distance;
        for (int axis = 2; axis >= 0; axis--) {
            const uint32_t side = corner >> axis & 1;
            weight *= side ? part[axis] : 1 - part[axis];
            index = index * map->dims[axis] + first[axis] + side;
        }
        const uint32_t *node = nodes[index];
        memcpy(&distance, &node[2], sizeof distance);
        for (int axis = 0; axis < 3; axis++)
            out->gradient[axis] += weight * VIRGA_FLUID_MAP_GRADIENT * half_word(node[axis / 2], axis % 2);
        out->density += weight * half_word(node[1], 1);
        out->distance += weight * (double)distance;
    }
    return true;
}

/* The sum over both layers of s |P'(s)|: see shaders/fluid/kernel.glsl. */
static double carried_across(double z)
{
    const double near = z + 0.5, far = z + 1.5;
    return 2 * M_PI * (near * near * kernel(near) + far * far * kernel(far));
}

enum { LAYERS = 42 };
static double flat_layers[LAYERS]; /* layers() at multiples of 1/16 */

/* Upward force on a cube from a piece of water, whose pressure rises downwards by 1 for each spacing. */
static double force_of(const map_sample *near, double height)
{
    const double *g = near->gradient, squared = g[0] * g[0] + g[1] * g[1] + g[2] * g[2], z = fmax(near->distance, 0);
    if (squared < 1e-12)
        return 0;
    const double steep = g[1] * g[1] / squared, at = fmin(16 * z, LAYERS - 2);
    const int row = (int)at;
    const double flat = flat_layers[row] + (at - row) * (flat_layers[row + 1] - flat_layers[row]);
    const double across = flat > 1e-6 ? fmin(near->density / flat * carried_across(z), 1) : 0;
    return -height * g[1] - across * steep - near->density * (1 - steep);
}

/* Archimedes, as a closed form of what the passes add up: water spread evenly around a cube lifts it by the weight of
 * the water in its place. With the pressure alone it would be 27 % more for this cube. */
static void a_map_has_the_buoyancy_of_archimedes(void **state)
{
    (void)state;
    enum { STEPS = 6 }; /* in a spacing */
    const double side = 8;
    for (int row = 0; row < LAYERS; row++)
        flat_layers[row] = layers(row / 16.0);
    const box_mesh box = box_of(side, side, side);
    const body_mesh mesh = {box.corners[0], sizeof box.corners[0], 8, cube_indices, 36};
    body_mass mass;
    body_map map;
    body_mass_of(&mesh, &mass);
    uint32_t(*nodes)[4] = calloc(body_map_size(&mass, 1, &map), sizeof *nodes);
    void *memory = calloc(1, body_map_bytes(&mesh, &map));
    REQUIRE(nodes && memory);
    assert_int_equal(body_map_fill(&mesh, &mass, &map, 1, memory, nodes), BODY_MAP_DONE);
    double force = 0;
    const int count = (int)(side + 4) * STEPS;
    for (int i = 0; i < count * count * count; i++) {
        const int at[3] = {i % count, i / count % count, i / count / count};
        double p[3], out = 0;
        map_sample near;
        for (int axis = 0; axis < 3; axis++) {
            p[axis] = (at[axis] + 0.5) / STEPS - side / 2 - 2;
            out = fmax(out, fabs(p[axis]) - side / 2);
        }
        if (out > 0 && sample_map(&map, nodes, p, &near))
            force += force_of(&near, p[1]) / pow(STEPS, 3);
    }
    printf("buoyancy %.4f of the water's weight\n", force / pow(side, 3));
    assert_float_equal(force / pow(side, 3), 1, 0.02);
    free(nodes);
    free(memory);
}

static void wrong_bodies_are_refused(void **state)
{
    (void)state;
    const box_mesh box = box_of(0.2, 0.2, 0.2), sheet = box_of(0.2, 0.2, 0.002), huge = box_of(50, 50, 50);
    virga_fluid_pose pose = {.rotation = {0, 0, 0, 1}};
    uint32_t index = 7;
    body_fixture_open(&f);
    fluid_fixture_box(&f, 0.04, 0.6, 0.6, 0.6);
    const virga_fluid_body good = body_of(&box, 1, 0.3, 0.3, 0.3);
    virga_fluid_body wrong = good;
    wrong.index_count = 33; /* a hole */
    assert_int_equal(virga_fluid_body_add(f.fluid, &wrong, &index), VIRGA_ERROR_INVALID);
    wrong = body_of(&sheet, 1, 0.3, 0.3, 0.3);
    assert_int_equal(virga_fluid_body_add(f.fluid, &wrong, &index), VIRGA_ERROR_INVALID);
    wrong = body_of(&huge, 1, 0.3, 0.3, 0.3);
    assert_int_equal(virga_fluid_body_add(f.fluid, &wrong, &index), VIRGA_ERROR_INVALID);
    wrong = good;
    wrong.density = 0.01f;
    assert_int_equal(virga_fluid_body_add(f.fluid, &wrong, &index), VIRGA_ERROR_INVALID);
    wrong = good;
    wrong.position_m[1] = NAN;
    assert_int_equal(virga_fluid_body_add(f.fluid, &wrong, &index), VIRGA_ERROR_INVALID);
    wrong = good;
    wrong.vertex_count = 7;
    assert_int_equal(virga_fluid_body_add(f.fluid, &wrong, &index), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_fluid_body_add(f.fluid, NULL, &index), VIRGA_ERROR_INVALID);
    assert_int_equal(index, 7);
    assert_int_equal(virga_fluid_body_add(f.fluid, &good, &index), VIRGA_OK);
    assert_int_equal(virga_fluid_body_add(f.fluid, &good, NULL), VIRGA_OK);
    assert_int_equal(virga_fluid_body_add(f.fluid, &good, NULL), VIRGA_ERROR_INVALID);    /* max_bodies is 2 */
    assert_int_equal(virga_fluid_body_drive(f.fluid, index, &pose), VIRGA_ERROR_INVALID); /* the water moves it */
    assert_int_equal(virga_fluid_body_drive(f.fluid, 5, &pose), VIRGA_ERROR_INVALID);
    REQUIRE(!virga_fluid_body_get(f.fluid, 5, &pose));
    f.settings.spacing_m = 0.05f;
    assert_int_equal(virga_fluid_set(f.fluid, &f.settings), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_fluid_clear(f.fluid), VIRGA_OK);
    assert_int_equal(virga_fluid_set(f.fluid, &f.settings), VIRGA_OK);
    fluid_fixture_close(&f);
}

/* Water from y = 0 to `top`, with a hole for a cube of this side in the middle, from `low` on. */
static void fill_around(double width, double side, double low, double high, double top)
{
    const double a = (width - side) / 2, b = (width + side) / 2;
    fluid_fixture_block(&f, 0, 0, 0, width, low, width);
    fluid_fixture_block(&f, 0, low, 0, a, high, width);
    fluid_fixture_block(&f, b, low, 0, width, high, width);
    fluid_fixture_block(&f, a, low, 0, b, high, a);
    fluid_fixture_block(&f, a, low, b, b, high, width);
    if (top > high)
        fluid_fixture_block(&f, 0, high, 0, width, top, width);
}

/* Depth of the water around the body by its volume, and the mean pressure right below it over what this depth gives. */
static double level_around(double width, double side, double bottom)
{
    const double water = f.count * pow((double)f.settings.spacing_m, 3);
    return (water - side * side * bottom) / (width * width - side * side);
}

static double pressure_below(double width, double side, double bottom, double level)
{
    double sum = 0, expected = 0;
    for (uint32_t i = 0; i < f.count; i++) {
        const float *p = f.particles[i].position;
        const double deep = bottom - (double)p[1];
        if (deep < 0 || deep > 2 * (double)f.settings.spacing_m ||
            fmax(fabs((double)p[0] - width / 2), fabs((double)p[2] - width / 2)) > side / 2)
            continue;
        sum += (double)f.pressures[i][0];
        expected += GRAVITY * (level - (double)p[1]);
    }
    return sum / expected;
}

/* A body of specific gravity s floats with s of its height under water. It begins half a spacing too high, and swings
 * with a period of about 0.7 s. */
static void a_floating_body_settles_at_the_depth_of_archimedes(void **state)
{
    (void)state;
    enum { PERIOD = 44 };
    const double d = 0.02, width = 0.32, side = 0.16, draught = 0.1, density = draught / side, level = 0.2;
    const box_mesh box = box_of(side, side, side);
    double found = 0, pressure = 0, speed = 0;
    body_fixture_open(&f);
    fluid_fixture_box(&f, d, width, 0.5, width);
    fill_around(width, side, level - draught, level, 0);
    const virga_fluid_body body = body_of(&box, density, width / 2, level - draught + side / 2 + d / 2, width / 2);
    body_fixture_add(&f, &body);
    fluid_fixture_run(&f, 40);
    for (int i = 0; i < PERIOD; i++) {
        fluid_fixture_run(&f, 1);
        const virga_fluid_pose pose = pose_of(&f, 0);
        const double bottom = (double)pose.center_m[1] - 0.5 * side, top = level_around(width, side, bottom);
        found += (top - bottom) / PERIOD;
        pressure += pressure_below(width, side, bottom, top) / PERIOD;
        speed = fmax(speed, sqrt(speed2(pose.velocity_m_s)));
    }
    printf("draught %.4f m, %.4f expected; pressure below %.3f of that of this depth; it moves at up to %.3f m/s, the "
           "water at %.4f\n",
           found, draught, pressure, speed, fluid_noise(&f));
    REQUIRE(fabs(found / draught - 1) < 0.05);
    REQUIRE(fabs(pressure - 1) < 0.05);
    REQUIRE(speed < 0.05 && fluid_noise(&f) < 0.02);
    fluid_fixture_close(&f);
}

/* A submerged body begins to fall by its weight less that of the water in its place, over its mass and that of the
 * water that has to move along: 0.67 of what fits in its place for a cube in a large sea, and more between walls, here
 * three times its width apart. */
static void a_sinking_body_accelerates_by_what_buoyancy_leaves(void **state)
{
    (void)state;
    const double d = 0.02, width = 0.36, side = 0.12, low = 0.16, density = 3, time = 1.0 / 120;
    const double added = 0.67, most = (density - 1) / (density + added), least = (density - 1) / (density + 3 * added);
    const box_mesh box = box_of(side, side, side);
    body_fixture_open(&f);
    fluid_fixture_box(&f, d, width, 0.5, width);
    fill_around(width, side, low, low + side, 0.4);
    const virga_fluid_body body = body_of(&box, density, width / 2, low + side / 2, width / 2);
    body_fixture_add(&f, &body);
    for (int i = 0; i < 8; i++)
        fluid_fixture_step(&f, time);
    const virga_fluid_pose pose = pose_of(&f, 0);
    const double found = -(double)pose.velocity_m_s[1] / (8 * time * GRAVITY);
    printf("acceleration %.3f g; %.3f to %.3f g expected, and 1 g in air\n", found, least, most);
    REQUIRE(found > least && found < most);
    fluid_fixture_close(&f);
}

static void momentum_of_water_and_a_body_is_kept(void **state)
{
    (void)state;
    const double d = 0.02, side = 0.12, density = 0.4;
    const box_mesh box = box_of(side, side, side);
    body_fixture_open(&f);
    memset(f.settings.gravity_m_s2, 0, sizeof f.settings.gravity_m_s2);
    fluid_fixture_box(&f, d, 1.2, 0.8, 0.8);
    virga_fluid_block block = {
        .low_m = {0.3f, 0.35f, 0.34f}, .high_m = {0.5f, 0.55f, 0.52f}, .velocity_m_s = {1.5f, 0, 0}};
    REQUIRE(virga_fluid_add(f.fluid, &block) == VIRGA_OK);
    virga_fluid_body body = body_of(&box, density, 0.62, 0.4, 0.4);
    body.rotation[2] = 0.2f;
    body.rotation[3] = 1;
    body_fixture_add(&f, &body);
    double before[3] = {0}, spin_before[3] = {0}, after[3] = {0}, spin_after[3] = {0};
    fluid_fixture_step(&f, 0);
    add_momentum(&f, before);
    add_spin(&f, spin_before);
    fluid_fixture_run(&f, 14);
    const virga_fluid_pose pose = pose_of(&f, 0);
    const double mass = density * pow(side, 3), inertia = mass * side * side / 6;
    add_momentum(&f, after);
    add_spin(&f, spin_after);
    printf("the body moves at %.3f m/s and turns at %.3f rad/s\n", sqrt(speed2(pose.velocity_m_s)),
           sqrt(speed2(pose.spin_rad_s)));
    REQUIRE(pose.velocity_m_s[0] > 0.4f);
    REQUIRE(speed2(pose.spin_rad_s) > 0.01);
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        after[axis] += mass * (double)pose.velocity_m_s[axis];
        spin_after[axis] +=
            inertia * (double)pose.spin_rad_s[axis] + mass * ((double)pose.center_m[u] * (double)pose.velocity_m_s[v] -
                                                              (double)pose.center_m[v] * (double)pose.velocity_m_s[u]);
        printf("axis %d: momentum %.3e, %.3e before; angular %.3e, %.3e before\n", axis, after[axis], before[axis],
               spin_after[axis], spin_before[axis]);
        REQUIRE(fabs(after[axis] - before[axis]) < 1e-5 * before[0]);
        /* Pressure acts along the gradient of a map, at the particle: only the map's own errors turn anything. */
        REQUIRE(fabs(spin_after[axis] - spin_before[axis]) < 2e-3 * before[0]);
    }
    fluid_fixture_close(&f);
}

static void a_splash_loses_energy_in_every_step_and_no_particle_is_in_the_body(void **state)
{
    (void)state;
    const double d = 0.025, width = 0.4, side = 0.15, density = 1.5, half[3] = {side / 2, side / 2, side / 2};
    const box_mesh box = box_of(side, side, side);
    body_fixture_open(&f);
    fluid_fixture_box(&f, d, width, 0.8, width);
    fluid_fixture_block(&f, 0, 0, 0, width, 0.3, width);
    virga_fluid_body body = body_of(&box, density, width / 2, 0.5, width / 2);
    body.rotation[0] = 0.3f;
    body.rotation[2] = 0.2f;
    body.rotation[3] = 1;
    body_fixture_add(&f, &body);
    fluid_fixture_step(&f, 0);
    const double first = total_energy(side, density);
    double before = first, worst = 0, deepest = -1, low = 1;
    for (int i = 0; i < 80; i++) {
        fluid_fixture_run(&f, 1);
        const double now = total_energy(side, density);
        const virga_fluid_pose pose = pose_of(&f, 0);
        worst = fmax(worst, (now - before) / first);
        before = now;
        low = fmin(low, (double)pose.center_m[1]);
        for (uint32_t k = 0; k < f.count; k++)
            deepest = fmax(deepest, depth_in_box(&pose, half, f.particles[k].position));
    }
    printf("energy grew by %.2e of that at the start at most, and is %.3f of it; deepest particle %.4f spacings; "
           "the body came down to %.3f m\n",
           worst, before / first, deepest / d, low);
    REQUIRE(worst < 1e-3);
    REQUIRE(deepest < 0.2 * d); /* at corners, which the map rounds */
    REQUIRE(low < 0.12 && low >= side / 2 - 1e-4);
    fluid_fixture_close(&f);
}

/* The host turns and moves a body through water. */
static void a_driven_body_is_where_the_host_wants_it(void **state)
{
    (void)state;
    const double d = 0.03, half[3] = {0.06, 0.12, 0.06};
    const box_mesh box = box_of(2 * half[0], 2 * half[1], 2 * half[2]);
    virga_fluid_pose wanted = {.position_m = {0.15f, 0.2f, 0.2f}};
    double deepest = -1;
    body_fixture_open(&f);
    fluid_fixture_box(&f, d, 0.6, 0.5, 0.42);
    fluid_fixture_block(&f, 0, 0, 0, 0.6, 0.24, 0.42);
    const virga_fluid_body body = body_of(&box, 0, 0.15, 0.2, 0.2);
    body_fixture_add(&f, &body);
    fluid_fixture_run(&f, 2);
    for (int i = 1; i <= 20; i++) {
        wanted.position_m[0] = 0.15f + 0.012f * (float)i;
        wanted.rotation[1] = (float)sin(0.04 * i);
        wanted.rotation[3] = (float)cos(0.04 * i);
        REQUIRE(virga_fluid_body_drive(f.fluid, 0, &wanted) == VIRGA_OK);
        fluid_fixture_run(&f, 1);
        const virga_fluid_pose pose = pose_of(&f, 0);
        for (int axis = 0; axis < 3; axis++)
            REQUIRE(fabsf(pose.position_m[axis] - wanted.position_m[axis]) < 1e-5f);
        REQUIRE(fabsf(pose.rotation[1] - wanted.rotation[1]) < 1e-4f);
        assert_float_equal(pose.velocity_m_s[0], 0.72, 1e-3);
        for (uint32_t k = 0; k < f.count; k++)
            deepest = fmax(deepest, depth_in_box(&pose, half, f.particles[k].position));
    }
    double push = 0;
    for (uint32_t k = 0; k < f.count; k++)
        push += (double)f.particles[k].velocity[0] / f.count;
    printf("deepest particle %.4f spacings; the water moves at %.3f m/s\n", deepest / d, push);
    REQUIRE(deepest < 0.15 * d);
    fluid_fixture_run(&f, 1); /* without a call it stays */
    const virga_fluid_pose pose = pose_of(&f, 0);
    assert_float_equal(pose.velocity_m_s[0], 0, 0);
    fluid_fixture_close(&f);
}

/* Which axis' side of a box a particle is beside, 2 spacings and more from its edges: 0 to 2. 3: it is beside an edge,
 * that much from its ends. -1: neither. */
static int beside_box(const double half[3], double d, const double at[3])
{
    int outside = 0, inside = 0, axis = -1;
    for (int k = 0; k < 3; k++) {
        const double over = fabs(at[k]) - half[k];
        outside += over > 0.1 * d && over < 1.2 * d;
        inside += over < -2 * d;
        axis = over > 0 && over < 1.2 * d ? k : axis;
    }
    return outside == 2 && inside == 1 ? 3 : inside == 2 ? axis : -1;
}

typedef struct near_errors {
    double distance, normal, velocity, share, edge;
    uint32_t beside, edges;
} near_errors;

static void compare_near(const virga_fluid_pose *pose, const double half[3], const float p[3],
                         const virga_body_near_gpu *near, near_errors *sum)
{
    const double d = (double)f.settings.spacing_m;
    double at[3], side[3] = {0}, world[3], arm[3], spin[3];
    in_body(pose, p, at);
    const int axis = beside_box(half, d, at);
    if (axis == 3) {
        sum->edge += (double)near->share;
        sum->edges++;
    }
    if (axis < 0 || axis == 3)
        return;
    side[axis] = copysign(1, at[axis]);
    turn_by(pose, 1, side, world);
    sum->beside++;
    sum->distance = fmax(sum->distance, fabs((double)near->distance_m - fabs(at[axis]) + half[axis]));
    sum->share = fmax(sum->share, fabs((double)near->share - 1));
    for (int k = 0; k < 3; k++) {
        arm[k] = (double)p[k] - (double)pose->center_m[k];
        spin[k] = (double)pose->spin_rad_s[k];
    }
    for (int k = 0; k < 3; k++) {
        const int u = (k + 1) % 3, v = (k + 2) % 3;
        const double velocity = (double)pose->velocity_m_s[k] + spin[u] * arm[v] - spin[v] * arm[u];
        sum->normal = fmax(sum->normal, fabs((double)near->normal[k] - world[k]));
        sum->velocity = fmax(sum->velocity, fabs((double)near->velocity[k] - velocity));
    }
}

static void read_near(host_buffer *down)
{
    virga_fluid_buffer found;
    virga_fluid_bodies_near(f.fluid, &found);
    assert_int_equal(found.size, f.count * sizeof(virga_body_near_gpu));
    REQUIRE(host_buffer_create(&f.gpu.device, found.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK,
                               "near down", down, f.gpu.error, sizeof f.gpu.error));
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    const VkBufferCopy copy = {found.offset, 0, found.size};
    effect_fixture_transfers(cmd);
    vkCmdCopyBuffer(cmd, found.buffer, down->buffer, 1, &copy);
    effect_fixture_complete(&f.gpu, f.context);
    host_buffer_invalidate(&f.gpu.device, down);
}

/* What the foam of water reads: distance, normal and velocity of a driven cube that moves and turns, beside the middle
 * of its sides; and how much of it is behind particles at its edges. */
static void particles_know_the_body_beside_them(void **state)
{
    (void)state;
    const double d = 0.03, half[3] = {0.12, 0.12, 0.12};
    const box_mesh box = box_of(2 * half[0], 2 * half[1], 2 * half[2]);
    virga_fluid_pose wanted = {.position_m = {0.306f, 0.24f, 0.3f}, .rotation = {0, sinf(0.02f), 0, cosf(0.02f)}};
    near_errors sum = {0};
    host_buffer down;
    body_fixture_open(&f);
    fluid_fixture_box(&f, d, 0.6, 0.6, 0.6);
    fluid_fixture_block(&f, 0, 0, 0, 0.6, 0.36, 0.6);
    const virga_fluid_body body = body_of(&box, 0, 0.3, 0.24, 0.3);
    body_fixture_add(&f, &body);
    fluid_fixture_run(&f, 1);
    REQUIRE(virga_fluid_body_drive(f.fluid, 0, &wanted) == VIRGA_OK);
    fluid_fixture_run(&f, 1);
    const virga_fluid_pose pose = pose_of(&f, 0);
    read_near(&down);
    const virga_body_near_gpu *near = down.mapped;
    for (uint32_t i = 0; i < f.count; i++) {
        REQUIRE(near[i].distance_m == 1e9f || near[i].distance_m < 2.1f * (float)d);
        compare_near(&pose, half, f.particles[i].position, &near[i], &sum);
    }
    printf("%u particles beside sides: distance within %.1e spacings, normal %.1e, velocity %.1e m/s, share %.2f; "
           "%u at edges: share %.2f\n",
           sum.beside, sum.distance / d, sum.normal, sum.velocity, sum.share, sum.edges, sum.edge / sum.edges);
    REQUIRE(sum.beside > 40 && sum.distance < 0.02 * d && sum.normal < 0.01 && sum.velocity < 1e-4);
    REQUIRE(sum.share < 0.05);
    REQUIRE(sum.edges > 10 && sum.edge / sum.edges < 0.95); /* maps round edges */
    host_buffer_destroy(&f.gpu.device, &down);
    fluid_fixture_close(&f);
}

static void a_body_falls_freely_and_rests_on_the_floor(void **state)
{
    (void)state;
    const box_mesh box = box_of(0.2, 0.1, 0.2);
    body_fixture_open(&f);
    fluid_fixture_box(&f, 0.04, 1, 1, 1);
    virga_fluid_body body = body_of(&box, 2, 0.5, 0.7, 0.5);
    body.rotation[0] = 0.2f;
    body.rotation[3] = 1;
    body_fixture_add(&f, &body);
    fluid_fixture_step(&f, 0.1);
    virga_fluid_pose pose = pose_of(&f, 0);
    const double fallen = 0.7 - (double)pose.center_m[1];
    REQUIRE(fabs(fallen - 0.5 * GRAVITY * 0.01 * (1 + 1.0 / f.stats.substeps)) < 1e-4);
    fluid_fixture_run(&f, 150);
    pose = pose_of(&f, 0);
    printf("it rests at %.4f m, and moves at %.1e m/s\n", (double)pose.center_m[1], sqrt(speed2(pose.velocity_m_s)));
    assert_float_equal(pose.center_m[1], 0.05, 2e-3);
    REQUIRE(speed2(pose.velocity_m_s) < 1e-4);
    fluid_fixture_close(&f);
}

/* Without water and gravity: each moves by its own speed, whatever others there are. */
static void two_bodies_move_by_their_own_speeds(void **state)
{
    (void)state;
    const box_mesh box = box_of(0.1, 0.1, 0.1);
    body_fixture_open(&f);
    memset(f.settings.gravity_m_s2, 0, sizeof f.settings.gravity_m_s2);
    fluid_fixture_box(&f, 0.02, 1, 1, 1);
    virga_fluid_body first = body_of(&box, 2, 0.2, 0.5, 0.5), second = body_of(&box, 0.5, 0.8, 0.5, 0.5);
    first.velocity_m_s[0] = 0.6f;
    second.velocity_m_s[1] = -1.2f;
    body_fixture_add(&f, &first);
    body_fixture_add(&f, &second);
    fluid_fixture_run(&f, 10);
    const virga_fluid_pose poses[2] = {pose_of(&f, 0), pose_of(&f, 1)};
    assert_float_equal(poses[0].position_m[0], 0.3, 1e-5);
    assert_float_equal(poses[0].position_m[1], 0.5, 1e-5);
    assert_float_equal(poses[1].position_m[0], 0.8, 1e-5);
    assert_float_equal(poses[1].position_m[1], 0.3, 1e-5);
    fluid_fixture_close(&f);
}

static void the_same_calls_give_the_same_bits(void **state)
{
    (void)state;
    const box_mesh box = box_of(0.16, 0.16, 0.16);
    static virga_particle_gpu first[4096];
    virga_fluid_pose pose, first_pose;
    for (int run = 0; run < 2; run++) {
        body_fixture_open(&f);
        fluid_fixture_box(&f, 0.04, 0.6, 0.8, 0.6);
        fluid_fixture_block(&f, 0, 0, 0, 0.6, 0.24, 0.6);
        virga_fluid_body body = body_of(&box, 0.7, 0.33, 0.4, 0.29);
        body.rotation[0] = 0.3f;
        body.rotation[3] = 1;
        body_fixture_add(&f, &body);
        fluid_fixture_run(&f, 25);
        pose = pose_of(&f, 0);
        if (run) {
            assert_memory_equal(first, f.particles, f.count * sizeof *first);
            assert_memory_equal(&first_pose, &pose, sizeof pose);
        }
        first_pose = pose;
        memcpy(first, f.particles, f.count * sizeof *first);
        fluid_fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_face_is_a_wall),
        cmocka_unit_test(a_map_has_the_buoyancy_of_archimedes),
        cmocka_unit_test(wrong_bodies_are_refused),
        cmocka_unit_test(a_body_falls_freely_and_rests_on_the_floor),
        cmocka_unit_test(a_driven_body_is_where_the_host_wants_it),
        cmocka_unit_test(particles_know_the_body_beside_them),
        cmocka_unit_test(momentum_of_water_and_a_body_is_kept),
        cmocka_unit_test(a_sinking_body_accelerates_by_what_buoyancy_leaves),
        cmocka_unit_test(a_splash_loses_energy_in_every_step_and_no_particle_is_in_the_body),
        cmocka_unit_test(a_floating_body_settles_at_the_depth_of_archimedes),
        cmocka_unit_test(two_bodies_move_by_their_own_speeds),
        cmocka_unit_test(the_same_calls_give_the_same_bits),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
