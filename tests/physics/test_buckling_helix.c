/* A weightless string in its hole under 200 kN: the helix (Lubinski, Althouse, Logan 1962), and how friction on the
 * hole eats up a push that goes through it. Equations: eq:drilling.helical. */
#include <stdio.h>

#include "rig.h"

#define PUSH 2e5
#define ELEMENT 0.75
#define RAMP 8    /* static starts from a fifth of the push to the whole */
#define TICK 1e-6 /* [s] between them */

typedef struct helix {
    rig s;
    dmb_id string;
    uint32_t pipes;
} helix;

/* The rig end is held off the axis, so that the helix has a place to turn from. Loads that turn with a pitch of 8 m,
 * not the one sought, bring the string onto the wall; they are taken off again after the ramp of the push. */
static void open_helix(helix *h, double length, double mu)
{
    dmb_wall_def wall = s1_hole();
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def load = dmb_load_def_default();
    dmb_segment push = dmb_segment_default(), aside = dmb_segment_default();
    h->pipes = (uint32_t)(length / ELEMENT);
    rig_open(&h->s, 0.0, 0.0, 0.0);
    wall.stiffness = 1e8;
    wall.friction_law = mu > 0.0 ? DMB_FRICTION_COULOMB : DMB_FRICTION_NONE;
    wall.mu_static = wall.mu_dynamic = mu;
    wall.smoothing_speed = 1.0;
    (void)add_wall(&h->s, &wall);
    def.start_free = DMB_FREE_NONE;
    def.offset[0] = 0.0105;
    pipe.length = ELEMENT;
    pipe.string = add_string(&h->s, &def);
    h->string = add_pipes(&h->s, &pipe, h->pipes);
    push.kind = aside.kind = DMB_SEGMENT_STEP;
    push.h0 = 0.2;
    push.h1 = 1.0;
    push.x1 = RAMP * TICK;
    aside.x0 = RAMP * TICK;
    aside.x1 = (RAMP + 1) * TICK;
    aside.h0 = 1.0;
    load.frame = DMB_FRAME_HOLE;
    load.place = dmb_station(h->string, h->pipes - 1, 1.0);
    load.force[0] = -PUSH;
    load.time_function = add_time_function(&h->s, &push, 1);
    (void)add_load(&h->s, &load);
    load.time_function = add_time_function(&h->s, &aside, 1);
    load.force[0] = 0.0;
    for (uint32_t i = 0; i < h->pipes; i++) {
        const double angle = 2.0 * PI * (i + 1) * ELEMENT / 8.0;
        load.place = dmb_station(h->string, i, 1.0);
        load.force[1] = 600.0 * ELEMENT * cos(angle);
        load.force[2] = 600.0 * ELEMENT * sin(angle);
        (void)add_load(&h->s, &load);
    }
    (void)rig_start(&h->s, NULL);
}

static dmb_static_report settle(const helix *h, double slip)
{
    dmb_static_options options = dmb_static_options_default();
    options.lay_on_wall = 0;
    options.max_iterations = 200;
    options.slip_axial = slip;
    return find_equilibrium(&h->s, &options);
}

static void wind(const helix *h)
{
    for (int k = 0; k <= RAMP + 1; k++) {
        const dmb_static_report report = settle(h, 0.0);
        print_message("    start %2d: %s, %u iterations, %u steps, %u cuts, %d negative\n", k,
                      report.method == DMB_STATIC_NEWTON ? "Newton" : "relaxation", report.iterations,
                      report.load_steps, report.cuts, report.negative);
        if (k <= RAMP) must(&h->s, dmb_sim_step(h->s.sim, TICK, NULL));
    }
}

/* ---- The helix --------------------------------------------------------------------------------------------------- */

