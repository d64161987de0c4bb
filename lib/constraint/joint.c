/* Joints: relative motion of two frames; rows and coordinates of every kind, each with value, gradient J by the
 * relative twist V = (u; w) and the rate JV of that gradient along V, so that C'' = J V' + JV V.
 *
 *     rows                                    equation
 *     -------------------------------------   -------------------------------------------------------
 *     components of p, products of axes       eq:joints.rows (dot_rows)
 *     distance of two points                  |p| - length (distance_row)
 *     knife edge                              u_y = 0 (eq:joints.nonholonomic)
 *     rolling rim                             eq:joints.rolling (rolling_rows)
 *     coordinates                             eq:joints.coordinates (dmb_joint_coordinates_at) */
#include "constraint/joint.h"

#include <stddef.h>

#include "math/elementary.h"
#include "math/mat6.h"
#include "math/so3.h"

/* ---- Relative motion of two frames ------------------------------------------------------------------------------- */

void dmb_relative_place(const double Ra[9], const double Rb[9], const double from_a_to_b[3], dmb_relative *relative)
{
    dmb_mat3_mul_tn(Ra, Rb, relative->R);
    dmb_mat3_tvec(Ra, from_a_to_b, relative->p);
}

/* out = s Ad((R, x)^-1), (R, x)^-1 = (R^T, -R^T x) */
static void inverse_adjoint(double s, const double R[9], const double x[3], double out[36])
{
    double Rt[9], y[3];
    dmb_mat3_transpose(R, Rt);
    dmb_mat3_tvec(R, x, y);
    dmb_vec3_scale(-1.0, y, y);
    dmb_adjoint6(Rt, y, out);
    for (int i = 0; i < 36; i++) out[i] *= s;
}

/* Ad(H^-1) Ad(marker_a^-1) = Ad((marker_a H)^-1), and marker_a H = (Ma R, xa + Ma p) is frame b relative to body a. */
void dmb_relative_maps(const double *xa, const double *Ma, const double xb[3], const double Mb[9],
                       dmb_relative *relative)
{
    double R[9], x[3];
    inverse_adjoint(1.0, Mb, xb, relative->to_b);
    dmb_mat6_zero(relative->to_a);
    if (xa == NULL || Ma == NULL) return;
    dmb_mat3_mul(Ma, relative->R, R);
    dmb_mat3_vec(Ma, relative->p, x);
    dmb_vec3_add(xa, x, x);
    inverse_adjoint(-1.0, R, x, relative->to_a);
}

/* H' = H V^, so that to_a' = -ad(V) to_a, while to_b is constant: convective = to_a' v_a. */
void dmb_relative_motion(const double *va, const double vb[6], dmb_relative *relative)
{
    double a[6] = {0.0};
    dmb_mat6_vec(relative->to_b, vb, relative->V);
    if (va != NULL) dmb_mat6_vec(relative->to_a, va, a);
    for (int i = 0; i < 6; i++) relative->V[i] += a[i];
    dmb_ad_apply(relative->V, a, relative->convective);
    for (int i = 0; i < 6; i++) relative->convective[i] = -relative->convective[i];
}

void dmb_relative_pull_back(const dmb_relative *relative, const double w[6], double *wa, double wb[6])
{
    if (wa != NULL) dmb_mat6_tvec(relative->to_a, w, wa);
    dmb_mat6_tvec(relative->to_b, w, wb);
}

/* Sets the block of K that begins at row `row` and column `column`: A^T W B */
static void set_block(const double A[36], const double W[36], const double B[36], int row, int column, double K[144])
{
    double WB[36], block[36];
    dmb_mat6_mul(W, B, WB);
    dmb_mat6_mul_tn(A, WB, block);
    for (int i = 0; i < 6; i++) dmb_vec6_copy(block + 6 * i, K + 12 * (row + i) + column);
}

/* Rows of b: to_b^T W xi. Rows of a have d(to_a)^T w = -to_a^T ad(xi)^T w = -to_a^T A(w) xi in addition
 * (dmb_ad_transpose_...): K = [to_a^T (W - A(w)); to_b^T W] [to_a, to_b] (eq:joints.relative-tangent) */
