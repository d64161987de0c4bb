/* Shares of the rigid mass on a node. A node's rigid_mass is the sum of all that is fixed to it; these are its parts,
 * each from the description, as the compile step added them. */
#ifndef DMB_QUERY_MASS_H
#define DMB_QUERY_MASS_H

#include "element/element_type.h"
#include "sim/sim.h"

/* A pipe of a string with its description. */
typedef struct dmb_described_pipe {
    const dmb_pipe_map *map;
    const dmb_pipe_def *def;
    uint32_t string, number;
    int32_t eccentric;
    int32_t reserved;
    double offset[2]; /* [m] of its centre of mass, where eccentric */
} dmb_described_pipe;

/* string and pipe must be valid. O(number of dmb_model_add_pipes calls). */
void dmb_describe_pipe(const dmb_sim *sim, uint32_t string, uint32_t pipe, dmb_described_pipe *out);

/* A rigid pipe without its tool joint. */
void dmb_rigid_pipe_share(const dmb_described_pipe *pipe, dmb_rigid_mass *share);
/* A pipe's tool joint; mass 0 where there is none. */
void dmb_joint_share(const dmb_scene *scene, const dmb_described_pipe *pipe, dmb_rigid_mass *share);
/* Part that eccentricity adds on the near (end 0) or far (end 1) node of an element: a first moment, no mass. */
void dmb_eccentric_share(const dmb_scene *scene, const dmb_described_pipe *pipe, uint32_t element, uint32_t end,
                         dmb_rigid_mass *share);
/* A body or bit, by its number in scene->bodies. */
void dmb_body_share(const dmb_sim *sim, uint32_t body, dmb_rigid_mass *share);

/* 1 where a body or bit, by its number in scene->bodies, is fixed to this end of a string, DMB_ATTACH_START or _END; an
 * id that names nothing is the first string. */
int dmb_body_is_at_end(const dmb_model *model, uint32_t body, uint32_t string, int32_t attach);

/* [J] of a share on its node in the accepted state. */
double dmb_share_kinetic_energy(const dmb_sim *sim, const dmb_rigid_mass *share);

#endif
