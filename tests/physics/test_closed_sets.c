/* Every closed set of free components, of bodies and of joints, against uniform acceleration in closed form and against
 * each other; which sets are taken, against the brackets of the components; a beam on a guided end against its roots.
 */
#include <stdio.h>
#include <string.h>

#include "modal.h"

/* ---- Which sets there are ---------------------------------------------------------------------------------------- */

/* The bracket of two unit twists, shape (6): X .. RZ. */
static void bracket(const double a[6], const double b[6], double c[6])
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        c[3 + i] = a[3 + j] * b[3 + k] - a[3 + k] * b[3 + j];
        c[i] = a[3 + j] * b[k] - a[3 + k] * b[j] - (b[3 + j] * a[k] - b[3 + k] * a[j]);
    }
}

static int closed(int32_t mask)
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            double a[6] = {0.0}, b[6] = {0.0}, c[6];
            if ((mask >> i & 1) == 0 || (mask >> j & 1) == 0) continue;
            a[i] = b[j] = 1.0;
            bracket(a, b, c);
            for (int k = 0; k < 6; k++)
                if (c[k] != 0.0 && (mask >> k & 1) == 0) return 0;
        }
    return 1;
}

static void all_that_are_closed(void **state)
{
    (void)state;
    int count = 0;
    for (int32_t mask = 0; mask < 64; mask++) {
        rig s;
        dmb_body_def body = dmb_body_def_default();
        dmb_string_def string = dmb_string_def_default();
        dmb_id made;
        rig_open(&s, 0.0, 0.0, 0.0);
        body.free_mask = string.start_free = string.end_free = DMB_FREE_NONE | DMB_FREE_X * mask;
        const int32_t want = closed(mask) ? DMB_OK : DMB_ERR_UNSUPPORTED;
        assert_int_equal(dmb_model_add_body(s.model, &body, &made), want);
        if (want < 0) assert_non_null(strstr(dmb_model_message(s.model), "_SCHOENFLIES (of x, y, z); hold others by"));
        assert_int_equal(dmb_model_add_string(s.model, &string, &made), want);
        count += want == DMB_OK;
        rig_close(&s);
    }
    assert_int_equal(count, 22);
}

/* Every combination of component indices, 0 .. 63, as the set of a part: refused, the message shows how to write it. */
static void indices_are_no_sets(void **state)
{
    (void)state;
    rig s;
    dmb_id made;
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int32_t mask = -1; mask < 256; mask++) {
        dmb_body_def body = dmb_body_def_default();
        dmb_string_def start = dmb_string_def_default(), far = dmb_string_def_default();
        body.free_mask = start.start_free = far.end_free = mask;
        assert_int_equal(dmb_model_add_body(s.model, &body, &made), DMB_ERR_VALUE);
        assert_int_equal(dmb_model_add_string(s.model, &far, &made), DMB_ERR_VALUE);
        assert_int_equal(dmb_model_add_string(s.model, &start, &made), DMB_ERR_VALUE);
        if (mask != (DMB_X | DMB_RX)) continue;
        assert_non_null(strstr(dmb_model_message(s.model), "start_free = 3, must be a set of DMB_FREE_..., e.g. "
                                                           "DMB_FREE_X | DMB_FREE_RX"));
    }
    assert_int_equal(dmb_model_clear_refused(s.model), DMB_OK);
    rig_close(&s);
}

/* ---- How they move ----------------------------------------------------------------------------------------------- */

static const double force[3] = {3.0, -2.0, 5.0}, moment[3] = {0.4, 0.7, -0.5};
static const double inertia[3] = {1.5, 2.0, 3.0};
static const double end = 0.4;

static const double tilt[3] = {0.6, -0.3, 0.8};

/* Component i of column k of exp(tilt), by Rodrigues' formula. */
static double column(int k, int i)
{
    const double a = sqrt(tilt[0] * tilt[0] + tilt[1] * tilt[1] + tilt[2] * tilt[2]);
    const double n[3] = {tilt[0] / a, tilt[1] / a, tilt[2] / a};
    const double cross = i == k ? 0.0 : (i == (k + 1) % 3 ? n[(k + 2) % 3] : -n[(k + 1) % 3]);
    return (i == k) * cos(a) + (1.0 - cos(a)) * n[i] * n[k] + sin(a) * cross;
}

typedef struct outcome {
    double displacement[3], velocity[6], angle; /* world; about the one rotation, along the body */
} outcome;

/* A tilted body under a force in the world and a moment in the world, from rest; held by a mask, or (kind >= 0) by a
 * joint with the ground. */
