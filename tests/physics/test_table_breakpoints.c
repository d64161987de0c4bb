/* Breakpoints of speed tables against closed forms: the work of a motion drive is the kinetic energy it makes, however
 * steps fall on the breakpoints and however short the ramps are; time is the number of steps times their length. */
#include <float.h>
#include <stdio.h>

#include "rig.h"

#define INERTIA 1e-3

typedef struct table {
    const char *name;
    uint32_t count;
    double time[8], value[8];
    double end; /* [s] of the run */
} table;

static const table tables[] = {
    {"as reported", 5, {0.0, 1.0, 3.0, 3.5, 9.0}, {0.0, 20.0, 20.0, -30.0, -30.0}, 4.0},
    {"ramp of 1e-5 s", 4, {0.0, 1.0, 1.00001, 2.0}, {0.0, 0.0, 5.0, 5.0}, 2.0},
    {"ramp of 1e-9 s", 4, {0.0, 0.305, 0.305000001, 2.0}, {1.0, 1.0, 5.0, 5.0}, 1.0},
    {"ramp of 2e-12 s", 4, {0.0, 0.3, 0.300000000002, 2.0}, {0.0, 0.0, -5.0, -5.0}, 1.0},
    {"ramps off the steps",
     6,
     {0.0, 0.123456, 0.123999, 0.5004, 0.5007, 0.50071},
     {3.0, 3.0, 8.0, 8.0, -2.0, 4.0},
     1.0},
    {"two breakpoints in a sliver", 4, {0.0, 0.4999999999, 0.5000000001, 0.6}, {0.0, 0.0, 7.0, 7.0}, 1.0},
    {"breakpoint just before a step", 4, {0.0, 0.4999999999, 0.7, 0.8}, {0.0, 0.0, 7.0, 7.0}, 1.0},
    {"breakpoint just after a step", 4, {0.0, 0.5000000001, 0.7, 0.8}, {0.0, 0.0, 7.0, 7.0}, 1.0},
    {"breakpoint an ulp before a step", 3, {0.0, 0.5 - DBL_EPSILON / 4.0, 0.8}, {0.0, 4.0, 4.0}, 1.0},
    {"breakpoint an ulp after a step", 3, {0.0, 0.5 + DBL_EPSILON / 2.0, 0.8}, {0.0, 4.0, 4.0}, 1.0},
};

enum { TABLES = sizeof tables / sizeof tables[0] };
enum { STEPS, ADVANCE, ADVANCE_IN_PIECES };

static double table_at(const table *t, double time)
{
    uint32_t i = 0;
    while (i < t->count && t->time[i] <= time) i++;
    if (i == 0) return t->value[0];
    if (i == t->count) return t->value[i - 1];
    return t->value[i - 1] +
           (t->value[i] - t->value[i - 1]) * ((time - t->time[i - 1]) / (t->time[i] - t->time[i - 1]));
}

static dmb_id add_table(rig *s, const table *t)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_TABLE;
    term.table_time = t->time;
    term.table_value = t->value;
    term.table_count = t->count;
    return add_time_function(s, &term, 1);
}

static dmb_drive_state drive_of(const rig *s, dmb_id drive)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(s, dmb_query_drive(s->sim, drive, &state));
    return state;
}

static void run(const rig *s, int how, double h, double end)
{
    if (how == STEPS)
        for (uint32_t n = (uint32_t)lround(end / h); n > 0; n--) must(s, dmb_sim_step(s->sim, h, NULL));
    else if (how == ADVANCE)
        must(s, dmb_sim_advance(s->sim, end, NULL));
    else
        for (int i = 1; i <= 37; i++) must(s, dmb_sim_advance(s->sim, end * i / 37.0, NULL));
}

/* ---- Rigid parts: the work is exactly the kinetic energy --------------------------------------------------------- */

