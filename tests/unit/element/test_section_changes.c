/* Changes of the map from the velocities of the nodes to that of a section inside an element, against differences
 * (eq:motion.section-change). */
#include <string.h>

#include "check.h"
#include "element/beam.h"

enum { ELEMENTS = 300 };
#define SECTION_STEP 1e-3 /* [m, rad] errors of 1e-12 */

static const double places[4] = {-2.0, -1.0, 1.0, 2.0};
static const double weights[4] = {1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0}; /* of a first derivative */

typedef struct drawn {
    dmb_element_type type;
    dmb_section_shape shape;
    double d[6], w[6], v[12];
} drawn;

/* Every third nearly straight, as pipes are. */
static void draw_section(uint64_t *seed, int k, drawn *in)
{
    const dmb_element_type type = {.length = 1.3,
                                   .strain_stiffness = {1e8, 3e7, 2e7, 1e5, 2e5, 1e5},
                                   .arm = {k % 2 ? 0.2 : 0.0, k % 4 > 1 ? 0.15 : 0.0}};
    in->type = type;
    for (int i = 0; i < 6; i++) {
        in->d[i] = (i == 0 ? type.length : 0.0) + (i < 3 ? 0.2 : 0.8) * draw_between(seed, -1.0, 1.0);
        in->w[i] = draw_between(seed, -1.0, 1.0);
        if (k % 3 == 0 && i > 0) in->d[i] *= 1e-3;
    }
    for (int i = 0; i < 12; i++) in->v[i] = draw_between(seed, -1.0, 1.0);
    dmb_section_shape_at(&in->type, draw_between(seed, 0.0, 1.0), 1, &in->shape);
}

/* Differences of map^T w (12) and of map v (6) along component c. */
static void differences(const drawn *in, int c, double out[18])
{
    memset(out, 0, 18 * sizeof *out);
    for (int k = 0; k < 4; k++) {
        double moved[6], x[18];
        dmb_section_frame frame;
        memcpy(moved, in->d, sizeof moved);
        moved[c] += places[k] * SECTION_STEP;
        dmb_section_frame_at(&in->shape, moved, &frame);
        dmb_section_wrench(in->type.arm, &in->shape, &frame, in->w, x);
        dmb_section_twist(in->type.arm, &in->shape, &frame, in->v, x + 12);
        for (int i = 0; i < 18; i++) out[i] += weights[k] / SECTION_STEP * x[i];
    }
}

static void changes_are_those_of_differences(void **state)
{
    uint64_t seed = 7;
    double worst = 0.0;
    (void)state;
    for (int k = 0; k < ELEMENTS; k++) {
        drawn in;
        dmb_section_frame frame;
        double rows[3][36];
        draw_section(&seed, k, &in);
        dmb_section_frame_at(&in.shape, in.d, &frame);
        dmb_section_force_change(in.type.arm, &in.shape, &frame, in.d, in.w, rows[0], rows[1]);
        dmb_section_twist_change(in.type.arm, &in.shape, &frame, in.d, in.v, rows[2]);
        for (int c = 0; c < 6; c++) {
            double near[18];
            differences(&in, c, near);
            for (int i = 0; i < 18; i++) worst = fmax(worst, fabs(near[i] - rows[i / 6][6 * (i % 6) + c]));
        }
    }
    check_below("largest difference [N, m]", worst, 1e-11);
}

/* Power: w . (map v) = (map^T w) . v, and so for the changes. */
static void power_is_the_same_on_both_sides(void **state)
{
    uint64_t seed = 11;
    double worst = 0.0;
    (void)state;
    for (int k = 0; k < ELEMENTS; k++) {
        drawn in;
        dmb_section_frame frame;
        double f[12], V[6], rows[3][36], power = 0.0;
        draw_section(&seed, k, &in);
        dmb_section_frame_at(&in.shape, in.d, &frame);
        dmb_section_wrench(in.type.arm, &in.shape, &frame, in.w, f);
        dmb_section_twist(in.type.arm, &in.shape, &frame, in.v, V);
        dmb_section_force_change(in.type.arm, &in.shape, &frame, in.d, in.w, rows[0], rows[1]);
        dmb_section_twist_change(in.type.arm, &in.shape, &frame, in.d, in.v, rows[2]);
        for (int i = 0; i < 12; i++) power += f[i] * in.v[i];
        for (int i = 0; i < 6; i++) power -= in.w[i] * V[i];
        worst = fmax(worst, fabs(power));
        for (int c = 0; c < 6; c++) {
            power = 0.0;
            for (int i = 0; i < 12; i++) power += rows[i / 6][6 * (i % 6) + c] * in.v[i];
            for (int i = 0; i < 6; i++) power -= in.w[i] * rows[2][6 * i + c];
            worst = fmax(worst, fabs(power));
        }
    }
    check_below("largest difference of the powers [W]", worst, 1e-13);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(changes_are_those_of_differences),
        cmocka_unit_test(power_is_the_same_on_both_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
