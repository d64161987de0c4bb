/* Test for coefficients that are constant while parts rotate. They are not for an asymmetric rotor in inertial axes, or
 * for anisotropic supports in rotating axes. The scene is linearised again after a further rotation of its rotating
 * parts, and for each result d e^(s t) the forces of both linear systems are compared:
 *
 *     change = sum |d| |T^T P'(s) T d - P(s) d| / sum |d| (|K d| + |s|^2 |M d|),     P(s) = K + s C + s^2 M,
 *
 * with T the rotation of the nodes in the axes of d (eq:modes.turned). The relative error of a root is of the size of
 * the change. */
#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "base/memory.h"
#include "math/se3.h"
#include "math/vec3.h"
#include "sim/node.h"
#include "system/system.h"

/* [rad/s] Smallest spin that counts as rotation. */
#define DMB_TURNED_SPIN 1e-3
/* [rad] Further rotation of the fastest part: no rational fraction of a revolution, so that no symmetry hides the
 * change. */
#define DMB_TURNED_ANGLE 1.0
/* [-] Smallest change that is reported; that of a rotating string bent by its weight is far below. */
#define DMB_TURNED_CHANGE 1e-4

/* Rate of the further motion of a node, body frame: its spin alone in inertial axes or for a sliding string, else its
 * whole velocity. */
static void motion_of(const dmb_linear *linear, int32_t inertial_axes, uint32_t node, double v[6])
{
    const uint32_t row = linear->scene.layout.row[node];
    memcpy(v, (inertial_axes || linear->slides ? linear->spin : linear->work->now.velocity) + row, 6 * sizeof(double));
    if (!inertial_axes && linear->slides) v[3] = linear->rest[row + 3];
}

static double fastest(const dmb_linear *linear, int32_t inertial_axes)
{
    double most = 0.0, v[6];
    for (uint32_t i = 0; i < linear->scene.node_count; i++) {
        if (linear->scene.layout.size[i] != DMB_NODE_SIX_DOF) continue;
        motion_of(linear, inertial_axes, i, v);
        most = fmax(most, dmb_vec3_norm(v + 3));
    }
    return most;
}

/* y, z <- turned by -angle about x, in both halves of six numbers. */
static void turn_six(double angle, double x[6])
{
    const double c = cos(angle), s = sin(angle);
    for (int k = 0; k < 6; k += 3) {
        const double y = x[k + 1], z = x[k + 2];
        x[k + 1] = c * y + s * z;
        x[k + 2] = c * z - s * y;
    }
}

/* Moves the nodes of the copy by h times that rate. If only the spin continues, the velocities keep their directions in
 * space and are rotated back in the node. */
static void turn_on(const dmb_linear *linear, int32_t inertial_axes, double h, dmb_sim *copy, double *angle)
{
    for (uint32_t i = 0; i < linear->scene.node_count; i++) {
        double z[6];
        angle[i] = 0.0;
        if (linear->scene.layout.size[i] != DMB_NODE_SIX_DOF) continue;
        motion_of(linear, inertial_axes, i, z);
        for (int k = 0; k < 6; k++) z[k] *= h;
        if (inertial_axes) angle[i] = z[3];
        dmb_se3_advance(copy->now.quaternion + 4 * (size_t)i, copy->now.displacement + 3 * (size_t)i, z);
        if (!inertial_axes && !linear->slides) continue;
        turn_six(z[3], copy->now.velocity + linear->scene.layout.row[i]);
        turn_six(z[3], copy->now.acceleration + linear->scene.layout.row[i]);
    }
}

static int32_t linearise(const dmb_linear *linear, const dmb_sim *sim, const dmb_linear_options *options, double h,
                         dmb_linear_turned *out)
{
    dmb_sim *copy = dmb_state_copy(sim);
    out->bytes = (linear->scene.node_count + 8 * (size_t)linear->rows) * sizeof(double);
    out->angle = copy != NULL ? dmb_allocate(&linear->allocator, out->bytes) : NULL;
    int32_t status = DMB_ERR_NO_MEMORY;
    if (out->angle != NULL) {
        turn_on(linear, options->inertial_axes, h, copy, out->angle);
        status = dmb_linear_make(copy, options, &out->linear);
    }
    dmb_state_discard(copy);
    return status;
}

int32_t dmb_linear_turn_on(const dmb_linear *linear, const dmb_sim *sim, const dmb_linear_options *options,
                           dmb_linear_turned *out)
{
    memset(out, 0, sizeof *out);
    out->node = DMB_NONE;
    out->spin = fastest(linear, options->inertial_axes);
    return out->spin > DMB_TURNED_SPIN ? linearise(linear, sim, options, DMB_TURNED_ANGLE / out->spin, out) : DMB_OK;
}