static outcome run(int32_t mask, int32_t kind, uint32_t steps, double R[9])
{
    rig s;
    dmb_body_def body = dmb_body_def_default();
    dmb_load_def load = dmb_load_def_default();
    outcome out;
    rig_open(&s, 0.0, 0.0, 0.0);
    body.mass = 4.0;
    memcpy(body.inertia, inertia, sizeof inertia);
    memcpy(body.rotation, tilt, sizeof tilt);
    if (kind < 0) body.free_mask = DMB_FREE_NONE | DMB_FREE_X * mask;
    const dmb_id id = add_body(&s, &body);
    load.place = dmb_station(id, 0, 0.0);
    memcpy(load.force, force, sizeof force);
    memcpy(load.moment, moment, sizeof moment);
    add_load(&s, &load);
    if (kind >= 0) {
        dmb_joint_def joint = joint_between(kind, dmb_station((dmb_id){0, 0}, 0, 0.0), load.place);
        for (int i = 0; i < 3; i++) {
            joint.axis_a[i] = column(0, i);
            joint.normal_a[i] = column(1, i);
        }
        add_joint(&s, &joint);
    }
    rig_start(&s, NULL);
    memcpy(R, pose_at(&s, load.place).rotation, 9 * sizeof(double));
    take_steps(&s, end / steps, steps);
    memcpy(out.displacement, pose_at(&s, load.place).displacement, sizeof out.displacement);
    memcpy(out.velocity, motion_at(&s, load.place, DMB_FRAME_WORLD).velocity, sizeof out.velocity);
    const double *w = out.velocity + 3;
    out.angle = 0.0;
    for (int k = 0; k < 3; k++)
        if ((mask >> (3 + k) & 1) != 0) out.angle += R[k] * w[0] + R[3 + k] * w[1] + R[6 + k] * w[2];
    rig_close(&s);
    return out;
}

/* Force and moment have constant parts along what is free: the plane or line that a closed set translates in stays
 * where it is, and so does the axis of its one rotation. d = P f t^2/2m, w = a (a.m) t/J. */
static double off(int32_t mask, int32_t kind, uint32_t steps)
{
    double R[9], worst = 0.0, spin = 0.0;
    const outcome got = run(mask, kind, steps, R);
    const double t = end;
    double want[3] = {0.0};
    for (int k = 0; k < 3; k++) {
        const double along = R[k] * force[0] + R[3 + k] * force[1] + R[6 + k] * force[2];
        const double about = R[k] * moment[0] + R[3 + k] * moment[1] + R[6 + k] * moment[2];
        if ((mask >> k & 1) != 0)
            for (int i = 0; i < 3; i++) want[i] += R[3 * i + k] * along * t * t / (2.0 * 4.0);
        if ((mask >> (3 + k) & 1) != 0) spin += about * t / inertia[k];
    }
    for (int i = 0; i < 3; i++) worst = fmax(worst, fabs(got.displacement[i] - want[i]));
    return fmax(worst, fabs(got.angle - spin));
}

/* Exact where the axes of the body stay; of second order where they turn while it moves across. */
static void compare(const char *what, int32_t mask, int32_t kind)
{
    const double coarse = off(mask, kind, 200);
    const int turns_aside = mask > 7 && (mask & 7 & ~(mask >> 3)) != 0;
    check_below(what, coarse, turns_aside ? 2e-7 : 1e-12);
    if (turns_aside && kind < 0) check_order(what, coarse, off(mask, kind, 400), 2.0, 0.05);
}

static void closed_forms(void **state)
{
    (void)state;
    for (int32_t mask = 0; mask < 64; mask++) {
        char what[40];
        const int32_t turns = mask >> 3;
        if (!closed(mask) || (turns & (turns - 1)) != 0) continue; /* three rotations: physics_body_top */
        (void)snprintf(what, sizeof what, "mask %d", (int)mask);
        compare(what, mask, -1);
    }
    compare("joint: translational", DMB_FREE_TRANSLATIONS / DMB_FREE_X, DMB_JOINT_TRANSLATIONAL);
    compare("joint: cross slide", DMB_FREE_YZ / DMB_FREE_X, DMB_JOINT_CROSS_SLIDE);
    compare("joint: Schoenflies", DMB_FREE_SCHOENFLIES / DMB_FREE_X, DMB_JOINT_SCHOENFLIES);
    compare("joint: planar", DMB_FREE_PLANAR / DMB_FREE_X, DMB_JOINT_PLANAR);
}

/* ---- A string on such an end ------------------------------------------------------------------------------------- */

/* Clamped, and guided across at the other end (no turn): tan x + tanh x = 0, 2.365020, 5.497804; EI = 100, 2 kg/m, 1 m
 * as in physics_modes_beams. */
static void supportd_end(void **state)
{
    (void)state;
    static const double roots[2] = {2.365020372431352, 5.497803919000836};
    dmb_pipe_def pipe = beam_pipe(1.0, 16, 1e8, 1e12, 1e6, 100.0);
    rig s;
    pipe.section_mass = 2.0;
    pipe.section_inertia[0] = 1.0;
    pipe.section_inertia[1] = 1e-10;
    (void)lay_string(&s, &pipe, 1, DMB_FREE_NONE, DMB_FREE_YZ);
    rig_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 16);
    for (uint32_t i = 0; i < 4; i++)
        check_relative("clamped-supportd", frequency_of_kind(modes, 2, i),
                       roots[i / 2] * roots[i / 2] * sqrt(100.0 / 2.0) / (2.0 * PI), 1e-4);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_that_are_closed),
        cmocka_unit_test(indices_are_no_sets),
        cmocka_unit_test(closed_forms),
        cmocka_unit_test(supportd_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
