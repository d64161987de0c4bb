#include "model/field_check.h"
#include "model/section.h"

#include <string.h>

static bool within(double value, double low, double high)
{
    return value >= low && value <= high;
}

static bool is_zero(double value)
{
    return !(value < 0.0) && !(value > 0.0) && dmb_is_finite(value);
}

typedef struct limits {
    double low, high;
    bool zero_allowed;
} limits;

static void judge_each(dmb_check *check, const char *field, const double *values, size_t count, const limits *l)
{
    dmb_message bound;
    for (size_t i = 0; i < count && check->status == DMB_OK; ++i) {
        if (within(values[i], l->low, l->high) || (l->zero_allowed && is_zero(values[i]))) continue;
        dmb_message_set(&bound, "finite%s, >= %g and <= %g", l->zero_allowed ? ", 0 or" : "", l->low, l->high);
        check->status = dmb_is_finite(values[i]) ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE;
        const dmb_field_value is = {field, (uint32_t)i, values[i]};
        dmb_message_component(check->message, check->part, check->index, &is, bound.text);
        const dmb_refused_number number = {values[i], l->low, l->high};
        dmb_failure_note(check->message, &number);
    }
}

void dmb_check_zero_or_within(dmb_check *check, const char *field, double value, double low, double high)
{
    if (!is_zero(value)) dmb_check_within(check, field, value, low, high);
}

void dmb_check_each_within(dmb_check *check, const char *field, const double *values, size_t count, double low,
                           double high)
{
    const limits l = {low, high, false};
    judge_each(check, field, values, count, &l);
}

void dmb_check_each_zero_or_within(dmb_check *check, const char *field, const double *values, size_t count, double low,
                                   double high)
{
    const limits l = {low, high, true};
    judge_each(check, field, values, count, &l);
}

void dmb_check_name(dmb_check *check, const char *field, const char *name, size_t size)
{
    dmb_message bound;
    if (memchr(name, '\0', size) == NULL) {
        dmb_message_set(&bound, "characters, at most %zu, and a 0", size - 1);
        dmb_check_fail(check, DMB_ERR_VALUE, field, (double)size, bound.text);
    } else if (check->status >= 0 && !dmb_is_text(name, size)) {
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message, "%s: %s is no text, must be UTF-8 without control characters", check->part,
                        field);
    }
}

void dmb_check_id(dmb_check *check, const dmb_model *model, const char *field, dmb_id id, uint32_t kind,
                  const char *what)
{
    if (check->status < 0 || dmb_model_part_index(model, id, kind) != DMB_NONE) return;
    check->status = DMB_ERR_ID;
    dmb_message_set(check->message, "%s: %s = {%u, %u}, must name a %s of this model", check->part, field, id.index,
                    id.generation, what);
}

void dmb_check_id_or_none(dmb_check *check, const dmb_model *model, const char *field, dmb_id id, uint32_t kind,
                          const char *what)
{
    if (!dmb_id_is_none(id)) dmb_check_id(check, model, field, id, kind, what);
}

void dmb_check_place(dmb_check *check, const dmb_model *model, const char *field, const dmb_place *place)
{
    const bool on_body = dmb_model_part_index(model, place->part, DMB_PART_BODY) != DMB_NONE ||
                         dmb_model_part_index(model, place->part, DMB_PART_BIT) != DMB_NONE ||
                         dmb_model_part_index(model, place->part, DMB_PART_STABILISER) != DMB_NONE;
    dmb_message part, pipe, fraction;
    dmb_message_set(&part, "%s.part", field);
    dmb_message_set(&pipe, "%s.pipe", field);
    dmb_message_set(&fraction, "%s.fraction", field);
    dmb_check_finite(check, fraction.text, place->fraction);
    if (!on_body)
        dmb_check_id(check, model, part.text, place->part, DMB_PART_STRING, "string, a body, a bit or a ring");
    dmb_check_within(check, fraction.text, place->fraction, 0.0, on_body ? 0.0 : 1.0);
    if (on_body) dmb_check_count(check, pipe.text, place->pipe, 0, 0);
}

void dmb_check_free_set(dmb_check *check, const char *field, int32_t mask)
{
    if (mask > 0 && (mask & ~(DMB_FREE_ALL | DMB_FREE_NONE)) == 0) return;
    dmb_check_fail(check, DMB_ERR_VALUE, field, mask,
                   "a set of DMB_FREE_..., e.g. DMB_FREE_X | DMB_FREE_RX, or DMB_FREE_NONE; DMB_X .. DMB_RZ are "
                   "indices of components, not sets");
}

void dmb_check_motion_mask(dmb_check *check, const char *field, int32_t mask)
{
    dmb_check_free_set(check, field, mask);
    if (dmb_set_is_closed(dmb_free_set(mask))) return;
    dmb_check_fail(check, DMB_ERR_UNSUPPORTED, field, mask,
                   "a closed set, DMB_FREE_NONE, _ALL, _X, _Y, _Z, _XY, _XZ, _YZ, _TRANSLATIONS, _RX, _RY, _RZ, "
                   "_SPHERICAL, or _CYLINDRICAL, _PLANAR, _SCHOENFLIES (of x, y, z); hold others by a joint");
}

