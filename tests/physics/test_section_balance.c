/* Section forces against Newton's law: each piece of a string between two of its sections is in balance with its
 * weight, the contacts and the loads on it. */
#include <math.h>
#include <stdio.h>

#include "rig.h"

enum { PIPES = 6 };

/* ---- Forces on a piece, in world axes about the world's origin ----------------------------------------------------
 */

typedef struct wrench {
    double force[3], moment[3];
    double size[2]; /* [N, N m] sums of magnitudes */
} wrench;

static double norm(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void add_force(wrench *w, const double force[3], const double at[3])
{
    const double m[3] = {at[1] * force[2] - at[2] * force[1], at[2] * force[0] - at[0] * force[2],
                         at[0] * force[1] - at[1] * force[0]};
    for (int i = 0; i < 3; i++) w->force[i] += force[i], w->moment[i] += m[i];
    w->size[0] += norm(force);
    w->size[1] += norm(m);
}

static void add_moment(wrench *w, const double moment[3])
{
    for (int i = 0; i < 3; i++) w->moment[i] += moment[i];
    w->size[1] += norm(moment);
}

static void to_world(const double R[9], double sign, const double x[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = sign * (R[3 * i] * x[0] + R[3 * i + 1] * x[1] + R[3 * i + 2] * x[2]);
}

/* sign 1: the far side acts on the piece, -1: the near side. */
static void add_section(const rig *s, dmb_place place, double sign, wrench *w)
{
    const dmb_pose pose = pose_at(s, place);
    dmb_section section = dmb_section_default();
    double force[3], moment[3];
    must(s, dmb_query_section(s->sim, place, &section));
    to_world(pose.rotation, sign, section.force, force);
    to_world(pose.rotation, sign, section.force + 3, moment);
    add_force(w, force, pose.position);
    add_moment(w, moment);
}

/* ---- Statics with an assumed slip ---------------------------------------------------------------------------------
 */

/* A string in a hole that turns in both angles; elements of 1.5 m or parts of it. */
static dmb_id open_drilled(rig *s, uint32_t elements, double spin)
{
    const double survey[9] = {0.0, 1.2, 0.0, 4.0, 1.3, 0.05, 20.0, 1.5, 0.3};
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_wall_def wall = s1_hole();
    rig_open(s, 0.0, 0.0, -9.81);
    wall.survey = survey;
    wall.survey_count = 3;
    wall.mu_static = wall.mu_dynamic = 0.25;
    (void)add_wall(s, &wall);
    def.start_free = DMB_FREE_X | DMB_FREE_RX;
    pipe.elements = elements;
    pipe.damping_time = 1e-3;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, PIPES);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_X, add_constant(s, 0.0));
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(s, spin));
    (void)rig_start(s, NULL);
    return pipe.string;
}

/* [-] No contact between the ends of an element: its two section forces differ by its weight alone. */
static double element_balance(const rig *s, dmb_id string, uint32_t pipe, uint32_t e, uint32_t elements)
{
    const double weight[3] = {0.0, 0.0, -s1_values().weight * 1.5 / elements}, nowhere[3] = {0.0};
    wrench w = {{0.0}, {0.0}, {0.0}};
    add_section(s, dmb_station(string, pipe, (e + 1e-12) / elements), -1.0, &w);
    add_section(s, dmb_station(string, pipe, (e + 1.0 - 1e-12) / elements), 1.0, &w);
    add_force(&w, weight, nowhere);
    return norm(w.force) / w.size[0];
}

static void assumed_slip(void **state)
{
    (void)state;
    for (uint32_t elements = 1; elements <= 4; elements *= 2)
        for (int way = 0; way < 4; way++) {
            rig s;
            const dmb_id string = open_drilled(&s, elements, way > 1 ? 10.0 : 0.0);
            dmb_static_options options = dmb_static_options_default();
            options.steady = DMB_STEADY_AT_REST;
            options.slip_axial = way % 2 ? 0.1 : -0.1;
            options.slip_rotation = way > 1 ? 10.0 : 0.0;
            double worst = 0.0, fastest = 0.0;
            (void)find_equilibrium(&s, &options);
            for (uint32_t p = 0; p < PIPES; p++) {
                for (uint32_t e = 0; e < elements; e++)
                    worst = fmax(worst, element_balance(&s, string, p, e, elements));
                const dmb_motion motion = motion_at(&s, dmb_station(string, p, 0.7), DMB_FRAME_WORLD);
                fastest = fmax(fastest, norm(motion.acceleration));
            }
            check_below("elements out of balance", worst, 1e-11);
            check_below("acceleration of a quasi-static state", fastest, 1e-12);
            dmb_section root = dmb_section_default();
            double reaction[6];
            must(&s, dmb_query_section(s.sim, dmb_station(string, 0, 0.0), &root));
            must(&s, dmb_query_reaction(s.sim, string, reaction));
            check_close("axial force at the rig", root.force[0], -reaction[0], 1e-7 * fabs(reaction[0]));
            check_close("torque at the rig", root.force[3], -reaction[3], 1e-7 * (fabs(reaction[3]) + 1.0));
            rig_close(&s);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(assumed_slip),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
