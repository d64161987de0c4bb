#ifndef DMB_FORCE_CONTACT_LAW_H
#define DMB_FORCE_CONTACT_LAW_H

#include <stdint.h>

#include "drillmbd/scene.h"
#include "force/friction_law.h"
#include "force/normal_law.h"
#include "math/mat6.h"

/* A contact ring on a six-DOF node that can touch the wall. The compile step creates it. */
typedef struct dmb_site {
    double offset;    /* [m] along body x from the node */
    double radius;    /* [m] of the ring */
    double clearance; /* [m] hole radius less ring radius, >= 0 */
    double length;    /* [m] length of wall that it represents */
    dmb_id part;      /* string or body */
    uint32_t pipe;    /* pipe whose far end it is on; DMB_NONE: rig end; 0 for a body */
    uint32_t node;
} dmb_site;

/* An axial-torsional node rubbing on the wall (Johancsik): normal force from its weight and from tension in curved
 * holes. */
typedef struct dmb_axial_torsional_site {
    double radius; /* [m] */
    double length; /* [m] of wall that the contact point represents */
    dmb_id part;
    uint32_t pipe;
    uint32_t node;
} dmb_axial_torsional_site;

/* Force and tangent of a contact ring on the wall of the hole, for numbers that are doubles or lanes of doubles
 * (math/real.h).
 *
 * In body axes, with n, t, b the contact frame (n outward, t along the hole, b = t x n), V the velocity of the ring's
 * centre and r its radius, three generalised directions are sufficient:
 *     j_n = (n; 0)    j_t = (t; -r b)    j_b = (b; r t)          contact speed v_k = j_k . V
 *     wrench on the ring = -N j_n + F_t j_t + F_b j_b          (eq:contact.directions, eq:contact.wrench)
 * so that drag and torque result from one friction force. The tangent follows by the product rule: change of the forces
 * with penetration and speeds, rotation of n and b around the axis (the pendulum term N/e), rotation of the frame as
 * the ring moves along a bend of the hole (eq:hole.advance), and rotation of the body (eq:contact.pendulum). */

#define DMB_CONTACT_PINNED 1e-9       /* [m] at a smaller distance from the axis the direction of n is constant */
#define DMB_CONTACT_PENETRATION 1e-15 /* [m] smallest penetration of a ring without clearance */

typedef struct dmb_contact_frame {
    dmb_real n[3], t[3], b[3];     /* [-] body axes */
    dmb_real turn_t[3], turn_b[3]; /* [m] -r b and r t: rotational parts of j_t and j_b */
    dmb_real radius, distance;     /* [m] r; e from the axis to the ring's centre */
    dmb_real V[6];                 /* [m/s, rad/s] */
    dmb_real speed[3];             /* [m/s] v_n, v_t, v_b */
} dmb_contact_frame;

/* Forces (-N, F_t, F_b) and their derivatives; the derivatives of -N by v_t and v_b are 0. */
typedef struct dmb_contact_force {
    dmb_real F[3];           /* [N] */
    dmb_real by_depth[3];    /* [N/m] dF_k/d penetration */
    dmb_real normal_rate;    /* [N s/m] dF_n/dv_n */
    dmb_real by_speed[2][3]; /* [N s/m] dF_t, dF_b by v_n, v_t, v_b */
    dmb_real elastic;        /* [N] elastic part of N, which the wall stores */
    dmb_real whole;          /* [N/m] N per metre without the restriction N >= 0 */
} dmb_contact_force;

/* ---- Frame and forces ----------------------------------------------------------------------------------------------
 */

/* Sets the contact frame in body axes. R: body to world; normal and tangent of the hole in world axes. radius, distance
 * and V are set by the caller. */
static inline void dmb_contact_frame_at(const dmb_real R[9], const dmb_real normal[3], const dmb_real tangent[3],
                                        dmb_contact_frame *f)
{
    dmb_mat3_tvec(R, normal, f->n);
    dmb_mat3_tvec(R, tangent, f->t);
    dmb_vec3_cross(f->t, f->n, f->b);
    dmb_vec3_scale(-f->radius, f->b, f->turn_t);
    dmb_vec3_scale(f->radius, f->t, f->turn_b);
}