void dmb_relative_tangent(const dmb_relative *relative, const double w[6], const double W[36], double K[144])
{
    double Wa[36];
    dmb_ad_transpose_derivative(w, Wa);
    for (int i = 0; i < 36; i++) Wa[i] = W[i] - Wa[i];
    set_block(relative->to_a, Wa, relative->to_a, 0, 0, K);
    set_block(relative->to_a, Wa, relative->to_b, 0, 6, K);
    set_block(relative->to_b, W, relative->to_a, 6, 0, K);
    set_block(relative->to_b, W, relative->to_b, 6, 6, K);
}

/* ---- Equations and coordinates ----------------------------------------------------------------------------------- */

#define DMB_FLAT 1e-12 /* [-] sine of an angle below which the direction of the lean is rounding error */

/* Dot-product rows, in order, and free coordinates. */
enum { P_X = 1, P_Y = 2, P_Z = 4, R_YX = 8, R_ZX = 16, R_YZ = 32, P = P_X | P_Y | P_Z };
enum { X = 1, Y = 2, Z = 4, RX = 8, RY = 16, RZ = 32, ALL = 63 }; /* 1 << DMB_X .. 1 << DMB_RZ */

typedef struct row_kind {
    uint32_t count; /* of all rows */
    uint32_t held;  /* constrained dot-product rows among them */
    uint32_t free;  /* free coordinates */
} row_kind;

static const row_kind kinds[DMB_JOINT_KINDS] = {
    [DMB_JOINT_FIXED] = {6, P | R_YX | R_ZX | R_YZ, 0},
    [DMB_JOINT_REVOLUTE] = {5, P | R_YX | R_ZX, RX},
    [DMB_JOINT_PRISMATIC] = {5, P_Y | P_Z | R_YX | R_ZX | R_YZ, X},
    [DMB_JOINT_CYLINDRICAL] = {4, P_Y | P_Z | R_YX | R_ZX, X | RX},
    [DMB_JOINT_UNIVERSAL] = {4, P | R_YZ, RY | RZ},
    [DMB_JOINT_SPHERICAL] = {3, P, RX | RY | RZ},
    [DMB_JOINT_PLANAR] = {3, P_X | R_YX | R_ZX, Y | Z | RX},
    [DMB_JOINT_POINT_ON_LINE] = {2, P_Y | P_Z, X | RX | RY | RZ},
    [DMB_JOINT_POINT_ON_HOLE] = {2, P_Y | P_Z, 0},
    [DMB_JOINT_DISTANCE] = {1, 0, ALL},
    [DMB_JOINT_FREE] = {0, 0, ALL},
    [DMB_JOINT_KNIFE_EDGE] = {1, 0, ALL},
    [DMB_JOINT_ROLLING] = {3, 0, ALL},
    [DMB_JOINT_TRANSLATIONAL] = {3, R_YX | R_ZX | R_YZ, X | Y | Z},
    [DMB_JOINT_CROSS_SLIDE] = {4, P_X | R_YX | R_ZX | R_YZ, Y | Z},
    [DMB_JOINT_SCHOENFLIES] = {2, R_YX | R_ZX, X | Y | Z | RX},
};

uint32_t dmb_joint_row_count(int32_t kind)
{
    return kinds[kind].count;
}

uint32_t dmb_joint_free_mask(int32_t kind)
{
    return kinds[kind].free;
}

/* Appends a row of zeros with the given value. */
static uint32_t add_row(uint32_t holonomic, double value, dmb_joint_rows *rows)
{
    const uint32_t k = rows->count++;
    rows->holonomic |= holonomic << k;
    rows->value[k] = value;
    for (int i = 0; i < 6; i++) rows->J[k][i] = rows->JV[k][i] = 0.0;
    return k;
}

/* Rows p_i - p0_i and r_i . a_j, r_i = R^T e_i, of the pairs ij = yx, zx, yz. a_j: row j of A, an axis fixed in b.
 *     (p_i)' = r_i . u    (r_i . a_j)' = w . (a_j x r_i)    r_i' = r_i x w */
