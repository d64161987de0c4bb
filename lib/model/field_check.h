/* Checks of what is described: of all fields of a struct by its table (fields/fields.h), of single ones beyond those of
 * base/value_check.h, and of inertias. */
#ifndef DMB_MODEL_FIELD_CHECK_H
#define DMB_MODEL_FIELD_CHECK_H

#include <stdbool.h>

#include "base/value_check.h"
#include "drillmbd/scene.h"
#include "fields/bounds.h"
#include "fields/fields.h"
#include "model/model.h"

/* [rad] largest unstressed bend of one element, as of DMB_BEAM_ROTATION_MAX */
#define DMB_REST_ROTATION_MAX 2.5

enum {
    DMB_CHUNKS_MAX = (1 << 24) - 1, /* of one kind: their numbers have 24 bits in an id */
    DMB_NODES_MAX = 1 << 24,        /* so that the storage of 6x6 blocks is counted in 32 bits */
    DMB_SPARSE_NODES = 6, /* nodes from which on a cluster is not solved by dense matrices: where both cost alike */
    DMB_CLUSTER_COLUMNS_MAX = 1200, /* coordinates of a cluster with dense matrices: analyses make them of any */
    DMB_CLUSTER_ROWS_MAX = 4800     /* equations on them, room for locking included */
};

/* Every field by its own bound, in the order of the list. Relations between fields come after it. */
void dmb_check_fields(dmb_check *check, const dmb_model *model, const dmb_field_list *list, const void *def);

/* Options of a call with their defaults, overlaid with those of the caller (may be NULL), each checked by its own
 * bound. Relations between them come after it. */
void dmb_options_get(dmb_check *check, const dmb_field_list *list, const void *given, void *out);

/* Zero, or low <= value <= high. */
void dmb_check_zero_or_within(dmb_check *check, const char *field, double value, double low, double high);
/* low <= value <= high for each of count values; the message names the component. */
void dmb_check_each_within(dmb_check *check, const char *field, const double *values, size_t count, double low,
                           double high);

static inline bool dmb_id_is_none(dmb_id id)
{
    return id.index == 0 && id.generation == 0;
}
/* An id of that kind of this model: DMB_ERR_ID otherwise. `what` is the kind in words. */
void dmb_check_id(dmb_check *check, const dmb_model *model, const char *field, dmb_id id, uint32_t kind,
                  const char *what);
/* The same, or the id that names nothing. */
void dmb_check_id_or_none(dmb_check *check, const dmb_model *model, const char *field, dmb_id id, uint32_t kind,
                          const char *what);

/* A place on a string, a body or a bit: its fraction 0 .. 1, and 0 with pipe 0 on a body or bit. That the string has
 * such a pipe is for the compile step to find out. */
void dmb_check_place(dmb_check *check, const dmb_model *model, const char *field, const dmb_place *place);

/* Sets of free components of motion. Inside the library a set has bit 1 << DMB_X .. 1 << DMB_RZ for a component that is
 * in it. DMB_FREE_... of the interface have these bits FREE_SHIFT further up, so that component indices, which are
 * below 1 << FREE_SHIFT, are none of theirs; the descriptions keep them so. */

enum {
    DMB_FREE_SHIFT = 8,
    DMB_SET_ALL = 63,
    DMB_SET_SIDEWAYS = 1 << DMB_Y | 1 << DMB_Z,
    DMB_SET_TILTING = 1 << DMB_RY | 1 << DMB_RZ,
    DMB_SET_CYLINDRICAL = 1 << DMB_X | 1 << DMB_RX,
    DMB_SET_SPHERICAL = 1 << DMB_RX | 1 << DMB_RY | 1 << DMB_RZ
};

/* The set inside the library of one of the interface that was checked. */
static inline uint8_t dmb_free_set(int32_t mask)
{
    return (uint8_t)(mask >> DMB_FREE_SHIFT & DMB_SET_ALL);
}

/* True if the set is closed under motion (a group of displacements), so that it means the same at every instant. By the
 * brackets of the components, [Ri, Rj] = Rk, [Ri, Tj] = Tk, [Ti, Tj] = 0: any translations without rotation; one
 * rotation with both or none of the translations across it, that along it as one likes; three rotations with all
 * translations or none. Herve 1978. */
static inline bool dmb_set_is_closed(int32_t set)
{
    const int32_t translations = set & 7, rotations = set >> 3;
    if (rotations == 0) return true;
    if (rotations == 7) return translations == 0 || translations == 7;
    const int32_t across = translations & ~rotations;
    return (rotations & (rotations - 1)) == 0 && (across == 0 || across == (7 & ~rotations));
}

/* True if the set means the same at any point of the body's x axis, so that a node anywhere on it will do. */
static inline bool dmb_set_is_axial(int32_t set)
{
    return set == DMB_SET_ALL || (set & ~DMB_SET_CYLINDRICAL) == 0;
}

/* DMB_ERR_VALUE for a number that is no set of DMB_FREE_..., 0 and component indices among them. */
void dmb_check_free_set(dmb_check *check, const char *field, int32_t mask);
/* The same, and DMB_ERR_UNSUPPORTED for a set that is not closed. */
void dmb_check_motion_mask(dmb_check *check, const char *field, int32_t mask);

/* Whether a mass distribution with the inertia that the caller gives exists. */

/* xx, yy, zz, xy, xz, yz elements at the centre of mass: positive definite, and no principal moment larger than the sum
 * of the two others. Thin rods and discs lie on that bound and pass. */
void dmb_check_inertia_matrix(dmb_check *check, const char *field, const double J[6]);
/* The same of a solid of revolution: about its axis, and across. */
void dmb_check_inertia_of_revolution(dmb_check *check, const char *field, const double J[2]);
/* A pipe as one rigid body. The rotary inertia of a flexible section belongs to beam theory and is not judged: Euler
 * and Bernoulli leave it out across and keep it about the axis. */
void dmb_check_rigid_pipe_inertia(dmb_check *check, const dmb_pipe_def *def);

#endif
