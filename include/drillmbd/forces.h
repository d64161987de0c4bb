/* libdrillmbd - forces between points: springs and dampers along a line, at any place of a pipe or body.
 * Places of this header: any fraction of a pipe, between nodes by the element's own interpolation, moved by an offset
 * in the axes of the section; the reference point of a body or bit, moved by an offset in its axes; or a point of the
 * ground, part {0, 0}, given by the offset in the world. */
#ifndef DRILLMBD_FORCES_H
#define DRILLMBD_FORCES_H

#include "model.h"
#include "query.h"

DMB_C_BEGIN

enum { DMB_SPRING_BOTH = 0, DMB_SPRING_TENSION = 1, DMB_SPRING_COMPRESSION = 2 }; /* sides on which a spring acts */
enum { DMB_TABLE_LINES = 0, DMB_TABLE_CUBIC = 1 };                                /* curve through a table */
/* Spring and damper between two points, tension > 0: preload + stiffness e + table(e) + damping e', e the elongation
 * beyond free_length; its length is sqrt(d^2 + (1e-9 m)^2), since points that meet have no direction. */
typedef struct dmb_spring_def {
    uint32_t struct_size;
    int32_t acts;               /* DMB_SPRING_...: TENSION (rope) pulls, COMPRESSION (buffer) pushes only, the damper
                                   as long as the sum does; default DMB_SPRING_BOTH */
    char name[24];              /* for messages and look-up (names.h), ends with 0; default "" */
    dmb_place place_a, place_b; /* part {0, 0} (default): the ground; not both */
    double offset_a[3];         /* [m] of the point from place a in its axes; ground: world; default 0, shape (3) */
    double offset_b[3];         /* [m] shape (3) */
    double free_length;         /* [m] >= 0; -1 (default): the length at time 0 as described, > 0 */
    double stiffness;           /* [N/m] >= 0; default 0 */
    double damping;             /* [N s/m] >= 0; not there without DMB_FEATURE_DAMPING; default 0 */
    double preload;             /* [N] tension at free_length, < 0 pushes; default 0 */
    const double *table_elongation; /* [m] strictly increasing, shape (table_count); copied */
    const double *table_force; /* [N] shape (table_count); extended along its last slopes; of a one-sided spring it must
                                  not fall; copied */
    uint32_t table_count;      /* [-] 0 (default): none; 2 .. 2^16 */
    int32_t table_kind;        /* DMB_TABLE_LINES (default), or DMB_TABLE_CUBIC: monotone between points */
} dmb_spring_def;
DMB_SIZED_STRUCT(dmb_spring_def)
/* Errors: DMB_ERR_ID, _VALUE; dmb_model_compile: DMB_ERR_VALUE (no such pipe, points that move as one), _GEOMETRY
 * (points that coincide at time 0 with a force between them), _UNSUPPORTED (axial-torsional pipes in a curved hole).
 * Within one body or element and the ground it costs no coupling of parts; else it connects parts as a joint does. */
DMB_API int32_t dmb_model_add_spring(dmb_model *model, const dmb_spring_def *def, dmb_id *spring);

typedef struct dmb_spring_state {
    uint32_t struct_size;
    uint32_t reserved;
    double length, elongation; /* [m] between its points, and beyond its free length */
    double speed;              /* [m/s] the elongation grows at */
    double force;              /* [N] tension > 0: sum of the next two */
    double elastic, damper;    /* [N] */
    double energy;             /* [J] stored, from the free length on, or from where a one-sided one is slack */
    double direction[3];       /* [-] from a to b, world frame, shape (3) */
    double point_a[3];         /* [m] world, shape (3) */
    double point_b[3];         /* [m] world, shape (3) */
} dmb_spring_state;
DMB_SIZED_STRUCT(dmb_spring_state)
DMB_API int32_t dmb_query_spring(const dmb_sim *sim, dmb_id spring, dmb_spring_state *state);

/* The caller's force on up to four places or joint coordinates by their poses, velocities and time, in the axes of
 * `frame`. poses[i]: position [m] in the world (3), rotation matrix to the world, row-major (9); velocities[i] [m/s,
 * rad/s]; forces[i]: force [N] and moment [N m] on the place, 0 when called. Of a joint's coordinate number 0 of each
 * counts: value, speed, force along it. tangent, shape (2, 6 place_count, 6 place_count), row-major, 0 when called, may
 * be NULL: derivatives of the forces by displacements of the places in the same axes, velocities there staying the
 * same; then by velocities. potential: [J] by poses and time, counted as stored energy (`strain`); the other power
 * is work of loads. Returns 0, or nonzero to stop. Pure, from any thread; also called at arguments near those of the
 * run. Followers and circulatory forces are respected. Load steps and factors of buckling leave it alone. */
enum { DMB_PROVIDES_TANGENT = 1, DMB_PROVIDES_POTENTIAL = 2 };
typedef int32_t (*dmb_force_fn)(void *context, double time, uint32_t place_count, const double (*poses)[12],
                                const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential);
typedef struct dmb_force_def {
    uint32_t struct_size;
    int32_t frame;                /* DMB_FRAME_WORLD (default), or DMB_FRAME_BODY: axes of each place */
    char name[24];                /* for messages and look-up (names.h), ends with 0; default "" */
    uint32_t place_count;         /* [-] of places and coordinates, 1 .. 4; default 1 */
    int32_t provides;             /* DMB_PROVIDES_...; a tangent is held against differences when a sim is made
                                     (DMB_ERR_CALLBACK); default 0: built by differences */
    dmb_place place[4];           /* not the ground; or part is a joint: its coordinate; shape (place_count) */
    double offset[12];            /* [m] of each point from its place, in its axes, shape (place_count, 3); default 0 */
    int32_t component[4];         /* of a joint: DMB_X .. DMB_RZ, free in it; shape (place_count); default 0 */
    double pose_step, speed_step; /* [m, rad; m/s, rad/s] of differences, 1e-12 .. 1; default 1e-5 */
    dmb_force_fn callback;        /* required */
    void *callback_context;
} dmb_force_def;
DMB_SIZED_STRUCT(dmb_force_def)
/* Errors as of a spring; DMB_ERR_NULL (callback). It does not act on an open joint. Steady states that move (`steady`
 * of statics) are refused where it acts on moving parts. */
DMB_API int32_t dmb_model_add_force(dmb_model *model, const dmb_force_def *def, dmb_id *force);

/* Pose and motion of a point off a place: offset [m] in the axes of the place, shape (3). Errors as dmb_query_pose,
 * DMB_ERR_NULL. */
DMB_API int32_t dmb_query_pose_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_pose *pose);
DMB_API int32_t dmb_query_motion_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_motion *motion);

DMB_C_END
#endif