static void dot_rows(uint32_t held, const double A[9], const double p0[3], const double R[9], const double p[3],
                     const double V[6], dmb_joint_rows *rows)
{
    static const int pair[3][2] = {{1, 0}, {2, 0}, {1, 2}};
    for (int i = 0; i < 3; i++) {
        if ((held & ((uint32_t)P_X << i)) == 0) continue;
        const uint32_t k = add_row(1, p[i] - p0[i], rows);
        dmb_vec3_copy(R + 3 * i, rows->J[k]);
        dmb_vec3_cross(R + 3 * i, V + 3, rows->JV[k]);
    }
    for (int i = 0; i < 3; i++) {
        if ((held & ((uint32_t)R_YX << i)) == 0) continue;
        const double *r = R + 3 * pair[i][0], *a = A + 3 * pair[i][1];
        const uint32_t k = add_row(1, dmb_vec3_dot(r, a), rows);
        double rate[3];
        dmb_vec3_cross(a, r, rows->J[k] + 3);
        dmb_vec3_cross(r, V + 3, rate);
        dmb_vec3_cross(a, rate, rows->JV[k] + 3);
    }
}

/* |p| - length. With q = R^T p = |p| e and q' = u + q x w: J = (e; 0), e' = (q' - e (e.q'))/|p|. */
static void distance_row(double length, const double R[9], const double p[3], const double V[6], dmb_joint_rows *rows)
{
    const double distance = dmb_vec3_norm(p);
    const uint32_t k = add_row(1, distance - length, rows);
    double q[3], rate[3], *e = rows->J[k];
    if (distance == 0.0) return;
    dmb_mat3_tvec(R, p, q);
    dmb_vec3_scale(1.0 / distance, q, e);
    dmb_vec3_cross(q, V + 3, rate);
    dmb_vec3_add(V, rate, rate);
    dmb_vec3_axpy(-dmb_vec3_dot(e, rate), e, rate);
    dmb_vec3_scale(1.0 / distance, rate, rows->JV[k]);
}

/* A direction n of frame a at an angle to the x axis of b, in axes of b: n = n_x x - s m with s >= 0 and x, t, m
 * right-handed, so t = (0, -n_z, n_y)/s. With rotation rate w
 *
 *     n' = n x w    s' = -n_x t.w    t' = c m    m' = -c t    c = -w_x - (n_x/s) m.w
 *
 * If n is parallel to x, t is undefined: t, m, c, s' and 1/s are set to 0. */
typedef struct lean {
    double n[3], t[3], m[3], s, inverse; /* inverse: 1/s */
    double rate[3], s_rate, c;           /* rate: n' */
} lean;

static void lean_at(const double n[3], const double w[3], lean *l)
{
    dmb_vec3_copy(n, l->n);
    dmb_vec3_cross(n, w, l->rate);
    l->s = sqrt(n[1] * n[1] + n[2] * n[2]);
    l->inverse = l->s > DMB_FLAT ? 1.0 / l->s : 0.0;
    dmb_vec3_set(0.0, -n[2] * l->inverse, n[1] * l->inverse, l->t);
    dmb_vec3_set(0.0, -n[1] * l->inverse, -n[2] * l->inverse, l->m);
    l->s_rate = -n[0] * dmb_vec3_dot(l->t, w);
    l->c = l->inverse > 0.0 ? -w[0] - n[0] * l->inverse * dmb_vec3_dot(l->m, w) : 0.0;
}

/* Rolling (eq:joints.rolling). The lowest point of the rim is at r m, with m from the normal n = R^T e_x of the plane,
 * and its velocity u + w x r m has these components:
 *
 *     along n: (n; r n_x t)        t: (t; -r x)        t2 = n x t = s x + n_x m: (t2; r s t)
 *
 * The first is also the derivative of p_x - r s. */
