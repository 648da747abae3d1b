/* virga/fluid.h - simulates water: particles in a box.
 *
 * The method is smoothed particle hydrodynamics with a flow that is kept free of divergence (DFSPH, Bender and Koschier
 * 2015 and 2017). The water keeps its volume, and time steps are as long as a particle needs for a part of its own
 * size, not as short as waves of sound ask for. Two things differ from the papers. One solver does the work of two: it
 * keeps the flow free of divergence and takes back, little by little, what the density is too high; a second solver for
 * the density makes standing water boil. And its iterations are accelerated (Nesterov's method), so that their number
 * grows with the depth in particles and not with its square. Walls of the box have no particles but closed forms.
 *
 * The particles are in a buffer that virga_water_step takes as it is:
 *
 *     virga_fluid_add(fluid, &block);                 // once
 *
 *     virga_fluid_step(fluid, cmd, &info);            // each frame, outside rendering
 *     virga_fluid_particles(fluid, &buffer, &count);
 *     virga_water_step(water, cmd, &water_info);
 *
 * What is shown (tests/fluid): the front of a collapsing column runs as Martin and Moyce measured (1952); the depth of
 * standing water is kept within 1 %, and its pressure is hydrostatic within 2 % of that at the floor; its particles
 * come to rest at less than 0.02 m/s; a collapse loses energy in every step. Water and a body that it moves keep their
 * momentum together, and lose energy. A cube eight spacings wide floats at the depth of Archimedes within 5 %.
 *
 * Deterministic: the same calls with the same values give the same bits, for any number of threads. The device decides
 * on substeps and iterations; the host never waits for it.
 * Thread-safety: as virga/vulkan.h says. */
#ifndef VIRGA_FLUID_H
#define VIRGA_FLUID_H

#include <virga/shared/body_near.h>
#include <virga/shared/fluid_body.h>
#include <virga/shared/particle.h>
#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_fluid virga_fluid; /* opaque */

typedef struct virga_fluid_def {
    uint32_t size, cookie;

    /* [64; 2097152] particles; 636 bytes each. Default 65536. */
    uint32_t max_particles;

    /* [4096; 16777216] cells of the neighbour grid, 8 bytes each. A cell is two spacings wide, and the grid has four
     * cells more than the box on each axis. Default 262144. */
    uint32_t max_cells;

    /* [1; 64] substeps of a step; see settings.cfl for how many are needed. Each that is recorded and not needed costs
     * about 0.5 ms on two cores of software Vulkan, most of it for the iterations that it might have had. Default 8. */
    uint32_t max_substeps;

    /* [1; 100] iterations of the solver in a substep. Each that is recorded and not needed costs about 0.02 ms there.
     * Water that is deeper than this many particles takes some substeps to feel its weight. Default 20. */
    uint32_t max_iterations;

    /* [0; VIRGA_FLUID_MAX_BODIES] bodies. With them each particle has 32 bytes more. Default 0. */
    uint32_t max_bodies;

    /* [4096; 16777216] nodes of the maps of all bodies, 16 bytes each on the device, as much on the host, and as much
     * while they are uploaded. A body has nodes half a spacing apart in a box that is five spacings larger than itself
     * on each axis. Default 262144. */
    uint32_t max_body_nodes;

    /* [256; 1048576] particles that act on a body at once, those within two spacings of its surface; 4 bytes for each
     * of VIRGA_FLUID_MAX_BODIES bodies. Further ones do not push it. Default 16384. */
    uint32_t max_contacts;

    /* [0; 1048576] particles that water of the ground can be at once; at most max_particles, of which they are a part.
     * 32 bytes each, and 8 bytes for every particle. See virga_fluid_exchange_get. Default 0: no water is
     * exchanged. */
    uint32_t max_exchanged;
} virga_fluid_def;

VIRGA_API virga_fluid_def virga_default_fluid_def(void);

