/* Principal moments of inertia, and the bound that every distribution of mass keeps. With E the second moments of the
 * mass, J = (tr E) I - E; the principal moments are J1 = E2 + E3, J2 = E1 + E3, J3 = E1 + E2 with E1, E2, E3 >= 0, so
 * that none exceeds the sum of the two others: J1 <= J2 + J3 and so on. */
#include "model/inertia_check.h"

#include "model/section.h"

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

static const char *part_text(const dmb_check *check, dmb_message *text)
{
    if (check->index == DMB_NONE) return check->part;
    return dmb_part_text(text, check->part, check->index, "", 1);
}

static void check_moments(dmb_check *check, const char *field, const double moment[3])
{
    if (moment[0] <= moment[1] + moment[2] + rounding * moment[0]) return;
    check->status = DMB_ERR_VALUE;
    dmb_message part;
    dmb_message_set(
        check->message,
        "%s: %s gives the principal moments %g, %g, %g kg m2; no body has a moment above the sum of the two "
        "others: lower the first or raise the others, defaults and those of free axes too",
        part_text(check, &part), field, moment[0], moment[1], moment[2]);
}

void dmb_check_inertia_matrix(dmb_check *check, const char *field, const double J[6])
{
    double moment[3];
    dmb_message part;
    if (check->status < 0) return;
    if (!is_positive_definite(J)) {
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message, "%s: %s = (%g, %g, %g, %g, %g, %g) kg m2, must be positive definite",
                        part_text(check, &part), field, J[0], J[1], J[2], J[3], J[4], J[5]);
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
