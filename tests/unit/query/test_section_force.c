/* A cantilever under tip loads small enough for the linear solution: pose, section loads, strains and reaction at any
 * place of it, inside the elements as well as at the nodes. Timoshenko: w' = theta + V/GA, theta' = M/EI. */
#include "close.h"
#include "rig.h"

static const double stations[] = {0.0, 0.05, 0.2, 0.37, 0.5, 0.61, 0.8, 0.93, 1.0};
enum { STATIONS = sizeof stations / sizeof stations[0] };

typedef struct cantilever {
    rig s;
    dmb_id string;
    double length, flexible;
    double force[3], moment[3];
} cantilever;

/* 1.5 m of S1 pipe along a slanted axis, loaded at its tip in its own frame. */
static cantilever make(uint32_t elements, double joint)
{
    cantilever c = {.length = 1.5, .flexible = 1.5 - joint, .force = {3.0, 1.0, -2.0}, .moment = {2.0, 0.5, 0.25}};
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def load = dmb_load_def_default();
    rig_open(&c.s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_NONE;
    for (int i = 0; i < 3; i++) string.position[i] = 2.0 * i - 1.0, string.rotation[i] = 0.4 - 0.3 * i;
    c.string = add_string(&c.s, &string);
    pipe.elements = elements;
    pipe.joint_length = joint;
    add_pipes(&c.s, &pipe, 1);
    load.frame = DMB_FRAME_BODY;
    load.place = dmb_station(c.string, 0, 1.0);
    for (int i = 0; i < 3; i++) load.force[i] = c.force[i], load.moment[i] = c.moment[i];
    must_model(&c.s, dmb_model_add_load(c.s.model, &load, NULL));
    rig_start(&c.s, NULL);
    find_equilibrium(&c.s, NULL);
    return c;
}

/* R^T x with the string's own frame at time 0 */
static void into_frame(const cantilever *c, const double x[3], double out[3])
{
    const dmb_pose pose = pose_at(&c->s, dmb_station(c->string, 0, 0.0)); /* clamped: as at time 0 */
    for (int k = 0; k < 3; k++)
        out[k] = pose.rotation[k] * x[0] + pose.rotation[3 + k] * x[1] + pose.rotation[6 + k] * x[2];
}

/* Displacement, turning and section load at s [m] in the linear theory. The joint, beyond `flexible`, does not bend. */
static void linear_theory(const cantilever *c, double s, double u[3], double turn[3], double load[6])
{
    const s1_section v = s1_values();
    const double x = fmin(s, c->flexible), beyond = s - x, L = c->length;
    for (int plane = 0; plane < 2; plane++) {
        const int w = 1 + plane, t = 2 - plane; /* (u_y, theta_z), (u_z, -theta_y) */
        const double sign = plane ? -1.0 : 1.0, F = c->force[w], M = sign * c->moment[t] + F * L; /* at the clamp */
        const double theta = (M * x - 0.5 * F * x * x) / v.EI;
        u[w] = (0.5 * M * x * x - F * x * x * x / 6.0) / v.EI + F * x / v.GA + beyond * theta;
        turn[t] = sign * theta;
        load[w] = F;
        load[3 + t] = sign * (M - F * s);
    }
    u[0] = c->force[0] * x / v.EA;
    turn[0] = c->moment[0] * x / v.GJ;
    load[0] = c->force[0];
    load[3] = c->moment[0];
}

static void check_station(const cantilever *c, double fraction)
{
    const dmb_pose pose = pose_at(&c->s, dmb_station(c->string, 0, fraction));
    const dmb_pose clamp = pose_at(&c->s, dmb_station(c->string, 0, 0.0));
    dmb_section section = dmb_section_default();
    double u[3], want_u[3], want_turn[3], want_load[6], Q[9];
    must(&c->s, dmb_query_section(c->s.sim, dmb_station(c->string, 0, fraction), &section));
    linear_theory(c, fraction * c->length, want_u, want_turn, want_load);
    into_frame(c, pose.displacement, u);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            Q[3 * i + j] = 0.0;
            for (int k = 0; k < 3; k++) Q[3 * i + j] += clamp.rotation[3 * k + i] * pose.rotation[3 * k + j];
        }
    const double turn[3] = {0.5 * (Q[7] - Q[5]), 0.5 * (Q[2] - Q[6]), 0.5 * (Q[3] - Q[1])};
    for (int i = 0; i < 3; i++) CHECK_CLOSE(u[i], want_u[i], 3e-10);       /* of 1e-5: what is left is second order */
    for (int i = 0; i < 3; i++) CHECK_CLOSE(turn[i], want_turn[i], 3e-10); /* of 2e-5 */
    for (int i = 0; i < 6; i++) CHECK_CLOSE(section.force[i], want_load[i], 2e-4);
}

static void every_place_of_it(void **state)
{
    (void)state;
    const uint32_t elements[] = {1, 3};
    const double joints[] = {0.0, 0.3};
    for (int e = 0; e < 2; e++)
        for (int j = 0; j < 2; j++) {
            cantilever c = make(elements[e], joints[j]);
            for (int i = 0; i < STATIONS; i++) check_station(&c, stations[i]);
            rig_close(&c.s);
        }
}

/* Means of an element: F/EA, V/GA, T/GJ, M in the middle over EI. */
static void strains(void **state)
{
    (void)state;
    const s1_section v = s1_values();
    cantilever c = make(3, 0.0);
    for (int e = 0; e < 3; e++) {
        dmb_section section = dmb_section_default();
        double u[3], turn[3], load[6];
        must(&c.s, dmb_query_section(c.s.sim, dmb_station(c.string, 0, (e + 0.2) / 3.0), &section));
        linear_theory(&c, (e + 0.5) / 3.0 * c.length, u, turn, load);
        const double stiffness[6] = {v.EA, v.GA, v.GA, v.GJ, v.EI, v.EI};
        for (int i = 0; i < 6; i++)
            CHECK_CLOSE(section.strain[i], load[i] / stiffness[i], 1e-4 * fabs(load[i] / stiffness[i]) + 1e-12);
    }
    rig_close(&c.s);
}

/* The clamp holds against the loads. */
static void reaction(void **state)
{
    (void)state;
    cantilever c = make(2, 0.0);
    double got[6];
    must(&c.s, dmb_query_reaction(c.s.sim, c.string, got));
    const double *F = c.force, *M = c.moment, L = c.length;
    const double want[6] = {-F[0], -F[1], -F[2], -M[0], -M[1] + L * F[2], -M[2] - L * F[1]};
    for (int i = 0; i < 6; i++) CHECK_CLOSE(got[i], want[i], 2e-4);
    rig_close(&c.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_place_of_it),
        cmocka_unit_test(strains),
        cmocka_unit_test(reaction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