/* The drive on a body of mass 2 kg and inertia INERTIA, along or about x, itself or by a joint. */
static dmb_id add_driven_body(rig *s, int32_t component, int on_joint, dmb_id time_function)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 2.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = INERTIA;
    if (!on_joint) body.free_mask = DMB_FREE_CYLINDRICAL;
    const dmb_id id = add_body(s, &body);
    if (!on_joint) return add_simple_drive(s, DMB_DRIVE_MOTION, id, component, time_function);
    const dmb_place ground = {{0, 0}, 0, 0, 0.0};
    dmb_joint_def def = joint_between(DMB_JOINT_CYLINDRICAL, ground, dmb_station(id, 0, 0.0));
    return add_simple_drive(s, DMB_DRIVE_MOTION, add_joint(s, &def), component, time_function);
}

static void check_work(const table *t, int32_t component, int on_joint, int how, double h)
{
    rig s;
    char what[160];
    const double inertia = component == DMB_X ? 2.0 : INERTIA;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id time_function = add_table(&s, t);
    const dmb_id drive = add_driven_body(&s, component, on_joint, time_function);
    (void)rig_start(&s, NULL);
    run(&s, how, h, t->end);
    const double v0 = table_at(t, 0.0), v1 = table_at(t, t->end), want = 0.5 * inertia * (v1 * v1 - v0 * v0);
    const dmb_energy energy = energy_of(&s);
    const double most = 0.5 * inertia * 900.0;
    (void)snprintf(what, sizeof what, "%s, component %d%s, %s h %g: work", t->name, component,
                   on_joint ? " of a joint" : "", how == STEPS ? "steps" : "advance", h);
    check_close(what, drive_of(&s, drive).work, want, 1e-9 * most);
    check_close("    in the ledger", energy.drives, want, 1e-9 * most);
    check_close("    balance", energy.balance, 0.0, 1e-9 * most);
    rig_close(&s);
}

static void work_on_rigid_parts_is_kinetic_energy(void **state)
{
    static const double steps[] = {1e-2, 1e-3, 1.0 / 300.0, 0.25};
    (void)state;
    for (int k = 0; k < TABLES; k++)
        for (int on_joint = 0; on_joint < 2; on_joint++)
            for (int32_t component = DMB_X; component <= DMB_RX; component += DMB_RX - DMB_X) {
                for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++)
                    check_work(tables + k, component, on_joint, STEPS, steps[i]);
                check_work(tables + k, component, on_joint, ADVANCE, 0.0);
                check_work(tables + k, component, on_joint, ADVANCE_IN_PIECES, 0.0);
            }
}

/* Knots where a caller's own sum of steps puts them, rounding and all. */
static void knots_at_sums_of_steps(void **state)
{
    const double h = 0.007;
    table t = {"knots at sums", 6, {0.0}, {0.0, 9.0, -3.0, -3.0, 12.0, 1.0}, 0.7};
    double sum = 0.0;
    (void)state;
    for (int i = 1; i <= 100; i++) {
        sum += h;
        if (i % 20 == 0) t.time[i / 20] = sum;
    }
    check_work(&t, DMB_RX, 0, STEPS, h);
    check_work(&t, DMB_RX, 1, STEPS, h);
    check_work(&t, DMB_RX, 0, ADVANCE, 0.0);
}

/* ---- Strings: work = energy + what the scheme took, which falls with the square of the step ---------------------- */

/* Four pipes driven at the rig end, torsion soft enough that the steps see their waves. */
static double missing(const table *t, int32_t component, double h)
{
    rig s;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    options.newton_tolerance = 1e-11;
    options.spectral_radius = 0.9;
    rig_open(&s, 0.0, 0.0, 0.0);
    pipe.young_modulus = 2.1e7;
    pipe.damping_time = 2e-3;
    const dmb_id string = add_pipes(&s, &pipe, 4);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, string, component, add_table(&s, t));
    (void)rig_start(&s, &options);
    run(&s, h > 0.0 ? STEPS : ADVANCE, h, t->end);
    const dmb_energy e = energy_of(&s);
    check_close("    work less energy, dissipation and scheme", e.balance - e.scheme - e.unexplained, 0.0,
                1e-9 * e.input);
    const double part = e.balance / e.input;
    rig_close(&s);
    return part;
}