typedef struct virga_fluid_settings {
    uint32_t size, cookie;

    /* [0.0001; 10] distance of particles at rest (m). A particle stands for spacing_m^3 of water. Smaller is finer and
     * slower: half of it has eight times as many particles, and twice as many substeps. Default 0.02. */
    float spacing_m;

    /* [-10000; 10000] the box that the water is in: two opposite corners (m), relative to an origin of the host's
     * choice, which is also that of the particles. Its walls let water slide. Each side is at least four spacings long.
     * Default (-0.5, 0, -0.5) to (0.5, 1, 0.5). */
    float low_m[3], high_m[3];

    /* [-1000; 1000] acceleration (m/s^2). For a box that moves: of gravity less that of the box. Default (0, -9.81, 0).
     */
    float gravity_m_s2[3];

    /* [0; 10] kinematic viscosity (m^2/s). That of water, 1e-6, is far less than the resolution shows: a little more
     * calms the noise of particles. Limited to what is stable. Default 0.001. */
    float viscosity_m2_s;

    /* [0.05; 1] how far a particle may move in a substep, in spacings. A substep takes cfl spacing_m / v, for the speed
     * v of the fastest particle, or for v = sqrt(2 g spacing_m) if that is more. With bodies it takes cfl spacing_m /
     * (v + sqrt(20 g spacing_m)), v being the speed of the fastest particle or driven body. Default 0.4. */
    float cfl;

    /* [0.000001; 0.01] at which mean error the iterations of the solver end: what the density would still grow by in a
     * substep, as a part of it. There are at least 4 iterations, and at most def.max_iterations. Default 0.0001. */
    float solver_error;

    /* (def.max_exchanged above 0) Particles that have come to rest go to the ground, and those that are outside the
     * box. While the ground does not read them they wait. Default true. */
    bool gives_back;

    /* Those that come nearer than 0.75 spacings to a side of the box or its ceiling go to the ground, too, as if there
     * were no walls. Default false. */
    bool open_sides;

    /* [0; 10] m/s; [0; 60] s; [0; 100] m: a particle has come to rest when it was slower than this for so long, lower
     * than this above the floor of the box, and outside the region of the step. Defaults 0.1, 0.25 and 0.05. */
    float rest_speed_m_s, rest_s, rest_height_m;

    /* [0; 10] m/s: the same speed for particles on the floor that have few others around them. Such water is a film,
     * which the ground stops: the solver's floor has no friction. Default 0.5. */
    float film_speed_m_s;
} virga_fluid_settings;

VIRGA_API virga_fluid_settings virga_default_fluid_settings(void);

/* Allocates, and builds pipelines when virga_context_def.pipeline_build_mode says so. VIRGA_DEGRADED: pools were made
 * smaller to fit the context's memory_budget; the log says how small. Errors as virga_context_create; *fluid is NULL
 * then. */
VIRGA_API virga_result virga_fluid_create(virga_context *context, const virga_fluid_def *def, virga_fluid **fluid);

/* Destroys it and sets *fluid to NULL. Accepts NULL. Frames in flight may still use it: its resources are freed when
 * they have completed. */
VIRGA_API void virga_fluid_destroy(virga_fluid **fluid);

/* Returns VIRGA_OK if its pipelines are built, VIRGA_NOT_READY if some are missing, or the error of one that could not
 * be built. See virga_pipelines_build. Costs nothing. */
VIRGA_API virga_result virga_fluid_ready(const virga_fluid *fluid);

/* Applies new settings from the next step on. Out of range: clamped, logged, VIRGA_DEGRADED. NaN, infinity, a wrong
 * cookie, a box with a side of less than four spacings, or one that needs more cells than max_cells:
 * VIRGA_ERROR_INVALID, and nothing changes. */
VIRGA_API virga_result virga_fluid_set(virga_fluid *fluid, const virga_fluid_settings *settings);

/* Reads the current settings. */
VIRGA_API void virga_fluid_get(const virga_fluid *fluid, virga_fluid_settings *settings);

