/* fluid_gpu.h - the fluid effect's uniform block and state. Internal to Virga. */
#ifndef VIRGA_SHARED_FLUID_GPU_H
#define VIRGA_SHARED_FLUID_GPU_H

#include "fluid_body.h"
#include "particle_grid.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_fluid_step_gpu virga_fluid_step_gpu;
typedef struct virga_fluid_add_gpu virga_fluid_add_gpu;
typedef struct virga_fluid_state_gpu virga_fluid_state_gpu;
typedef struct virga_fluid_shape_gpu virga_fluid_shape_gpu;
typedef struct virga_fluid_shapes_gpu virga_fluid_shapes_gpu;
#endif

#define VIRGA_FLUID_LANES       VIRGA_GRID_LANES
#define VIRGA_FLUID_LIST_TEXELS 16 /* of four neighbours each, for every particle; see shaders/fluid/pairs.glsl */
/* Sums of errors in fixed point: those of a workgroup, and those of all of them, which fit into 32 bits for two million
 * particles. */
#define VIRGA_FLUID_ERROR_ONE   1048576.0
#define VIRGA_FLUID_ERROR_MAX   262144u /* of one particle */
#define VIRGA_FLUID_ERROR_SHIFT 8u      /* from a workgroup's sum to the sum of all */

/* Bits of the specialisation constant 0 of all passes. */
#define VIRGA_FLUID_FORM_BODIES   1u
#define VIRGA_FLUID_FORM_EXCHANGE 2u

/* Maps of bodies, see fluid/body_mesh.h. */
#define VIRGA_FLUID_MAP_GRADIENT 4.0 /* largest gradient (1 / spacing) */
#define VIRGA_FLUID_MAP_REACH    2.5 /* largest distance (spacings) */
#define VIRGA_FLUID_BODY_POINTS  64  /* of a body, that the walls of the box stop */
#define VIRGA_FLUID_TOUCHES      2   /* bodies that act on a particle at once */

/* One step. Lengths in m, where nothing else is said. The first members are those of virga_particle_step_gpu. */
struct virga_fluid_step_gpu {
    float cell_m;     /* side of a cell: the kernel's radius, two spacings */
    float inv_cell_m; /* 1/m */
    uint particles;   /* slots */
    uint max_cells;
    float spacing_m;
    float inv_spacing_m; /* 1/m */
    float low_m[3];      /* inner faces of the box */
    float high_m[3];
    float gravity_m_s2[3];
    float viscosity_m2_s;
    float dt_s; /* time of the whole step */
    float cfl;  /* distance of a substep, in spacings */
    uint max_substeps;
    float solver_error; /* mean error at which iterations end: growth of the density in a substep */
    int first_cell[3];  /* of the grid */
    uint dims[3];
    uint stride; /* of the lists of neighbours: texels from one to the next of a particle */
    uint bodies;
    uint max_contacts;    /* of each body */
    float body_speed_m_s; /* of the fastest driven body */
    /* Water that goes to the ground and comes from it. */
    uint max_particles;
    uint max_exchanged;
    uint exchanged; /* slots from 0 on, of particles that come from the ground */
    uint particle_nl;
    uint gives_back;       /* 1: particles at rest go to the ground */
    uint open_sides;       /* 1: and those that touch sides or ceiling of the box */
    float rest_speed2;     /* m^2/s^2, a slower particle is at rest */
    float film_speed2;     /* the same where water is thin */
    float rest_s;          /* for that long */
    float rest_top_m;      /* below that height */
    float region_low_m[2]; /* x and z: there none is given back */
    float region_high_m[2];
};

/* What does not change of a body. Lengths in m, in the axes of its mesh, from its center of mass. */
struct virga_fluid_shape_gpu {
    float low[3]; /* first node of its map */
    float inv_node_m;
    uint dims[3]; /* nodes */
    uint first_node;
    float center[3];      /* of mass, from the mesh's origin */
    float inv_mass;       /* mass of a particle over its own; 0: driven by the host */
    float inertia[6];     /* over the mass of a particle (m^2): xx, yy, zz, xy, xz, yz */
    float inv_inertia[6]; /* its inverse */
    float response;       /* how much it yields to a particle's pressure, see neighbours.comp */
    float radius_m;       /* of the ball that holds its map */
    float friction;       /* on the walls of the box */
    uint first_point;     /* after the nodes of all bodies: position and 0 */
    uint points;
};

struct virga_fluid_shapes_gpu {
    virga_fluid_shape_gpu of[VIRGA_FLUID_MAX_BODIES];
};

/* Particles that are added before a step: a block of them, or those of a host's buffer. */
struct virga_fluid_add_gpu {
    float low_m[3]; /* position of the first particle */
    float spacing_m;
    uint counts[3]; /* particles along each axis; 0: from the host's buffer */
    uint first_slot;
    float velocity_m_s[3];
    uint count;
    uint first_id;
};

/* Written by the passes of a step; read back as statistics. */
struct virga_fluid_state_gpu {
    float time_left_s;        /* of the step */
    uint substeps;            /* of the step, with dt above 0 */
    uint iterations;          /* of the step, all substeps */
    float solver_error;       /* of the newest substep */
    uint moved;               /* particles of the newest substep */
    uint max_speed2;          /* bits of the largest speed squared (m^2/s^2), of all particles */
    float dt_s;               /* of the substep */
    uint error;               /* sum of an iteration, in fixed point */
    uint iteration;           /* of the present loop */
    uint groups_done;         /* workgroups of an iteration that have ended */
    uint slot_groups[3];      /* indirect arguments: an invocation for each slot; 0 after the last substep */
    uint fluid_groups[3];     /* an invocation for each sorted particle */
    uint loop_groups[3];      /* the same, 0 when iterations have ended */
    uint body_groups[3];      /* a workgroup for each body */
    uint loop_body_groups[3]; /* the same, 0 when iterations have ended */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_OFFSET(virga_fluid_step_gpu, spacing_m, sizeof(virga_particle_step_gpu));
VIRGA_ASSERT_SIZE(virga_fluid_step_gpu, 176);
VIRGA_ASSERT_SIZE(virga_fluid_add_gpu, 52);
VIRGA_ASSERT_SIZE(virga_fluid_state_gpu, 100);
VIRGA_ASSERT_SIZE(virga_fluid_shape_gpu, 116);
#undef uint
#endif

#endif
