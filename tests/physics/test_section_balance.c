/* Section forces against Newton's law: each piece of a string between two of its sections is in balance with its
 * weight, the contacts and the loads on it. */
#include <math.h>
#include <string.h>

#include "drillmbd/bha.h"
#include "drillmbd/forces.h"
#include "rig.h"

enum { PIPES = 6 };

/* ---- Forces on a piece, in world axes about the world's origin ----------------------------------------------------
 */

typedef struct wrench_sum {
    double force[3], moment[3];
    double size[2]; /* [N, N m] sums of magnitudes */
} wrench_sum;

static double norm(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void add_force(wrench_sum *w, const double force[3], const double at[3])
{
    const double m[3] = {at[1] * force[2] - at[2] * force[1], at[2] * force[0] - at[0] * force[2],
                         at[0] * force[1] - at[1] * force[0]};
    for (int i = 0; i < 3; i++) w->force[i] += force[i], w->moment[i] += m[i];
    w->size[0] += norm(force);
    w->size[1] += norm(m);
}

static void add_moment(wrench_sum *w, const double moment[3])
{
    for (int i = 0; i < 3; i++) w->moment[i] += moment[i];
    w->size[1] += norm(moment);
}

static void to_world(const double R[9], double sign, const double x[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = sign * (R[3 * i] * x[0] + R[3 * i + 1] * x[1] + R[3 * i + 2] * x[2]);
}

/* sign 1: the far side acts on the piece, -1: the near side. */
static void add_section(const rig *s, dmb_place place, double sign, wrench_sum *w)
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
    wrench_sum w = {{0.0}, {0.0}, {0.0}};
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

/* ---- Forces inside a pipe ---------------------------------------------------------------------------------------- */

static const double rod_length = 2.0, EA = 2e6, GA = 8e5, GJ = 300.0, EI = 400.0;

enum { BY_LOAD, BY_CALLER, WAYS };

typedef struct rod {
    rig s;
    dmb_id string;
    double at; /* [-] of the pipe: where the force acts */
} rod;

static rod open_rod(int32_t kind, uint32_t elements, int32_t start_free, double at)
{
    rod r = {.at = at};
    dmb_pipe_def pipe = beam_pipe(rod_length, elements, EA, GA, GJ, EI);
    pipe.kind = kind;
    rig_open(&r.s, 0.0, 0.0, 0.0);
    r.string = add_beam(&r.s, &pipe, start_free);
    return r;
}

static dmb_place place_of(const rod *r, double fraction)
{
    return dmb_station(r->string, 0, fraction);
}

static int32_t given_force(void *context, double time, uint32_t count, const double (*poses)[12],
                           const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential)
{
    (void)time, (void)count, (void)poses, (void)velocities, (void)tangent, (void)potential;
    memcpy(forces[0], context, 6 * sizeof(double));
    return 0;
}

static void add_wrench(rod *r, int way, double wrench[6])
{
    if (way == BY_LOAD) {
        dmb_load_def load = dmb_load_def_default();
        load.place = place_of(r, r->at);
        for (int i = 0; i < 3; i++) load.force[i] = wrench[i], load.moment[i] = wrench[3 + i];
        (void)add_load(&r->s, &load);
    } else {
        dmb_force_def force = dmb_force_def_default();
        force.place[0] = place_of(r, r->at);
        force.callback = given_force;
        force.callback_context = wrench;
        must_model(&r->s, dmb_model_add_force(r->s.model, &force, NULL));
    }
}

static double section_of(const rod *r, double fraction, int component)
{
    dmb_section section = dmb_section_default();
    must(&r->s, dmb_query_section(r->s.sim, place_of(r, fraction), &section));
    return section.force[component];
}

/* A force along and a torque about a clamped rod: none of it beyond the place. */
static void along_and_about(int32_t kind, uint32_t elements, int way, double at)
{
    double wrench[6] = {1000.0, 0.0, 0.0, 50.0, 0.0, 0.0};
    rod r = open_rod(kind, elements, DMB_FREE_NONE, at);
    add_wrench(&r, way, wrench);
    (void)rig_start(&r.s, NULL);
    (void)find_equilibrium(&r.s, NULL);
    for (double f = 0.05; f < 1.0; f += 0.1) {
        check_close("axial force", section_of(&r, f, 0), f < at ? 1000.0 : 0.0, 1e-7);
        check_close("torque", section_of(&r, f, 3), f < at ? 50.0 : 0.0, 1e-8);
    }
    check_close("displacement", pose_at(&r.s, place_of(&r, at)).displacement[0], 1000.0 * at * rod_length / EA, 1e-12);
    check_close("rotation", rotation_at(&r.s, place_of(&r, at)), 50.0 * at * rod_length / GJ, 1e-9);
    rig_close(&r.s);
}

/* A force across it, small enough for the linear solution. */
static void across(uint32_t elements, int way, double at)
{
    const double P = 1e-3, a = at * rod_length, w = P * (a * a * a / (3.0 * EI) + a / GA);
    double wrench[6] = {0.0, P, 0.0, 0.0, 0.0, 0.0};
    rod r = open_rod(DMB_PIPE_FLEXIBLE, elements, DMB_FREE_NONE, at);
    add_wrench(&r, way, wrench);
    (void)rig_start(&r.s, NULL);
    (void)find_equilibrium(&r.s, NULL);
    for (double f = 0.05; f < 1.0; f += 0.1) {
        check_close("shear force", section_of(&r, f, 1), f < at ? P : 0.0, 1e-8 * P);
        check_close("bending moment", section_of(&r, f, 5), f < at ? P * (a - f * rod_length) : 0.0, 1e-8 * P);
    }
    check_relative("deflection at the force", pose_at(&r.s, place_of(&r, at)).displacement[1], w, 1e-7);
    check_relative("deflection of the end", pose_at(&r.s, place_of(&r, 1.0)).displacement[1],
                   w + P * a * a / (2.0 * EI) * (rod_length - a), 1e-7);
    rig_close(&r.s);
}

/* A spring from inside the rod to the ground takes k u of the pull at its end. */
static void held_by_a_spring(int32_t kind, uint32_t elements, double at)
{
    const double F = 500.0, k = 1e6, a = at * rod_length, spring_force = k * a * F / (EA + k * a);
    rod r = open_rod(kind, elements, DMB_FREE_NONE, at);
    dmb_spring_def spring = dmb_spring_def_default();
    double wrench[6] = {F, 0.0, 0.0, 0.0, 0.0, 0.0};
    spring.place_a = place_of(&r, at);
    spring.offset_b[0] = -3.0;
    spring.stiffness = k;
    must_model(&r.s, dmb_model_add_spring(r.s.model, &spring, NULL));
    r.at = 1.0;
    add_wrench(&r, BY_LOAD, wrench);
    (void)rig_start(&r.s, NULL);
    (void)find_equilibrium(&r.s, NULL);
    check_close("before the spring", section_of(&r, at - 0.2, 0), F - spring_force, 1e-7);
    check_close("behind it", section_of(&r, at + 0.2, 0), F, 1e-7);
    rig_close(&r.s);
}

/* Pulled and twisted at the rig, stuck inside: nothing of it arrives beyond. */
static void held_where_stuck(int32_t kind, uint32_t elements, double at)
{
    rod r = open_rod(kind, elements, DMB_FREE_X | DMB_FREE_RX, 0.0);
    double wrench[6] = {-1000.0, 0.0, 0.0, 50.0, 0.0, 0.0};
    dmb_stuck_def stuck = dmb_stuck_def_default();
    stuck.place = place_of(&r, at);
    stuck.holds = DMB_STUCK_AXIAL | DMB_STUCK_ROTATION;
    stuck.stuck = 1;
    must_model(&r.s, dmb_model_add_stuck(r.s.model, &stuck, NULL));
    add_wrench(&r, BY_LOAD, wrench);
    (void)rig_start(&r.s, NULL);
    (void)find_equilibrium(&r.s, NULL);
    check_close("pull up to the place", section_of(&r, at - 0.2, 0), 1000.0, 1e-6);
    check_close("torque up to the place", section_of(&r, at - 0.2, 3), -50.0, 1e-7);
    check_close("pull beyond", section_of(&r, at + 0.2, 0), 0.0, 1e-6);
    check_close("torque beyond", section_of(&r, at + 0.2, 3), 0.0, 1e-7);
    rig_close(&r.s);
}

static void forces_inside(void **state)
{
    static const double places[] = {0.5, 0.37, 0.711};
    (void)state;
    for (uint32_t elements = 1; elements <= 4; elements *= 2)
        for (int p = 0; p < 3; p++) {
            for (int32_t kind = DMB_PIPE_FLEXIBLE; kind <= DMB_PIPE_AXIAL_TORSIONAL; kind++) {
                for (int way = 0; way < WAYS; way++) along_and_about(kind, elements, way, places[p]);
                held_by_a_spring(kind, elements, places[p]);
                held_where_stuck(kind, elements, places[p]);
            }
            for (int way = 0; way < WAYS; way++) across(elements, way, places[p]);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(assumed_slip),
        cmocka_unit_test(forces_inside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