/* Principal moments of inertia, and the bound that every distribution of mass keeps. With E the second moments of the
 * mass, J = (tr E) I - E; the principal moments are J1 = E2 + E3, J2 = E1 + E3, J3 = E1 + E2 with E1, E2, E3 >= 0, so
 * that none exceeds the sum of the two others: J1 <= J2 + J3 and so on. */

/* [-] of the largest moment: how far rounded values may miss the bound, on which thin rods and discs lie. Values in
 * single precision pass. */
static const double rounding = 1e-6;

/* Cholesky of the matrix scaled to a unit diagonal, so that neither large nor small inertias over- or underflow. */
static bool is_positive_definite(const double J[6])
{
    if (!(J[0] > 0.0 && J[1] > 0.0 && J[2] > 0.0)) return false;
    const double xy = J[3] / (sqrt(J[0]) * sqrt(J[1]));
    const double xz = J[4] / (sqrt(J[0]) * sqrt(J[2]));
    const double yz = J[5] / (sqrt(J[1]) * sqrt(J[2]));
    const double second = 1.0 - xy * xy;
    if (!(second > 0.0)) return false;
    return 1.0 - xz * xz - (yz - xy * xz) * (yz - xy * xz) / second > 0.0;
}

/* A <- R^T A R with the rotation by which a_pq becomes 0: Jacobi 1846; t = tan of the smaller angle. */
static void rotate_plane(double A[3][3], int p, int q)
{
    const int r = 3 - p - q;
    if (!(fabs(A[p][q]) > 0.0)) return;
    const double theta = (A[q][q] - A[p][p]) / (2.0 * A[p][q]);
    const double t = (theta < 0.0 ? -1.0 : 1.0) / (fabs(theta) + sqrt(1.0 + theta * theta));
    const double c = 1.0 / sqrt(1.0 + t * t), s = t * c;
    const double rp = A[r][p], rq = A[r][q];
    A[p][p] -= t * A[p][q];
    A[q][q] += t * A[p][q];
    A[p][q] = A[q][p] = 0.0;
    A[r][p] = A[p][r] = c * rp - s * rq;
    A[r][q] = A[q][r] = s * rp + c * rq;
}

/* The eigenvalues, largest first. Sweeps converge quadratically; six are enough for any 3x3 matrix. */
static void principal_moments(const double J[6], double moment[3])
{
    double A[3][3] = {{J[0], J[3], J[4]}, {J[3], J[1], J[5]}, {J[4], J[5], J[2]}};
    for (int sweep = 0; sweep < 6; ++sweep) {
        rotate_plane(A, 0, 1);
        rotate_plane(A, 0, 2);
        rotate_plane(A, 1, 2);
    }
    for (int i = 0; i < 3; ++i) moment[i] = A[i][i];
    for (int i = 0; i < 3; ++i) {
        const int next = i % 2;
        const double larger = fmax(moment[next], moment[next + 1]), smaller = fmin(moment[next], moment[next + 1]);
        moment[next] = larger;
        moment[next + 1] = smaller;
    }
}

static void check_moments(dmb_check *check, const char *field, const double moment[3])
{
    if (moment[0] <= moment[1] + moment[2] + rounding * moment[0]) return;
    check->status = DMB_ERR_VALUE;
    dmb_message_set(
        check->message,
        "%s: %s gives the principal moments %g, %g, %g kg m2; no body has a moment above the sum of the two "
        "others: lower the first or raise the others, defaults and those of free axes too",
        check->part, field, moment[0], moment[1], moment[2]);
}

void dmb_check_inertia_matrix(dmb_check *check, const char *field, const double J[6])
{
    double moment[3];
    if (check->status < 0) return;
    if (!is_positive_definite(J)) {
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message, "%s: %s = (%g, %g, %g, %g, %g, %g) kg m2, must be positive definite",
                        check->part, field, J[0], J[1], J[2], J[3], J[4], J[5]);
        return;
    }
    principal_moments(J, moment);
    check_moments(check, field, moment);
}

/* About the axis E2 + E3 = 2 E2, across E1 + E2: only the moment about the axis can be too large. */
void dmb_check_inertia_of_revolution(dmb_check *check, const char *field, const double J[2])
{
    const double about_first[3] = {J[0], J[1], J[1]};
    if (check->status >= 0) check_moments(check, field, about_first);
}

void dmb_check_rigid_pipe_inertia(dmb_check *check, const dmb_pipe_def *def)
{
    dmb_rigid_part pipe;
    if (check->status < 0) return;
    dmb_rigid_pipe_of(def, &pipe);
    dmb_check_inertia_of_revolution(check, "section_inertia of a rigid pipe", pipe.inertia);
}