static inline void dmb_contact_speeds(dmb_contact_frame *f)
{
    const dmb_real *w = f->V + 3;
    f->speed[0] = dmb_vec3_dot(f->n, f->V);
    f->speed[1] = dmb_vec3_dot(f->t, f->V) + f->turn_t[0] * w[0] + f->turn_t[1] * w[1] + f->turn_t[2] * w[2];
    f->speed[2] = dmb_vec3_dot(f->b, f->V) + f->turn_b[0] * w[0] + f->turn_b[1] * w[1] + f->turn_b[2] * w[2];
}

/* Contact speeds of statics. Speeds are 0, but friction may act as at a given slip [m/s, rad/s]. */
static inline void dmb_contact_static_speeds(const double slip[2], dmb_contact_frame *f)
{
    for (int i = 0; i < 6; i++) f->V[i] = dmb_real_of(0.0);
    f->speed[0] = dmb_real_of(0.0);
    f->speed[1] = dmb_real_of(slip[0]);
    f->speed[2] = f->radius * slip[1];
}

/* Penetration of a ring, its speed at first touch, and the weight of its damping (dmb_normal_response_at). */
typedef struct dmb_contact_depth {
    dmb_real penetration, impact_speed; /* [m], [m/s] */
    const dmb_normal_touch *touch;
} dmb_contact_depth;

/* Normal force and its derivatives without friction. length [m] is the length of wall that the ring represents. */
static inline void dmb_contact_normal_force(const dmb_local_normal *law, const dmb_contact_frame *f, dmb_real length,
                                            const dmb_contact_depth *at, dmb_contact_force *out)
{
    dmb_normal_response N;
    dmb_normal_response_at(law, at->penetration, f->speed[0], at->impact_speed, at->touch, &N);
    out->F[0] = -length * N.force;
    out->by_depth[0] = -length * N.d_depth;
    out->normal_rate = -length * N.d_rate;
    out->elastic = length * N.elastic;
    out->whole = N.whole;
}

/* Normal force and derivative of the rings `own` give way to a force and its derivative by the depth. */
static inline void dmb_contact_set_own(dmb_mask own, dmb_real force, dmb_real by_depth, dmb_contact_force *out)
{
    out->F[0] = dmb_real_select(own, -force, out->F[0]);
    out->by_depth[0] = dmb_real_select(own, -by_depth, out->by_depth[0]);
    out->normal_rate = dmb_real_select(own, dmb_real_of(0.0), out->normal_rate);
}

/* Adds the friction force at N = -F[0]. From the friction law: F its force, by_speed its tangent (2,2), by_normal
 * dF/dN. */
static inline void dmb_contact_add_friction(const dmb_real F[2], const dmb_real by_speed[4],
                                            const dmb_real by_normal[2], dmb_contact_force *out)
{
    for (int k = 0; k < 2; k++) {
        out->F[1 + k] = F[k];
        out->by_depth[1 + k] = by_normal[k] * -out->by_depth[0];
        out->by_speed[k][0] = by_normal[k] * -out->normal_rate;
        out->by_speed[k][1] = by_speed[2 * k];
        out->by_speed[k][2] = by_speed[2 * k + 1];
    }
}

static inline void dmb_contact_wrench(const dmb_contact_frame *f, const dmb_contact_force *c, int friction,
                                      dmb_real wrench[6])
{
    for (int i = 0; i < 3; i++) {
        wrench[i] = c->F[0] * f->n[i];
        wrench[3 + i] = dmb_real_of(0.0);
        if (!friction) continue;
        wrench[i] = wrench[i] + c->F[1] * f->t[i] + c->F[2] * f->b[i];
        wrench[3 + i] = c->F[1] * f->turn_t[i] + c->F[2] * f->turn_b[i];
    }
}

/* ---- Tangent -------------------------------------------------------------------------------------------------------
 */

/* K = n row_n^T in the translation rows; the rotation rows are 0, because j_n has no rotational part */
static inline void dmb_contact_set_normal(const dmb_real n[3], const dmb_real *row, dmb_real K[36])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 6; j++) {
            K[6 * i + j] = n[i] * row[j];
            K[18 + 6 * i + j] = dmb_real_of(0.0);
        }
}

