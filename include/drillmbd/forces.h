/* libdrillmbd - forces between points: springs and dampers along a line, at any place of a pipe or body.
 * Places of this header: any fraction of a pipe, between nodes by the element's own interpolation, moved by an offset
 * in the axes of the section; the reference point of a body or bit, moved by an offset in its axes; or a point of the
 * ground, part {0, 0}, given by the offset in the world. */
#ifndef DRILLMBD_FORCES_H
#define DRILLMBD_FORCES_H

#include "model.h"
#include "query.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sides on which a spring acts. */
enum { DMB_SPRING_BOTH = 0, DMB_SPRING_TENSION = 1, DMB_SPRING_COMPRESSION = 2 };
/* Curve through the points of a table. */
enum { DMB_TABLE_LINES = 0, DMB_TABLE_CUBIC = 1 };

/* Spring and damper between two points, tension > 0: preload + stiffness e + table(e) + damping e', e the elongation
 * beyond free_length. Two points closer than some 1e-9 m have no direction: the length is sqrt(d^2 + (1e-9 m)^2), so
 * that force, energy and tangent stay those of one potential. Without DMB_FEATURE_DAMPING there is no damper. */
typedef struct dmb_spring_def {
    uint32_t struct_size;
    int32_t acts;                   /* DMB_SPRING_...: TENSION (rope) pulls only, COMPRESSION (buffer) pushes only, the
                                       damper as long as the sum does; default DMB_SPRING_BOTH */
    char name[24];                  /* for messages, ends with 0; default "" */
    dmb_place place_a;              /* part {0, 0} (default): the ground */
    dmb_place place_b;              /* likewise; not both the ground */
    double offset_a[3];             /* [m] of the point from place a in its axes; ground: world; default 0, shape (3) */
    double offset_b[3];             /* [m] shape (3) */
    double free_length;             /* [m] >= 0; -1 (default): the length at time 0 as described, > 0 */
    double stiffness;               /* [N/m] >= 0; default 0 */
    double damping;                 /* [N s/m] >= 0; default 0 */
    double preload;                 /* [N] tension at free_length, < 0 pushes; default 0 */
    const double *table_elongation; /* [m] strictly increasing, shape (table_count); copied */
    const double *table_force;      /* [N] shape (table_count), beyond the ends along the last slopes; copied. Of a
                                       one-sided spring it must not fall */
    uint32_t table_count;           /* [-] 0 (default): none; 2 .. 2^16 */
    int32_t table_kind;             /* DMB_TABLE_LINES (default), or DMB_TABLE_CUBIC: monotone between points, its slope
                                       without jumps */
} dmb_spring_def;
DMB_SIZED_STRUCT(dmb_spring_def)
/* Adds a spring. Errors: DMB_ERR_ID, _VALUE (fields, both ends on the ground or at one point, nothing that acts);
 * dmb_model_compile: DMB_ERR_VALUE (a pipe that is not there; points that move as one), DMB_ERR_GEOMETRY (points that
 * coincide at time 0 with a force between them), DMB_ERR_UNSUPPORTED (axial-torsional pipes in a curved hole). A spring
 * within one rigid body and the ground, or within one element and the ground, costs no coupling of parts; another one
 * connects its parts as a joint does. */
DMB_API int32_t dmb_model_add_spring(dmb_model *model, const dmb_spring_def *def, dmb_id *spring);

typedef struct dmb_spring_state {
    uint32_t struct_size;
    uint32_t reserved;
    double length;       /* [m] between its points */
    double elongation;   /* [m] beyond its free length */
    double speed;        /* [m/s] the elongation grows at */
    double force;        /* [N] tension > 0: elastic + damper */
    double elastic;      /* [N] */
    double damper;       /* [N] */
    double energy;       /* [J] stored, from the free length on, of a one-sided spring from where it is slack */
    double direction[3]; /* [-] from a to b, world frame, shape (3) */
    double point_a[3];   /* [m] world, shape (3) */
    double point_b[3];   /* [m] world, shape (3) */
} dmb_spring_state;
DMB_SIZED_STRUCT(dmb_spring_state)
/* State of a spring. Errors: DMB_ERR_ID. O(1). */
DMB_API int32_t dmb_query_spring(const dmb_sim *sim, dmb_id spring, dmb_spring_state *state);

/* Pose and motion of a point off a place: offset [m] in the axes of the place, shape (3). Errors as dmb_query_pose;
 * DMB_ERR_NULL, _NOT_FINITE of the offset. O(1). */
DMB_API int32_t dmb_query_pose_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_pose *pose);
DMB_API int32_t dmb_query_motion_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_motion *motion);

#ifdef __cplusplus
}
#endif
#endif
