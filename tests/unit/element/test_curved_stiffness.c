/* Stiffness of elements whose unstressed shape is bent: forces against the energy, all tangents against differences,
 * with material damping, mass and weight. Reference: six-point central differences. Checks eq:curved.flexibility and
 * eq:curved.sideways. */
#include <string.h>

#include "check.h"

#include "element/beam.h"
#include "element/beam_element.h"
#include "math/se3.h"
#include "model/section.h"

typedef struct one_element {
    dmb_element_type type;
    double qa[4], qb[4], xa[3], xb[3], v[12], a[12];
} one_element;

static const double gravity[3] = {2.0, 3.0, -9.0};

static void draw_element(uint64_t *seed, one_element *to)
{
    static const double arm[2] = {0.2, 0.1}, stiffness[6] = {7.0, 4.0, 5.0, 3.0, 2.0, 2.5};
    dmb_pipe_def def = dmb_pipe_def_default();
    double h[12];
    memset(to, 0, sizeof *to);
    def.length = 1.3;
    for (int i = 0; i < 6; i++) def.section_stiffness[i] = stiffness[i];
    for (int i = 0; i < 3; i++) def.curvature[i] = draw_between(seed, -0.7, 0.7);
    def.section_mass = 1.1;
    def.section_inertia[0] = 0.3;
    def.section_inertia[1] = 0.2;
    dmb_element_type_of(&def, arm, 0.05, &to->type);
    to->type.weight_mass = 0.9;
    dmb_element_make_curved(&def, &to->type);
    for (int i = 0; i < 12; i++) h[i] = draw_between(seed, -0.4, 0.4);
    h[6] += 1.6;
    to->qa[0] = to->qb[0] = 1.0;
    dmb_se3_advance(to->qa, to->xa, h);
    dmb_se3_advance(to->qb, to->xb, h + 6);
    for (int i = 0; i < 12; i++) {
        to->v[i] = draw_between(seed, -1.0, 1.0);
        to->a[i] = draw_between(seed, -1.0, 1.0);
    }
}

static void evaluate(const one_element *e, const dmb_beam_task *task, dmb_beam_output *out)
{
    dmb_beam_constants c;
    dmb_curved_constants curved;
    dmb_beam_input in;
    memset(&in, 0, sizeof in);
    dmb_beam_load_constants(&e->type, 0, &c);
    dmb_curved_load(&e->type, 0, &curved);
    dmb_quat_copy(e->qa, in.qa);
    dmb_quat_copy(e->qb, in.qb);
    dmb_quat_to_matrix(in.qa, in.Ra);
    dmb_vec3_sub(e->xb, e->xa, in.span);
    dmb_vec6_copy(e->v, in.va);
    dmb_vec6_copy(e->v + 6, in.vb);
    dmb_vec6_copy(e->a, in.aa);
    dmb_vec6_copy(e->a + 6, in.ab);
    assert_int_equal(dmb_beam_element(task, &c, &curved, &in, out), 0);
}

/* Kind 0: pose, 1: velocity, 2: acceleration. */
static void force_beside(const one_element *e, int kind, int c, double step, double f[12])
{
    const dmb_beam_task task = {0.0, 0.0, 1, 0, 0, 1, 1, 0, 1, 1, gravity};
    one_element beside = *e;
    dmb_beam_output out;
    double h[6] = {0.0};
    h[c % 6] = step;
    if (kind == 0 && c < 6) dmb_se3_advance(beside.qa, beside.xa, h);
    if (kind == 0 && c >= 6) dmb_se3_advance(beside.qb, beside.xb, h);
    if (kind == 1) beside.v[c] += step;
    if (kind == 2) beside.a[c] += step;
    evaluate(&beside, &task, &out);
    dmb_vec6_copy(out.fa, f);
    dmb_vec6_copy(out.fb, f + 6);
}

static double entry(const dmb_beam_output *out, int kind, int r, int c)
{
    const int at = 6 * (r % 6) + c % 6;
    if (r < 6 && c < 6) return kind == 0 ? out->K.aa[at] : out->C.aa[at];
    if (r >= 6 && c >= 6) return kind == 0 ? out->K.bb[at] : out->C.bb[at];
    return r < 6 ? out->K.ab[at] : out->K.ba[at]; /* with C, of which the kind has that alone */
}

static double worst_tangent(const one_element *e, int kind)
{
    const dmb_beam_task task = {kind == 2, kind == 1, 1, 1, 0, 1, 1, kind > 0, 1, 1, gravity};
    const double step = 1e-3;
    dmb_beam_output out;
    double worst = 0.0, size = 1.0;
    evaluate(e, &task, &out);
    for (int c = 0; c < 12; c++) {
        double f[6][12];
        for (int p = 0; p < 6; p++) force_beside(e, kind, c, step * difference6_place[p], f[p]);
        for (int r = 0; r < 12; r++) {
            const double v[6] = {f[0][r], f[1][r], f[2][r], f[3][r], f[4][r], f[5][r]};
            const double want = difference6(v, step);
            size = fmax(size, fabs(want));
            worst = fmax(worst, fabs(entry(&out, kind, r, c) - want));
        }
    }
    return worst / size;
}

static void tangents_against_differences(void **state)
{
    static const char *const names[3] = {"tangent by pose", "tangent by velocity", "tangent by acceleration"};
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        uint64_t seed = 11;
        double worst = 0.0;
        for (int k = 0; k < 20; k++) {
            one_element e;
            draw_element(&seed, &e);
            worst = fmax(worst, worst_tangent(&e, kind));
        }
        check_below(names[kind], worst, 1e-9);
    }
}

static double energy(const one_element *e)
{
    dmb_beam_shape shape;
    double R[9], span[3], x[6], s[6];
    dmb_quat_to_matrix(e->qa, R);
    dmb_vec3_sub(e->xb, e->xa, span);
    assert_int_equal(dmb_beam_deform(&e->type, e->qa, R, e->qb, span, &shape), 0);
    dmb_beam_strain_of(&e->type, &shape, x);
    dmb_beam_stress(&e->type, &shape, s);
    return 0.5 * dmb_vec6_dot(x, s);
}

/* At rest and without weight the force is the gradient of the energy. */
static void force_is_the_gradient_of_the_energy(void **state)
{
    const dmb_beam_task task = {0.0, 0.0, 0, 0, 0, 0, 0, 0, 1, 1, NULL};
    uint64_t seed = 12;
    double worst = 0.0;
    (void)state;
    for (int k = 0; k < 50; k++) {
        one_element e;
        dmb_beam_output out;
        draw_element(&seed, &e);
        evaluate(&e, &task, &out);
        for (int c = 0; c < 12; c++) {
            double E[6];
            for (int p = 0; p < 6; p++) {
                one_element beside = e;
                double h[6] = {0.0};
                h[c % 6] = 1e-3 * difference6_place[p];
                if (c < 6) dmb_se3_advance(beside.qa, beside.xa, h);
                if (c >= 6) dmb_se3_advance(beside.qb, beside.xb, h);
                E[p] = energy(&beside);
            }
            worst = fmax(worst, fabs(difference6(E, 1e-3) - (c < 6 ? out.fa[c] : out.fb[c - 6])));
        }
    }
    check_below("force, of the gradient of the energy", worst, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tangents_against_differences),
        cmocka_unit_test(force_is_the_gradient_of_the_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