static void rolling_rows(double r, const double R[9], const double p[3], const double V[6], dmb_joint_rows *rows)
{
    lean l;
    lean_at(R, V + 3, &l);
    const uint32_t up = add_row(1, p[0] - r * l.s, rows);
    const uint32_t along = add_row(0, 0.0, rows);
    const uint32_t across = add_row(0, 0.0, rows);
    dmb_vec3_copy(l.n, rows->J[up]);
    dmb_vec3_scale(r * l.n[0], l.t, rows->J[up] + 3);
    dmb_vec3_copy(l.rate, rows->JV[up]);
    dmb_vec3_scale(r * l.rate[0], l.t, rows->JV[up] + 3);
    dmb_vec3_axpy(r * l.n[0] * l.c, l.m, rows->JV[up] + 3);
    if (l.inverse == 0.0) return;

    dmb_vec3_copy(l.t, rows->J[along]);
    rows->J[along][3] = -r;
    dmb_vec3_scale(l.c, l.m, rows->JV[along]);

    dmb_vec3_scale(l.n[0], l.m, rows->J[across]);
    rows->J[across][0] += l.s;
    dmb_vec3_scale(r * l.s, l.t, rows->J[across] + 3);
    dmb_vec3_scale(l.rate[0], l.m, rows->JV[across]);
    dmb_vec3_axpy(-l.n[0] * l.c, l.t, rows->JV[across]);
    rows->JV[across][0] += l.s_rate;
    dmb_vec3_scale(r * l.s_rate, l.t, rows->JV[across] + 3);
    dmb_vec3_axpy(r * l.s * l.c, l.m, rows->JV[across] + 3);
}

void dmb_joint_rows_at(int32_t kind, double length, const double R[9], const double p[3], const double V[6],
                       dmb_joint_rows *rows)
{
    static const double axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, origin[3] = {0, 0, 0};
    rows->count = rows->holonomic = 0;
    dot_rows(kinds[kind].held, axes, origin, R, p, V, rows);
    if (kind == DMB_JOINT_DISTANCE) distance_row(length, R, p, V, rows);
    if (kind == DMB_JOINT_KNIFE_EDGE) rows->J[add_row(0, 0.0, rows)][1] = 1.0;
    if (kind == DMB_JOINT_ROLLING) rolling_rows(length, R, p, V, rows);
}

/* Rhat_ij = e_i^T R R0^T e_j = r_i . (row j of R0). A lock is a fixed joint at (R0, p0): the same rows with the axes of
 * frame b turned back by R0. */
void dmb_joint_locked_at(const double R0[9], const double p0[3], const double R[9], const double p[3],
                         const double V[6], dmb_joint_rows *rows)
{
    rows->count = rows->holonomic = 0;
    dot_rows(kinds[DMB_JOINT_FIXED].held, R0, p0, R, p, V, rows);
}

/* Rows R_yx = R_zx = 0 keep the x axes parallel, and hold as well if they point against each other (R_xx = -1); R_yz =
 * 0 likewise for the y axes. A projection accepts that pose, so the signs of R_xx and R_yy are checked. */
double dmb_joint_flip(int32_t kind, const double R[9])
{
    const uint32_t held = kinds[kind].held;
    if ((held & R_YX) == 0) return 0.0;
    if (!(R[0] > 0.0)) return dmb_atan2(sqrt(R[3] * R[3] + R[6] * R[6]), R[0]);
    return (held & R_YZ) != 0 && !(R[4] > 0.0) ? dmb_atan2(sqrt(R[1] * R[1] + R[7] * R[7]), R[4]) : 0.0;
}

/* Column j of W = sum_k f_k JV_k^T, JV being the derivative of J along direction j: JV is linear in the motion, so six
 * unit motions give W. */
static void set_column(int j, uint32_t count, double JV[][6], const double *f, double W[36])
{
    for (int i = 0; i < 6; i++) {
        double sum = 0.0;
        for (uint32_t k = 0; k < count; k++) sum += f[k] * JV[k][i];
        W[6 * i + j] = sum;
    }
}

void dmb_joint_rows_tangent(int32_t kind, double length, const double R[9], const double p[3], const double *f,
                            double W[36])
{
    for (int j = 0; j < 6; j++) {
        double V[6] = {0.0};
        dmb_joint_rows rows;
        V[j] = 1.0;
        dmb_joint_rows_at(kind, length, R, p, V, &rows);
        set_column(j, rows.count, rows.JV, f, W);
    }
}