/* Returns the device memory in bytes that virga_fluid_create will allocate at most, with eight frames in flight. */
VIRGA_API VkDeviceSize virga_fluid_estimate(const virga_fluid_def *def);

/* A block of water: a lattice of particles, half a spacing inside its faces. */
typedef struct virga_fluid_block {
    /* [-10000; 10000] two opposite corners (m). A side has as many particles as spacings fit, rounded to the nearest.
     * */
    float low_m[3], high_m[3];

    /* [-1000; 1000] m/s. */
    float velocity_m_s[3];
} virga_fluid_block;

/* Adds a block of water in the next step. Its particles follow those that are there, x running fastest, then y, and
 * have their number as id. Where there is water already, the solver pushes it apart. Up to 16 blocks between two steps.
 * VIRGA_ERROR_INVALID, with a line in the log, and nothing is added: a value out of its range, a block without
 * particles, one block too many, or more particles than there is room for. */
VIRGA_API virga_result virga_fluid_add(virga_fluid *fluid, const virga_fluid_block *block);

/* Removes all water, also blocks that were not yet added, what is on its way to and from the ground, and all bodies.
 * The host's next particle has the id 0 again. */
VIRGA_API virga_result virga_fluid_clear(virga_fluid *fluid);

/* ---- bodies
 *
 * A body is a closed triangle mesh. Water is kept out of it and pushed by it; a body with a density is pushed back, and
 * falls, floats, turns and sinks. The walls of the box stop it, other bodies do not. Its surface lets water slide.
 *
 * When a body is added, the solver makes a map of it: how much of a kernel's volume is in the body, wherever a particle
 * may come near it (volume maps, Bender et al. 2019). Particles on the surface (Akinci et al. 2012) would have to be
 * sorted in each substep, and they make flat faces rough. */

typedef struct virga_fluid_body {
    /* Triangles: three floats at the start of each vertex, `stride` bytes apart, and three indices for each triangle.
     * Wound either way, but all the same way, and without holes. Parts may overlap. At least a spacing thick where it
     * is to keep water out. Copied. */
    const float *positions;
    uint32_t stride, vertex_count;
    const uint32_t *indices;
    uint32_t index_count;

    /* [0.05; 100] over that of water (specific gravity). 0: the host drives it, and water does not move it. */
    float density;

    /* [0; 10] of Coulomb's friction on the walls of the box. */
    float friction;

    /* [-10000; 10000] where the mesh's origin is (m), and how it is turned: a quaternion x, y, z, w; all zero: not. */
    float position_m[3], rotation[4];

    /* [-1000; 1000] of its centre of mass (m/s), and [-100; 100] about the axes of the world (rad/s). Not read for a
     * body that the host drives. */
    float velocity_m_s[3], spin_rad_s[3];
} virga_fluid_body;

/* Adds a body in the next step, and sets *index to its number. Water that is there already is pushed out. The mesh is
 * turned into a map here: it takes some milliseconds for a cube, and up to some seconds for ten thousand triangles. Its
 * memory comes from the host's callbacks. settings.spacing_m cannot change while there are bodies.
 *
 * VIRGA_ERROR_INVALID, with a line in the log: a value out of its range, one body or node too many, a mesh with holes,
 * or one thinner than its map can show. VIRGA_ERROR_OUT_OF_MEMORY. */
VIRGA_API virga_result virga_fluid_body_add(virga_fluid *fluid, const virga_fluid_body *body, uint32_t *index);

/* Where a body is. */
typedef struct virga_fluid_pose {
    /* Of the mesh's origin (m), and the turn of the mesh, a quaternion x, y, z, w. */
    float position_m[3], rotation[4];

    /* Of its centre of mass (m/s), and about the axes of the world (rad/s). */
    float velocity_m_s[3], spin_rad_s[3];

    /* Where its centre of mass is (m). */
    float center_m[3];

    /* The frame whose step left it there; 0: it was not stepped yet. */
    uint64_t frame_index;
} virga_fluid_pose;