/* K += (a; turn) row^T */
static inline void dmb_contact_add_direction(const dmb_real a[3], const dmb_real turn[3], const dmb_real row[6],
                                             dmb_real K[36])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 6; j++) {
            K[6 * i + j] += a[i] * row[j];
            K[18 + 6 * i + j] += turn[i] * row[j];
        }
}

/* Change of the forces with a change dv of the speeds, along the directions: out += sum j_k dF_k/dv . dv */
static inline void dmb_contact_add_speed_change(const dmb_contact_frame *f, const dmb_contact_force *c,
                                                const dmb_real dv[3], int friction, dmb_real out[6])
{
    dmb_vec3_axpy(c->normal_rate * dv[0], f->n, out);
    for (int k = 0; friction && k < 2; k++) {
        const dmb_real s = c->by_speed[k][0] * dv[0] + c->by_speed[k][1] * dv[1] + c->by_speed[k][2] * dv[2];
        dmb_vec3_axpy(s, k == 0 ? f->t : f->b, out);
        dmb_vec3_axpy(s, k == 0 ? f->turn_t : f->turn_b, out + 3);
    }
}

/* w = [-N (b;0) + F_t (0; r n) + F_b (-n; 0)] + sum j_k D_kl (dj_l/dpsi . V): change with a rotation psi around the
 * axis */
static inline void dmb_contact_swing(const dmb_contact_frame *f, const dmb_contact_force *c, int friction,
                                     dmb_real out[6])
{
    for (int i = 0; i < 3; i++) {
        out[i] = c->F[0] * f->b[i];
        out[3 + i] = dmb_real_of(0.0);
        if (!friction) continue;
        out[i] = out[i] - c->F[2] * f->n[i];
        out[3 + i] = f->radius * c->F[1] * f->n[i];
    }
    const dmb_real dv[3] = {dmb_vec3_dot(f->b, f->V), f->radius * dmb_vec3_dot(f->n, f->V + 3),
                            -dmb_vec3_dot(f->n, f->V)};
    dmb_contact_add_speed_change(f, c, dv, friction, out);
}

/* Derivatives of the speeds by rotation of the body. A rotation dtheta turns the frame back relative to the body: d(j .
 * V) = (j x dtheta) . V = (V x j) . dtheta, sum of translation and rotation parts. */
static inline void dmb_contact_rotation_rates(const dmb_contact_frame *f, dmb_real by_rotation[3][3])
{
    dmb_real a[3];
    dmb_vec3_cross(f->V, f->n, by_rotation[0]);
    dmb_vec3_cross(f->V, f->t, by_rotation[1]);
    dmb_vec3_cross(f->V + 3, f->turn_t, a);
    dmb_vec3_add(by_rotation[1], a, by_rotation[1]);
    dmb_vec3_cross(f->V, f->b, by_rotation[2]);
    dmb_vec3_cross(f->V + 3, f->turn_b, a);
    dmb_vec3_add(by_rotation[2], a, by_rotation[2]);
}

/* sum j_k (dF_k/d penetration n ; sum_l D_kl turning_l)^T */
static inline void dmb_contact_force_tangent(const dmb_contact_frame *f, const dmb_contact_force *c, int friction,
                                             dmb_real K[36])
{
    dmb_real by_rotation[3][3], row[6];
    dmb_contact_rotation_rates(f, by_rotation);
    dmb_vec3_scale(c->by_depth[0], f->n, row);
    dmb_vec3_scale(c->normal_rate, by_rotation[0], row + 3);
    dmb_contact_set_normal(f->n, row, K);
    for (int k = 0; friction && k < 2; k++) {
        dmb_vec3_scale(c->by_depth[1 + k], f->n, row);
        dmb_vec3_scale(c->by_speed[k][0], by_rotation[0], row + 3);
        dmb_vec3_axpy(c->by_speed[k][1], by_rotation[1], row + 3);
        dmb_vec3_axpy(c->by_speed[k][2], by_rotation[2], row + 3);
        dmb_contact_add_direction(k == 0 ? f->t : f->b, k == 0 ? f->turn_t : f->turn_b, row, K);
    }
}

/* d wrench / d pose at the ring, shape (6, 6): tangent of the forces + swing (b/e ; 0)^T + rotation of the wrench with
 * the body. */