void dmb_joint_locked_tangent(const double R0[9], const double p0[3], const double R[9], const double p[3],
                              const double f[6], double W[36])
{
    for (int j = 0; j < 6; j++) {
        double V[6] = {0.0};
        dmb_joint_rows rows;
        V[j] = 1.0;
        dmb_joint_locked_at(R0, p0, R, p, V, &rows);
        set_column(j, rows.count, rows.JV, f, W);
    }
}

/* The angle, modulo 2 pi, nearest to `near` */
static double on_turn_of(double near, double angle)
{
    return angle + DMB_TWO_PI * round((near - angle) / DMB_TWO_PI);
}

/* With n = R^T e_y at an angle to x of b, s = cos RZ. The gradients of the angles by w are, because R is orthogonal,
 *
 *     RX: x + (n_x/s) m        RY: -m/s        RZ: t */
static void angle_gradients(const lean *l, dmb_joint_coordinates *c)
{
    const double q = l->n[0] * l->inverse;
    const double inverse_rate = -l->s_rate * l->inverse * l->inverse;
    const double q_rate = l->rate[0] * l->inverse + l->n[0] * inverse_rate;
    if (l->inverse == 0.0) return;
    dmb_vec3_scale(q, l->m, c->J[3] + 3);
    c->J[3][3] += 1.0;
    dmb_vec3_scale(q_rate, l->m, c->JV[3] + 3);
    dmb_vec3_axpy(-q * l->c, l->t, c->JV[3] + 3);

    dmb_vec3_scale(-l->inverse, l->m, c->J[4] + 3);
    dmb_vec3_scale(-inverse_rate, l->m, c->JV[4] + 3);
    dmb_vec3_axpy(l->inverse * l->c, l->t, c->JV[4] + 3);

    dmb_vec3_copy(l->t, c->J[5] + 3);
    dmb_vec3_scale(l->c, l->m, c->JV[5] + 3);
}

/* At the singularity of RX and RY, where atan2 has no arguments, both keep the value `near`. */
void dmb_joint_coordinates_at(const double R[9], const double p[3], const double V[6], const double near[2],
                              dmb_joint_coordinates *c)
{
    lean l;
    for (int k = 0; k < 6; k++)
        for (int i = 0; i < 6; i++) c->J[k][i] = c->JV[k][i] = 0.0;
    for (int k = 0; k < 3; k++) {
        c->value[k] = p[k];
        dmb_vec3_copy(R + 3 * k, c->J[k]);
        dmb_vec3_cross(R + 3 * k, V + 3, c->JV[k]);
    }
    lean_at(R + 3, V + 3, &l);
    c->value[3] = l.inverse > 0.0 ? on_turn_of(near[0], dmb_atan2(-R[5], R[4])) : near[0];
    c->value[4] = l.inverse > 0.0 ? on_turn_of(near[1], dmb_atan2(-R[6], R[0])) : near[1];
    c->value[5] = dmb_atan2(R[3], l.s); /* asin loses half the digits near a right angle */
    angle_gradients(&l, c);
}

void dmb_joint_coordinates_tangent(const double R[9], const double p[3], const double f[6], double W[36])
{
    static const double near[2] = {0.0, 0.0};
    for (int j = 0; j < 6; j++) {
        double V[6] = {0.0};
        dmb_joint_coordinates c;
        V[j] = 1.0;
        dmb_joint_coordinates_at(R, p, V, near, &c);
        set_column(j, 6, c.JV, f, W);
    }
}

/* The gradients change by JV of a unit motion along xi; the twist changes by that of body a in the axes of b, d(to_a
 * v_a) = -ad(xi) to_a v_a = ad(to_a v_a) xi. */
void dmb_joint_speeds_tangent(const dmb_relative *relative, const dmb_joint_coordinates *at, const double vb[6],
                              double G[6][6])
{
    static const double near[2] = {0.0, 0.0};
    double of_a[6];
    dmb_mat6_vec(relative->to_b, vb, of_a);
    for (int i = 0; i < 6; i++) of_a[i] = relative->V[i] - of_a[i];
    for (int k = 0; k < 6; k++) dmb_ad_transpose(of_a, at->J[k], G[k]);
    for (int s = 0; s < 6; s++) {
        double unit[6] = {0.0};
        dmb_joint_coordinates c;
        unit[s] = 1.0;
        dmb_joint_coordinates_at(relative->R, relative->p, unit, near, &c);
        for (int k = 0; k < 6; k++) G[k][s] += dmb_vec6_dot(c.JV[k], relative->V);
    }
}