/* Middle third: turns from node to node, forces at the nodes, mean curvature and stretch of the elements. */
static void measure(const helix *h, double *pitch, double *normal, double *moment, double *shortening)
{
    const s1_section v = s1_values();
    const uint32_t first = h->pipes / 3, last = 2 * h->pipes / 3;
    double turned = 0.0, along = 0.0, stretched = 0.0;
    *normal = *moment = 0.0;
    for (uint32_t i = first; i < last; i++) {
        const dmb_pose a = pose_at(&h->s, dmb_station(h->string, i, 0.0));
        const dmb_pose b = pose_at(&h->s, dmb_station(h->string, i, 1.0));
        dmb_contact contact = dmb_contact_default();
        dmb_section section = dmb_section_default();
        const double *p = a.position, *q = b.position;
        turned += atan2(p[1] * q[2] - p[2] * q[1], p[1] * q[1] + p[2] * q[2]);
        along += q[0] - p[0];
        must(&h->s, dmb_query_contact(h->s.sim, i + 1, &contact)); /* the rig end is the first */
        assert_int_equal(contact.closed, 1);
        *normal += contact.normal_force / ((last - first) * ELEMENT);
        must(&h->s, dmb_query_section(h->s.sim, dmb_station(h->string, i, 0.5), &section));
        *moment += v.EI * hypot(section.strain[4], section.strain[5]) / (last - first);
        stretched += ELEMENT * (1.0 + section.strain[0]);
    }
    *pitch = 2.0 * PI * along / fabs(turned);
    *shortening = 1.0 - along / stretched;
}

/* Pitch 2 pi sqrt(2 EI/F) 8.8504 m, contact F^2 r/(4 EI) 529.204 N/m, moment F r/2 1050 N m, shortening F r^2/(4 EI)
 * 2.7783e-5 (CASES.md, to 2 %). */
static void helix_of_a_pushed_string(void **state)
{
    (void)state;
    helix h;
    double pitch, normal, moment, shortening;
    open_helix(&h, 60.0, 0.0);
    wind(&h);
    measure(&h, &pitch, &normal, &moment, &shortening);
    check_relative("pitch", pitch, 8.850400785, 2e-3);
    check_relative("contact force a metre", normal, 529.2040509, 2e-3);
    check_relative("bending moment, mean of the elements", moment, 1050.0, 0.015);
    check_relative("shortening", shortening, 2.7783213e-5, 0.02);
    rig_close(&h.s);
}

/* ---- Push through it --------------------------------------------------------------------------------------------- */

/* Sliding into the hole, a metre of helix takes up mu F^2 r/(4 EI): 1/F falls linearly towards the rig, and the string
 * locks up, the rig force growing without bound, after 4 EI/(mu r F0) from a push F0 at its far end. The assumed slip
 * turns friction up: mu s/sqrt(s^2 + 1). */
static void friction_eats_the_push(void **state)
{
    (void)state;
    const double length = 100.0, mu = 0.3, slips[6] = {0.1, 0.2, 0.5, 1.0, 2.0, 1e3};
    helix h;
    open_helix(&h, length, mu);
    wind(&h);
    for (int k = 0; k < 6; k++) {
        const double acts = mu * slips[k] / hypot(slips[k], 1.0), lost = acts * 0.0105 / (4.0 * s1_values().EI);
        double reaction[6];
        const dmb_static_report report = settle(&h, slips[k]);
        must(&h.s, dmb_query_reaction(h.s.sim, h.string, reaction));
        print_message("    mu %.4f: rig force %.1f N, lock-up at %.0f m, %u iterations\n", acts, reaction[0],
                      1.0 / (lost * PUSH), report.iterations);
        check_relative("    rig force", reaction[0], 1.0 / (1.0 / PUSH - lost * length), 0.01);
        check_relative("    push and friction balance", reaction[0], PUSH + acts * contacts_of(&h.s).normal_force,
                       1e-6);
    }
    rig_close(&h.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(helix_of_a_pushed_string),
        cmocka_unit_test(friction_eats_the_push),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