void dmb_linear_turned_release(dmb_linear_turned *turned, const dmb_allocator *allocator)
{
    dmb_linear_release(&turned->linear);
    dmb_release(allocator, turned->angle, turned->bytes);
    turned->angle = NULL;
}

/* d turned about the x axes of its nodes by -sense times their angles. */
static void turn(const dmb_linear_turned *turned, double sense, const double *d, double *out)
{
    const dmb_scene *scene = &turned->linear->scene;
    memcpy(out, d, scene->row_count * sizeof *d);
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (scene->layout.size[i] == DMB_NODE_SIX_DOF) turn_six(sense * turned->angle[i], out + scene->layout.row[i]);
}

/* p += factor A d; sum |d| |A d| */
static double add_forces(const dmb_linear *linear, const dmb_linear_matrix *A, const double factor[2],
                         dmb_complex_array d, dmb_complex_array y, dmb_complex_array p)
{
    double sum = 0.0;
    dmb_linear_multiply(linear, A, d.re, y.re);
    dmb_linear_multiply(linear, A, d.im, y.im);
    for (uint32_t i = 0; i < linear->rows; i++) {
        p.re[i] += factor[0] * y.re[i] - factor[1] * y.im[i];
        p.im[i] += factor[0] * y.im[i] + factor[1] * y.re[i];
        sum += hypot(d.re[i], d.im[i]) * hypot(y.re[i], y.im[i]);
    }
    return sum;
}

/* p += sign P(s) d; sum |d| (|K d| + |s|^2 |M d|) */
static double add_all(const dmb_linear *linear, double sign, const double s[2], dmb_complex_array d,
                      dmb_complex_array y, dmb_complex_array p)
{
    const double one[2] = {sign, 0.0}, first[2] = {sign * s[0], sign * s[1]};
    const double second[2] = {sign * (s[0] * s[0] - s[1] * s[1]), 2.0 * sign * s[0] * s[1]};
    const double elastic = add_forces(linear, &linear->stiffness, one, d, y, p);
    (void)add_forces(linear, &linear->damping, first, d, y, p);
    return elastic + (s[0] * s[0] + s[1] * s[1]) * add_forces(linear, &linear->mass, second, d, y, p);
}

/* The node where the change is largest, and the change over `size`. */
static double judge(dmb_linear_turned *turned, double size, dmb_complex_array d, dmb_complex_array p)
{
    const dmb_scene *scene = &turned->linear->scene;
    double sum = 0.0, most = 0.0;
    uint32_t node = 0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        double part = 0.0;
        for (uint32_t r = scene->layout.row[i]; r < scene->layout.row[i] + scene->layout.size[i]; r++)
            part += hypot(d.re[r], d.im[r]) * hypot(p.re[r], p.im[r]);
        if (part > most) node = i;
        most = fmax(most, part);
        sum += part;
    }
    const double change = size > 0.0 ? sum / size : 0.0;
    if (!(change > turned->change)) return change;
    turned->change = change;
    turned->node = node;
    return change;
}

double dmb_linear_change_of(dmb_linear_turned *turned, const dmb_linear *linear, const double s[2], const double *re,
                            const double *im)
{
    const size_t rows = linear->rows;
    if (turned->linear == NULL) return 0.0;
    double *w = turned->angle + linear->scene.node_count;
    const dmb_complex_array d = {w, w + rows}, p = {w + 2 * rows, w + 3 * rows}, y = {w + 4 * rows, w + 5 * rows};
    const dmb_complex_array back = {w + 6 * rows, w + 7 * rows};
    memset(p.re, 0, 2 * rows * sizeof(double));
    turn(turned, 1.0, re, d.re);
    memset(d.im, 0, rows * sizeof(double));
    if (im != NULL) turn(turned, 1.0, im, d.im);
    (void)add_all(turned->linear, 1.0, s, d, y, p);
    turn(turned, -1.0, p.re, back.re);
    turn(turned, -1.0, p.im, back.im);
    memcpy(d.re, re, rows * sizeof(double));
    if (im != NULL) memcpy(d.im, im, rows * sizeof(double));
    return judge(turned, add_all(linear, -1.0, s, d, y, back), d, back);
}

int32_t dmb_linear_check_change(const dmb_linear_turned *turned, const char *who, const char *then,
                                dmb_message *message)
{
    if (!(turned->change > DMB_TURNED_CHANGE)) return DMB_OK;
    const dmb_owner owner = dmb_owner_of_node(&turned->linear->scene, turned->node);
    dmb_message_set(message,
                    "%s: while parts turn coefficients change by %g of the forces of a result, most at %s: in axes at "
                    "rest the rotor must be round, in rotating axes its supports must be isotropic: %s",
                    who, turned->change, owner.text.text, then);
    return DMB_ERR_UNSUPPORTED;
}