#define DMB_NAME_PX "position x"
#define DMB_NAME_PY "position y"
#define DMB_NAME_PZ "position z"
/* R_yx = 0: the x axis of b has no component along y of a, which a rotation about z would cause; correspondingly for
 * R_zx and R_yz. */
#define DMB_NAME_R_YX "rotation about z"
#define DMB_NAME_R_ZX "rotation about y"
#define DMB_NAME_R_YZ "rotation about x"

typedef struct kind_names {
    const char *kind;
    const char *row[DMB_ROWS_MAX];
} kind_names;

/* Rows in the order of constraint/joint.h. */
static const kind_names names[DMB_JOINT_KINDS] = {
    [DMB_JOINT_FIXED] = {"fixed", {DMB_NAME_PX, DMB_NAME_PY, DMB_NAME_PZ, DMB_NAME_R_YX, DMB_NAME_R_ZX, DMB_NAME_R_YZ}},
    [DMB_JOINT_REVOLUTE] = {"revolute", {DMB_NAME_PX, DMB_NAME_PY, DMB_NAME_PZ, DMB_NAME_R_YX, DMB_NAME_R_ZX}},
    [DMB_JOINT_PRISMATIC] = {"prismatic", {DMB_NAME_PY, DMB_NAME_PZ, DMB_NAME_R_YX, DMB_NAME_R_ZX, DMB_NAME_R_YZ}},
    [DMB_JOINT_CYLINDRICAL] = {"cylindrical", {DMB_NAME_PY, DMB_NAME_PZ, DMB_NAME_R_YX, DMB_NAME_R_ZX}},
    [DMB_JOINT_UNIVERSAL] = {"universal", {DMB_NAME_PX, DMB_NAME_PY, DMB_NAME_PZ, DMB_NAME_R_YZ}},
    [DMB_JOINT_SPHERICAL] = {"spherical", {DMB_NAME_PX, DMB_NAME_PY, DMB_NAME_PZ}},
    [DMB_JOINT_PLANAR] = {"planar", {DMB_NAME_PX, DMB_NAME_R_YX, DMB_NAME_R_ZX}},
    [DMB_JOINT_POINT_ON_LINE] = {"point-on-line", {DMB_NAME_PY, DMB_NAME_PZ}},
    [DMB_JOINT_POINT_ON_HOLE] = {"point-on-hole", {"position across the hole, y", "position across the hole, z"}},
    [DMB_JOINT_DISTANCE] = {"distance", {"distance"}},
    [DMB_JOINT_FREE] = {"free", {NULL}},
    [DMB_JOINT_KNIFE_EDGE] = {"knife-edge", {"sideways speed"}},
    [DMB_JOINT_ROLLING] = {"rolling", {"height of the rim", "slip along the way", "slip across the way"}},
    [DMB_JOINT_TRANSLATIONAL] = {"translational", {DMB_NAME_R_YX, DMB_NAME_R_ZX, DMB_NAME_R_YZ}},
    [DMB_JOINT_CROSS_SLIDE] = {"cross-slide", {DMB_NAME_PX, DMB_NAME_R_YX, DMB_NAME_R_ZX, DMB_NAME_R_YZ}},
    [DMB_JOINT_SCHOENFLIES] = {"schoenflies", {DMB_NAME_R_YX, DMB_NAME_R_ZX}},
};

const char *dmb_joint_kind_name(int32_t kind)
{
    return kind >= 0 && kind < DMB_JOINT_KINDS ? names[kind].kind : "joint";
}

const char *dmb_joint_row_name(int32_t kind, uint32_t row)
{
    if (kind < 0 || kind >= DMB_JOINT_KINDS || row >= DMB_ROWS_MAX || names[kind].row[row] == NULL) return "row";
    return names[kind].row[row];
}