/* (a body without density) Where the body is at the end of the next step; position_m and rotation are read. It moves
 * there evenly. A body that would be faster than 100 m/s or 100 rad/s is put there without a push. Without a call it
 * stays. VIRGA_ERROR_INVALID: no such body, one with density, or a number that is not finite. */
VIRGA_API virga_result virga_fluid_body_drive(virga_fluid *fluid, uint32_t index, const virga_fluid_pose *pose);

/* Reads where a body is, by the newest completed frame. False: there is no such body. */
VIRGA_API bool virga_fluid_body_get(virga_fluid *fluid, uint32_t index, virga_fluid_pose *pose);

/* Arguments of one step. */
typedef struct virga_fluid_step_info {
    /* [0; 1] time of the step (s). 0: particles are added, and nothing moves. It is divided into the substeps that
     * settings.cfl asks for, at most def.max_substeps: longer ones than asked for lose precision. */
    float dt_s;

    /* `count` virga_particle_gpu from `offset` on that are added before the step; a storage buffer, ready to be read by
     * compute shaders. The offset is a multiple of the device's minStorageBufferOffsetAlignment. Positions and
     * velocities count; ids are given anew, `share` is not read, and positions that are not finite make particles that
     * stay out. So do all of a frame that the device did not execute. VK_NULL_HANDLE is allowed if count is 0. */
    VkBuffer particles;
    VkDeviceSize offset;
    uint32_t count;

    /* [-10000; 10000] corners (x, z) of the region in which water of the ground becomes particles, and none goes back
     * (m, from the particles' origin). Limited to the box. If region_high_m is not above region_low_m there is none. */
    float region_low_m[2], region_high_m[2];

    /* (def.max_exchanged above 0; optional) As virga_water_leavers_get returns them, of the newest step of water with
     * these particles: its spray. Particles whose droplets now fly on their own end, as their water is with the
     * droplets, which land on the ground (virga_water_settings.hand_over). VK_NULL_HANDLE: they go along unseen, and
     * their water is there twice. */
    VkBuffer leavers;

    /* Bytes from its start. 0: all of it. */
    VkDeviceSize leavers_size;
} virga_fluid_step_info;

/* Moves the water on by the time of a step. Outside rendering, at most once per frame. */
VIRGA_API virga_result virga_fluid_step(virga_fluid *fluid, VkCommandBuffer cmd, const virga_fluid_step_info *info);

/* A range of a buffer, in bytes. */
typedef struct virga_fluid_buffer {
    VkBuffer buffer;
    VkDeviceSize offset, size;
} virga_fluid_buffer;

/* Reads where the particles are: `count` virga_particle_gpu, in the order in which they were added, as the newest step
 * left them. Ready to be read by transfers and compute shaders. Particles outside the box stay where they are. The
 * first def.max_exchanged are for water of the ground; those with share 0 are none. */
VIRGA_API void virga_fluid_particles(const virga_fluid *fluid, virga_fluid_buffer *particles, uint32_t *count);

/* ---- water of the ground
 *
 * Where a tyre drives through a puddle, the puddle's water is simulated, and what has come to rest behind the tyre is a
 * puddle again. The solver and the ground tell each other by two lists in a buffer of the solver:
 *
 *     virga_fluid_step(fluid, cmd, &info);               // what the ground gave comes in; what is at rest goes
 *     virga_fluid_exchange_get(fluid, &exchange);
 *     ... ground_info.exchange.buffer = exchange.buffer; and so on
 *     virga_ground_step(ground, cmd, &ground_info);      // the other side
 *
 * or, with a scene, by virga_scene_frame.exchange. A particle has spacing_m^3 of water, rounded to whole nanolitres.
 * All water is counted to the nanolitre: taken_nl of the ground's statistics is taken_nl here and what is in the first
 * list; given_nl here is given_nl and given_off_ground_nl there and what is in the second. With spray, the water of the
 * particles is taken_nl less given_nl, sprayed_nl and rest_nl. A full solver leaves the
 * water in the cells. Use a spacing that divides the side of a cell: with others the particles of a cell stand wider,
 * and the water is a little higher at first. The floor of the box is best at the height of the ground. Costs two passes
 * of one workgroup over the particles (about 0.2 ms for 10,000 of them on software Vulkan). */