static inline void dmb_contact_pose_tangent(const dmb_contact_frame *f, const dmb_contact_force *c,
                                            const dmb_real wrench[6], int friction, dmb_real K[36])
{
    const dmb_real zero = dmb_real_of(0.0);
    const dmb_mask pinned = dmb_mask_at_most(f->distance, dmb_real_of(DMB_CONTACT_PINNED));
    const dmb_real pendulum =
        dmb_real_select(pinned, zero, 1.0 / dmb_real_select(pinned, dmb_real_of(1.0), f->distance));
    dmb_real swing[6];
    dmb_contact_force_tangent(f, c, friction, K);
    dmb_contact_swing(f, c, friction, swing);
    for (int i = 0; i < 6; i++) dmb_vec3_axpy(pendulum * swing[i], f->b, K + 6 * i);
    if (dmb_mask_any(
            pinned)) { /* on the axis of a ring without clearance the wall has the same stiffness in every direction */
        const dmb_real hold = dmb_real_select(pinned, c->by_depth[0], zero);
        for (int i = 0; i < 3; i++) dmb_vec3_axpy(hold * f->b[i], f->b, K + 6 * i);
    }
    dmb_mat6_add_skew(dmb_real_of(1.0), wrench, 0, 1, K);
    dmb_mat6_add_skew(dmb_real_of(1.0), wrench + 3, 1, 1, K);
}

/* Adds the effect of a bend of the hole. A displacement dx along the axis moves the closest point by ds = t . dx/(1 - e
 * n . (bend x t)), and the frame turns by bend ds: forces turn with it, and speeds change by bend . (j x V). bend
 * [rad/m] is in body axes. */
static inline void dmb_contact_add_bend(const dmb_contact_frame *f, const dmb_contact_force *c, const dmb_real bend[3],
                                        const dmb_real wrench[6], int friction, dmb_real K[36])
{
    const dmb_real *direction[3] = {f->n, f->t, f->b}, *turn[3] = {NULL, f->turn_t, f->turn_b};
    dmb_real a[3], column[6], row[3], speed[3];
    dmb_vec3_cross(bend, wrench, column);
    dmb_vec3_cross(bend, wrench + 3, column + 3);
    for (int l = 0; l < 3; l++) {
        dmb_vec3_cross(direction[l], f->V, a);
        speed[l] = dmb_vec3_dot(bend, a);
        if (l == 0) continue;
        dmb_vec3_cross(turn[l], f->V + 3, a);
        speed[l] = speed[l] + dmb_vec3_dot(bend, a);
    }
    dmb_contact_add_speed_change(f, c, speed, friction, column);
    dmb_vec3_cross(bend, f->t, a);
    dmb_vec3_scale(1.0 / (1.0 - f->distance * dmb_vec3_dot(a, f->n)), f->t, row);
    for (int i = 0; i < 6; i++) dmb_vec3_axpy(column[i], row, K + 6 * i);
}

/* d wrench / d velocity at the ring: sum j_k D_kl j_l^T, times `factor` */
static inline void dmb_contact_velocity_tangent(const dmb_contact_frame *f, const dmb_contact_force *c, double factor,
                                                int friction, dmb_real K[36])
{
    dmb_real row[6], a[3], turn[3];
    dmb_vec3_scale(c->normal_rate, f->n, row);
    dmb_vec3_zero(row + 3);
    dmb_vec3_scale(dmb_real_of(factor), f->n, a);
    dmb_contact_set_normal(a, row, K);
    for (int k = 0; friction && k < 2; k++) {
        const dmb_real *D = c->by_speed[k];
        for (int i = 0; i < 3; i++) {
            row[i] = D[0] * f->n[i] + D[1] * f->t[i] + D[2] * f->b[i];
            row[3 + i] = D[1] * f->turn_t[i] + D[2] * f->turn_b[i];
        }
        dmb_vec3_scale(dmb_real_of(factor), k == 0 ? f->t : f->b, a);
        dmb_vec3_scale(dmb_real_of(factor), k == 0 ? f->turn_t : f->turn_b, turn);
        dmb_contact_add_direction(a, turn, row, K);
    }
}

#endif