static void work_on_strings_is_energy_and_dissipation(void **state)
{
    static const table ramps[] = {
        {"slow ramps", 5, {0.0, 0.2, 0.5, 0.6, 1.0}, {0.0, 2.0, 2.0, -3.0, -3.0}, 1.0},
        {"ramp within a step", 4, {0.0, 0.2003, 0.2005, 1.0}, {0.0, 0.0, 2.0, 2.0}, 0.5},
    };
    (void)state;
    for (int k = 0; k < 2; k++)
        for (int32_t component = DMB_X; component <= DMB_RX; component += DMB_RX - DMB_X) {
            const double coarse = missing(ramps + k, component, 1e-3), fine = missing(ramps + k, component, 2.5e-4);
            char what[96];
            (void)snprintf(what, sizeof what, "%s, component %d: %.2e and %.2e of the input missing at h and h/4",
                           ramps[k].name, component, coarse, fine);
            print_message("%s\n", what);
            check_below(what, fabs(coarse), 2e-2);
            check_below(what, fabs(fine), fabs(coarse) / 9.0 + 1e-9);
        }
}

/* ---- Steps that are not divided ---------------------------------------------------------------------------------- */

/* Bounded work: a breakpoint inside a step divides the work, not the step. */
static void bounded_steps_divide_the_work(void **state)
{
    const table t = {"bounded", 4, {0.0, 0.5047, 0.8123, 1.0}, {5.0, 5.0, 15.0, 15.0}, 1.0};
    double error[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        rig s;
        dmb_sim_options options = dmb_sim_options_default();
        options.bounded_work = 1;
        rig_open(&s, 0.0, 0.0, 0.0);
        const dmb_id time_function = add_table(&s, &t);
        const dmb_id drive = add_driven_body(&s, DMB_RX, 0, time_function);
        (void)rig_start(&s, &options);
        run(&s, STEPS, k ? 1e-3 : 1e-2, 1.0);
        error[k] = drive_of(&s, drive).work / (0.5 * INERTIA * 200.0) - 1.0;
        rig_close(&s);
    }
    check_close("work of bounded steps, h 1e-2", error[0], 0.0, 5e-4);
    check_close("work of bounded steps, h 1e-3", error[1], 0.0, 5e-6);
}

/* ---- Time -------------------------------------------------------------------------------------------------------- */

static void time_does_not_drift(void **state)
{
    static const double steps[] = {1e-3, 0.007, 1.0 / 3.0};
    static const uint32_t counts[] = {300000, 100000, 100000};
    (void)state;
    for (int k = 0; k < 3; k++) {
        rig s;
        dmb_body_def body = dmb_body_def_default();
        body.free_mask = DMB_FREE_X;
        body.mass = 1.0;
        body.velocity[0] = 1.0;
        for (int i = 0; i < 3; i++) body.inertia[i] = 1.0;
        rig_open(&s, 0.0, 0.0, 0.0);
        const dmb_id id = add_body(&s, &body);
        (void)rig_start(&s, NULL);
        for (uint32_t i = 0; i < counts[k]; i++) must(&s, dmb_sim_step(s.sim, steps[k], NULL));
        const double want = steps[k] * counts[k];
        check_close("time after many steps", dmb_sim_time(s.sim), want, DBL_EPSILON * want);
        check_close("    place", pose_at(&s, dmb_station(id, 0, 0.0)).displacement[0], want, 1e-10 * want);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(work_on_rigid_parts_is_kinetic_energy),
        cmocka_unit_test(knots_at_sums_of_steps),
        cmocka_unit_test(work_on_strings_is_energy_and_dissipation),
        cmocka_unit_test(bounded_steps_divide_the_work),
        cmocka_unit_test(time_does_not_drift),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
