/* libdrillmbd - the hole by sections: the wall's constants by measured depth. */
#ifndef DRILLMBD_HOLE_H
#define DRILLMBD_HOLE_H

#include "model.h"

DMB_C_BEGIN

enum {
    DMB_HOLE_STEP = 0, /* the values hold up to the next section, or on and on */
    DMB_HOLE_LINE = 1  /* they go in straight lines to those of the next section */
};
/* A section of the hole: cased, open, washed out, coal, rock. Above the first one the values of dmb_wall_def hold, and
 * every field left at -1 is that of dmb_wall_def. The laws and all other values are those of dmb_wall_def everywhere.
 * All values go over smoothly: a step of `transition` m around `depth` (two parabolas that meet there), the breakpoint
 * between two lines by one parabola within `transition`/2 on both sides. So the wall pushes along the axis where its
 * diameter changes, and no energy is made. */
typedef struct dmb_hole_section {
    uint32_t struct_size;
    int32_t shape;      /* DMB_HOLE_...; default DMB_HOLE_STEP; the last one must be a step */
    double depth;       /* [m] measured depth where it begins; strictly increasing; default 0 */
    double transition;  /* [m] > 0; those of neighbours may not overlap, nor may the radius change by more than 1 m/m;
                           default 0.1 */
    double diameter;    /* [m] > 0; default -1 */
    double stiffness;   /* [N/m^(n+1)] K per metre of pipe, > 0; default -1 */
    double restitution; /* [-] 0 .. 1 (> 0 for FLORES); default -1 */
    double damping;     /* [N s/m2] c per metre of pipe, of KELVIN_VOIGT and IMPACT, >= 0; default -1 */
    double mu_static;   /* [-] >= mu_dynamic for STRIBECK and BRISTLE; default -1 */
    double mu_dynamic;  /* [-] >= 0; default -1 */
    double strength;    /* [Pa] unconfined compressive strength of the wall, >= 0; returned by
                           dmb_query_hole, no force depends on it; default 0 */
    char name[24];      /* returned by dmb_query_hole; default "" */
} dmb_hole_section;
DMB_SIZED_STRUCT(dmb_hole_section)
/* Adds sections below those that the model has, sections with the same struct_size, 1 .. 2^18 of them in all; the wall
 * may be added before or after. dmb_model_compile refuses overlapping transitions, a line without an end, radii that
 * change too fast, and parts wider than the hole (DMB_ERR_GEOMETRY). Errors: DMB_ERR_VALUE, _NOT_FINITE,
 * _STRUCT_SIZE, _NO_MEMORY; no section is added then. A query of the hole at a depth is O(log sections). */
DMB_API int32_t dmb_model_add_hole_sections(dmb_model *model, const dmb_hole_section *sections, uint32_t count);

DMB_C_END
#endif
