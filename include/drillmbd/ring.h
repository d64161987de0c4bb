/* libdrillmbd - stabilisers on strings, and centralisers, reamers, collars. */
#ifndef DRILLMBD_RING_H
#define DRILLMBD_RING_H

#include "model.h"

DMB_C_BEGIN

/* A stabiliser, centraliser or other body of revolution at any place of a string, rigid with the section of the pipe at
 * its middle. Its mass and inertia are added to those of the pipe, which bends under it as before. It meets the wall at
 * its middle, by the laws of the wall, as `length` metres of pipe of its diameter; the pipe keeps its own contact. On
 * flexible pipes it has a node of its own, which divides an element; within a quarter of the pipe's diameter of a node
 * that node carries it on a rigid arm. On axial-torsional pipes, which lie on the wall, the node rubs at the
 * stabiliser's diameter. Its place in queries, loads, springs, joints and forces is {its id, 0, 0}: the middle of the
 * stabiliser. Torque and drag by the soft string (dmb_analysis_torque_drag) refuses strings with stabilisers. */
typedef struct dmb_stabiliser_def {
    uint32_t struct_size;
    uint32_t pipe;         /* [-] number along the string; default 0 */
    dmb_id string;         /* {0, 0}: the model's first string */
    double fraction;       /* [-] 0 .. 1 of the pipe's length: its middle; default 0.5 */
    double outer_diameter; /* [m] that meets the wall, >= outer diameter of the pipe, <= hole; default 0.09 */
    double length;         /* [m] > 0; default 0.3 */
    double mass;           /* [kg] 0 (default): of a hollow cylinder around the pipe, of `density` */
    double inertia[2];     /* [kg m2] about its axis and across, at its middle, the first <= twice the second;
                              0 (default): of that cylinder with its mass; shape (2) */
    double density;        /* [kg/m3] > 0, also for its buoyancy: its volume is mass/density; default 7850 */
    char name[24];         /* for messages, ends with 0; default "" */
    double added_mass[2];  /* [kg] of mud that goes along with it, besides that of the pipe under it, along its axis and
                              across, >= 0; default 0, and -1 across: by added_mass of the environment, of the mud it
                              displaces beyond the pipe, its ends left out; shape (2) */
} dmb_stabiliser_def;
DMB_SIZED_STRUCT(dmb_stabiliser_def)
/* Adds a stabiliser; pipes may be added before or after. stabiliser may be NULL. Errors: DMB_ERR_VALUE, _NOT_FINITE,
 * _ID, _STRUCT_SIZE, _NO_MEMORY. dmb_model_compile refuses pipes that are not there (DMB_ERR_VALUE), stabilisers that
 * overlap, are thinner than their pipe or too wide for the hole (DMB_ERR_GEOMETRY). */
DMB_API int32_t dmb_model_add_stabiliser(dmb_model *model, const dmb_stabiliser_def *def, dmb_id *stabiliser);

DMB_C_END
#endif