typedef struct virga_fluid_exchange {
    /* A virga_exchange_gpu and its lists (virga/shared/exchange.h), for virga_ground_exchange. VK_NULL_HANDLE: nothing
     * is exchanged, or the solver was not stepped yet. */
    VkBuffer buffer;
    VkDeviceSize offset, size;

    /* The region of the newest step, limited to the box: x and z (m), from the origin of the particles. */
    float low_m[2], high_m[2];
} virga_fluid_exchange;

/* Reads where the exchange with the ground is. Costs nothing. */
VIRGA_API void virga_fluid_exchange_get(const virga_fluid *fluid, virga_fluid_exchange *exchange);

/* Reads where the pressures of the particles are: two floats for each, over the density of water (m^2/s^2). The first,
 * times 1000 kg/m^3, is the pressure in pascals, a mean over the particle and its neighbours. The second is the
 * solver's own, with which the next substep begins. Ready to be read by transfers and compute shaders. */
VIRGA_API void virga_fluid_pressures(const virga_fluid *fluid, virga_fluid_buffer *pressures);

/* Reads where the bodies are: VIRGA_FLUID_MAX_BODIES virga_fluid_body_gpu, as the newest step left them; for hosts that
 * draw a body in the frame of its step. Ready to be read by transfers and compute shaders. Size 0: there are none. */
VIRGA_API void virga_fluid_bodies(const virga_fluid *fluid, virga_fluid_buffer *bodies);

/* Reads where the nearest body to each particle is: a virga_body_near_gpu for each, in the order of the particles, as
 * the newest step left them; for virga_water_step_info.bodies. Bodies farther away than two spacings count as none. At
 * edges, which the maps of bodies round, the share is 0.9 in the mean. Ready to be read by transfers and compute
 * shaders. Size 0: there are no bodies, or no particles. */
VIRGA_API void virga_fluid_bodies_near(const virga_fluid *fluid, virga_fluid_buffer *found);

/* The newest statistics of completed frames. */
typedef struct virga_fluid_stats {
    /* 0: none yet. */
    uint64_t frame_index;

    /* Particles, and those of them that the last substep moved: others are outside the box, or too many in one cell. */
    uint32_t particles, moved;

    /* Substeps of the step, and the solver's iterations in them. */
    uint32_t substeps, iterations;

    /* Mean error of the solver in the last substep. More than settings.solver_error: the iterations were too few. */
    float solver_error;

    /* Speed of the fastest particle after the step (m/s). */
    float max_speed_m_s;

    /* Particles that touched bodies in the last substep, and those that found no room (def.max_contacts). */
    uint32_t contacts, contacts_dropped;

    /* (def.max_exchanged above 0) Particles that there is room for, for water of the ground; and those for which there
     * was none in the ground's newest step: their water is still in the cells. */
    uint32_t free, waiting;

    /* Water of a particle; all that came from the ground, and all that went to it (nl). */
    uint32_t particle_nl;
    uint64_t taken_nl, given_nl;

    /* All that left as droplets which fly on their own; and what their particles had more than the droplets got, or
     * less: it goes to the ground with the next particle (nl). That is only what floats round, if the particles of the
     * water have the volume of these. */
    uint64_t sprayed_nl;
    int64_t rest_nl;
} virga_fluid_stats;

VIRGA_API void virga_fluid_stats_get(virga_fluid *fluid, virga_fluid_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
