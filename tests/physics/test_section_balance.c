/* Section forces against Newton's law: each piece of a string between two of its sections is in balance with its
 * weight, the contacts and the loads on it. Checks eq:beam.section-force and eq:beam.section-pose. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "drillmbd/scene.h"
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

/* ---- Weight and contacts of a piece -------------------------------------------------------------------------------
 */

/* Equal pipes of equal elements without tool joints, clamped at the rig. */
typedef struct pipe_row {
    rig s;
    dmb_id string;
    uint32_t pipes, elements, points; /* points 0: contact at nodes */
    double length, radius, weight[3]; /* [m] of a pipe; 0: no wall; [N/m] */
    double mass, eccentricity;        /* [kg/m] that is accelerated, [m] */
} pipe_row;

/* x counts pipes. */
static dmb_place place_at(const pipe_row *r, double x)
{
    const uint32_t pipe = x < r->pipes ? (uint32_t)x : r->pipes - 1;
    return dmb_station(r->string, pipe, x - pipe);
}

/* -m a of the mass beside the axis, and its weight. */
static void add_mass(const pipe_row *r, dmb_place place, double length, wrench_sum *w)
{
    const double offset[3] = {0.0, r->eccentricity, 0.0};
    dmb_pose pose = dmb_pose_default();
    dmb_motion motion = dmb_motion_default();
    double force[3];
    must(&r->s, dmb_query_pose_at(r->s.sim, place, offset, &pose));
    must(&r->s, dmb_query_motion_at(r->s.sim, place, offset, &motion));
    for (int i = 0; i < 3; i++) force[i] = length * (r->weight[i] - r->mass * motion.acceleration[i]);
    add_force(w, force, pose.position);
}

/* Gauss's rule of three points over each element's part. */
static void add_weight(const pipe_row *r, double from, double to, wrench_sum *w)
{
    static const double at[3] = {-0.7745966692414834, 0.0, 0.7745966692414834}, share[3] = {5.0, 8.0, 5.0};
    for (uint32_t e = 0; e < r->pipes * r->elements; e++) {
        const double a = fmax(from, (double)e / r->elements), b = fmin(to, (e + 1.0) / r->elements);
        for (int k = 0; k < 3 && b > a; k++)
            add_mass(r, place_at(r, 0.5 * (a + b) + 0.5 * at[k] * (b - a)), share[k] / 18.0 * (b - a) * r->length, w);
    }
}

/* Number of pipes from the rig to a site: far ends of elements first, then the points inside them, in their order. */
static double site_at(const pipe_row *r, uint32_t site)
{
    static const double fraction[2][3] = {{0.5, 0.0, 0.0}, {0.17267316464601142, 0.5, 0.82732683535398858}};
    const uint32_t nodes = r->pipes * r->elements, inside = r->points > 2 ? r->points - 2 : 1;
    if (site < nodes) return (site + 1.0) / r->elements;
    return ((site - nodes) / inside + fraction[r->points == 5][(site - nodes) % inside]) / r->elements;
}

/* Friction acts at the surface, along the hole t and along t x n. */
static void add_contacts(const pipe_row *r, double from, double to, wrench_sum *w)
{
    dmb_model_info info = dmb_model_info_default();
    must(&r->s, dmb_model_get_info(r->s.model, &info));
    for (uint32_t site = 0; site < info.contact_points; site++) {
        const double x = site_at(r, site);
        dmb_contact c = dmb_contact_default();
        dmb_hole_point axis = dmb_hole_point_default();
        double normal[3], friction[3], at[3];
        if (!(x > from && x < to)) continue;
        must(&r->s, dmb_query_contact(r->s.sim, site, &c));
        const dmb_pose pose = pose_at(&r->s, place_at(r, x));
        must(&r->s, dmb_query_hole(r->s.model, pose.depth, &axis));
        const double *n = c.normal, *t = axis.tangent;
        const double b[3] = {t[1] * n[2] - t[2] * n[1], t[2] * n[0] - t[0] * n[2], t[0] * n[1] - t[1] * n[0]};
        for (int i = 0; i < 3; i++) {
            normal[i] = -c.normal_force * n[i];
            friction[i] = c.friction[0] * t[i] + c.friction[1] * b[i];
            at[i] = pose.position[i] + r->radius * n[i];
        }
        add_force(w, normal, pose.position);
        add_force(w, friction, at);
    }
}

static void worst_balance(const pipe_row *r, double from, double to, double worst[2])
{
    wrench_sum w = {{0.0}, {0.0}, {0.0}};
    add_section(&r->s, place_at(r, from), -1.0, &w);
    add_section(&r->s, place_at(r, to), 1.0, &w);
    add_weight(r, from, to, &w);
    if (r->radius > 0.0) add_contacts(r, from, to, &w);
    worst[0] = fmax(worst[0], norm(w.force) / w.size[0]);
    worst[1] = fmax(worst[1], norm(w.moment) / w.size[1]);
}

/* Pieces of all lengths: within elements, over nodes, from end to end. Forces balance to the residual of the static
 * state; moments of the weight to the square of the slopes, by which sections inside a straight element are off. */
static void check_pieces(const char *what, const pipe_row *r, double force, double moment)
{
    double worst[2] = {0.0, 0.0};
    char text[80];
    for (double from = 0.0; from < r->pipes; from += 0.3137)
        for (double to = from + 0.1713; to <= r->pipes; to += 0.4271) worst_balance(r, from, to, worst);
    worst_balance(r, 0.0, r->pipes, worst);
    (void)snprintf(text, sizeof text, "%s, %u elements, %u points: forces", what, r->elements, r->points);
    check_below(text, worst[0], force);
    (void)snprintf(text, sizeof text, "%s, %u elements, %u points: moments", what, r->elements, r->points);
    check_below(text, worst[1], moment);
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
                           const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                           const dmb_law_memory *memory)
{
    (void)memory;
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

/* Closer to a node than a quarter of the diameter a load and a stuck place act by the element's interpolation: sections
 * are in balance with them all the same. */
static void near_a_node(uint32_t elements, double at)
{
    double along[6] = {1000.0, 0.0, 0.0, 50.0, 0.0, 0.0};
    rod r = open_rod(DMB_PIPE_FLEXIBLE, elements, DMB_FREE_NONE, at);
    add_wrench(&r, BY_LOAD, along);
    (void)rig_start(&r.s, NULL);
    (void)find_equilibrium(&r.s, NULL);
    for (double f = 0.0005; f < 1.0; f += 0.0331) {
        check_close("axial force", section_of(&r, f, 0), f < at ? 1000.0 : 0.0, 1e-7);
        check_close("torque", section_of(&r, f, 3), f < at ? 50.0 : 0.0, 1e-8);
    }
    rig_close(&r.s);
}

static void stuck_near_a_node(uint32_t elements, double at)
{
    rod r = open_rod(DMB_PIPE_FLEXIBLE, elements, DMB_FREE_X | DMB_FREE_RX, 0.0);
    double pull[6] = {-1000.0, 0.0, 0.0, 50.0, 0.0, 0.0};
    dmb_stuck_def stuck = dmb_stuck_def_default();
    stuck.place = place_of(&r, at);
    stuck.holds = DMB_STUCK_AXIAL | DMB_STUCK_ROTATION;
    stuck.stuck = 1;
    must_model(&r.s, dmb_model_add_stuck(r.s.model, &stuck, NULL));
    add_wrench(&r, BY_LOAD, pull);
    (void)rig_start(&r.s, NULL);
    (void)find_equilibrium(&r.s, NULL);
    for (double f = 0.0005; f < 1.0; f += 0.0331) {
        check_close("pull", section_of(&r, f, 0), f < at ? 1000.0 : 0.0, 1e-6);
        check_close("torque", section_of(&r, f, 3), f < at ? -50.0 : 0.0, 1e-7);
    }
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
            near_a_node(elements, p == 0 ? 0.002 : 0.998);
            stuck_near_a_node(elements, p == 0 ? 0.002 : 0.998);
        }
}

/* ---- Contact along elements -------------------------------------------------------------------------------------- */

static pipe_row lie(const dmb_wall_def *hole, uint32_t elements, uint32_t points, double length, double slip)
{
    pipe_row r = {.pipes = 3, .elements = elements, .points = points, .length = length};
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_wall_def wall = *hole;
    dmb_static_options options = dmb_static_options_default();
    rig_open(&r.s, 0.0, 0.0, -9.81);
    wall.mu_static = wall.mu_dynamic = 0.3;
    (void)add_wall(&r.s, &wall);
    def.start_free = DMB_FREE_NONE;
    pipe.elements = elements;
    pipe.contact_points = points;
    pipe.length = length;
    pipe.string = r.string = add_string(&r.s, &def);
    (void)add_pipes(&r.s, &pipe, r.pipes);
    r.radius = 0.5 * pipe.outer_diameter;
    r.weight[2] = -s1_values().weight;
    (void)rig_start(&r.s, NULL);
    options.slip_axial = slip;
    options.slip_rotation = 2.0 * slip;
    (void)find_equilibrium(&r.s, &options);
    return r;
}

/* Of no moment; it bears the contact at the end. */
static void check_free_end(const pipe_row *r)
{
    dmb_section end = dmb_section_default();
    dmb_contact last = dmb_contact_default();
    must(&r->s, dmb_query_section(r->s.sim, place_at(r, r->pipes), &end));
    must(&r->s, dmb_query_contact(r->s.sim, r->pipes * r->elements - 1, &last));
    check_close("shear at the free end", end.force[2], last.normal_force, 1e-3 * last.normal_force);
    check_close("moment at the free end", hypot(end.force[4], end.force[5]), 0.0, 1e-6 * last.normal_force);
}

/* Pipes clamped on the axis of a level hole come down to the wall. */
static void contact_along(void **state)
{
    static const uint32_t points[3] = {0, 3, 5};
    (void)state;
    for (uint32_t elements = 1; elements <= 4; elements *= 2)
        for (int p = 0; p < 3; p++)
            for (int slipping = 0; slipping < 2; slipping++) {
                const dmb_wall_def wall = s1_hole();
                pipe_row r = lie(&wall, elements, points[p], 9.0, 0.1 * slipping);
                check_pieces("level wall", &r, 1e-9, 3e-6);
                if (!slipping) check_free_end(&r);
                rig_close(&r.s);
            }
}

/* Curved in both angles. */
static void contact_in_a_turning_hole(void **state)
{
    const double survey[9] = {0.0, 1.2, 0.0, 3.0, 1.25, 0.05, 30.0, 1.5, 0.3};
    (void)state;
    for (uint32_t elements = 1; elements <= 4; elements *= 2)
        for (uint32_t points = 0; points <= 5; points += points == 0 ? 3 : 2) {
            dmb_wall_def wall = s1_hole();
            wall.survey = survey;
            wall.survey_count = 3;
            pipe_row r = lie(&wall, elements, points, 3.0, 0.1);
            check_pieces("turning hole", &r, 1e-9, 3e-6);
            rig_close(&r.s);
        }
}

/* ---- Eccentric and moving mass ----------------------------------------------------------------------------------- */

/* A shaft of 5 m, 50 mm, clamped or turning at its rig end, and free at the other. */
static pipe_row shaft(uint32_t elements, double eccentricity, double gravity, double spin)
{
    pipe_row r = {.pipes = 5, .elements = elements, .length = 1.0, .eccentricity = eccentricity};
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(&r.s, 0.0, 0.0, -gravity);
    def.follows_hole = 0;
    def.start_free = spin > 0.0 ? DMB_FREE_RX : DMB_FREE_NONE;
    pipe.elements = elements;
    pipe.length = r.length;
    pipe.outer_diameter = 0.05;
    pipe.inner_diameter = 0.0;
    pipe.density = 7850.0;
    pipe.eccentricity = eccentricity;
    r.mass = 0.25 * 3.14159265358979323846 * 0.05 * 0.05 * pipe.density;
    r.weight[2] = -r.mass * gravity;
    pipe.string = r.string = add_string(&r.s, &def);
    (void)add_pipes(&r.s, &pipe, r.pipes);
    if (spin > 0.0) (void)add_simple_drive(&r.s, DMB_DRIVE_MOTION, r.string, DMB_RX, add_constant(&r.s, spin));
    (void)rig_start(&r.s, NULL);
    return r;
}

static void check_root(const pipe_row *r)
{
    dmb_section root = dmb_section_default(), end = dmb_section_default();
    double reaction[6], size[2] = {0.0, 0.0};
    must(&r->s, dmb_query_section(r->s.sim, place_at(r, 0.0), &root));
    must(&r->s, dmb_query_section(r->s.sim, place_at(r, r->pipes), &end));
    must(&r->s, dmb_query_reaction(r->s.sim, r->string, reaction));
    for (int i = 0; i < 6; i++) size[i / 3] += fabs(reaction[i]);
    for (int i = 0; i < 6; i++) {
        check_close("root against the reaction", root.force[i], -reaction[i], 1e-9 * size[i / 3] + 1e-9);
        check_close("free end", end.force[i], 0.0, 1e-9 * size[i / 3] + 1e-9);
    }
}

static void eccentric_mass(void **state)
{
    (void)state;
    for (uint32_t elements = 1; elements <= 4; elements *= 2) {
        pipe_row r = shaft(elements, 0.02, 9.81, 0.0);
        (void)find_equilibrium(&r.s, NULL);
        check_root(&r);
        check_pieces("weight beside the axis", &r, 2e-9, 1e-6);
        rig_close(&r.s);
        r = shaft(elements, 0.02, 0.0, 5.0);
        (void)find_equilibrium(&r.s, NULL); /* in steady rotation */
        check_root(&r);
        check_pieces("turning shaft", &r, 1e-4, 1e-4);
        rig_close(&r.s);
    }
}

/* Let go from level rest: inertia that grows along the elements. */
static void falling(void **state)
{
    (void)state;
    for (uint32_t elements = 1; elements <= 4; elements *= 2) {
        pipe_row r = shaft(elements, 0.0, 9.81, 0.0);
        for (int i = 0; i < 200; i++) must(&r.s, dmb_sim_step(r.s.sim, 1e-3, NULL));
        check_pieces("falling", &r, 0.01, 0.01);
        rig_close(&r.s);
    }
}

/* ---- Tool joints ------------------------------------------------------------------------------------------------- */

/* A string that hangs in mud: each section bears the buoyant weight of body and tool joints below it. */
static void tool_joints(void **state)
{
    (void)state;
    for (uint32_t elements = 1; elements <= 4; elements *= 2) {
        rig s;
        dmb_string_def def = dmb_string_def_default();
        dmb_pipe_def pipe = s1_pipe();
        dmb_environment_def mud = dmb_environment_def_default();
        rig_open(&s, 0.0, 0.0, -9.81);
        mud.gravity[2] = -9.81;
        mud.fluid_density = 1100.0;
        must_model(&s, dmb_model_set_environment(s.model, &mud));
        def.follows_hole = 0;
        def.start_free = DMB_FREE_NONE;
        def.rotation[1] = 0.5 * 3.14159265358979323846; /* body x downwards */
        pipe.elements = elements;
        pipe.joint_length = 0.3;
        pipe.joint_outer_diameter = 0.1;
        pipe.joint_mass = 12.0;
        pipe.string = add_string(&s, &def);
        (void)add_pipes(&s, &pipe, 3);
        (void)rig_start(&s, NULL);
        (void)find_equilibrium(&s, NULL);
        const double lift = 9.81 * (1.0 - mud.fluid_density / pipe.density);
        const double body = s1_values().mass * lift, joint = pipe.joint_mass / pipe.joint_length * lift;
        for (uint32_t p = 0; p < 3; p++)
            for (double f = 0.0; f <= 1.0; f += 0.0625) {
                dmb_section section = dmb_section_default();
                const double at = f * pipe.length, in_body = fmax(0.0, 1.2 - at), in_joint = fmin(0.3, 1.5 - at);
                must(&s, dmb_query_section(s.sim, dmb_station(pipe.string, p, f), &section));
                check_close("weight below", section.force[0],
                            (2 - p) * (1.2 * body + 0.3 * joint) + in_body * body + in_joint * joint, 1e-7);
            }
        rig_close(&s);
    }
}

/* ---- External damping -------------------------------------------------------------------------------------------- */

static const double lateral_damping = 40.0, axial_damping = 30.0, torsional_damping = 0.5;

/* A rod whose rig end moves at a constant speed, once it has settled. */
static rod open_dragged(int32_t kind, uint32_t elements, int32_t start_free, const double speeds[6])
{
    rod r = open_rod(kind, elements, start_free, 1.0);
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    environment.gravity[2] = 0.0;
    environment.lateral_damping = lateral_damping;
    environment.axial_damping = axial_damping;
    environment.torsional_damping = torsional_damping;
    must_model(&r.s, dmb_model_set_environment(r.s.model, &environment));
    for (int32_t c = 0; c < 6; c++)
        if (speeds[c] != 0.0)
            (void)add_simple_drive(&r.s, DMB_DRIVE_MOTION, r.string, c, add_constant(&r.s, speeds[c]));
    options.spectral_radius = 0.0;
    options.newton_tolerance = 1e-12;
    (void)rig_start(&r.s, &options);
    take_steps(&r.s, 1e-2, 600);
    return r;
}

/* Fed and rotated: the damping beyond a section pulls and twists it. */
static void damped_along_and_about(int32_t kind, uint32_t elements)
{
    const double speeds[6] = {0.3, 0.0, 0.0, 10.0, 0.0, 0.0}, L = rod_length;
    rod r = open_dragged(kind, elements, DMB_FREE_X | DMB_FREE_RX, speeds);
    const double pull = axial_damping * 0.3, twist = torsional_damping * 10.0;
    for (double f = 0.05; f < 1.0 && kind == DMB_PIPE_FLEXIBLE; f += 0.1) {
        check_close("axial force by damping", section_of(&r, f, 0), -pull * (1.0 - f) * L, 1e-6 * pull);
        check_close("torque by damping", section_of(&r, f, 3), -twist * (1.0 - f) * L, 1e-6 * twist);
    }
    check_relative("hook load", dmb_sim_value(r.s.sim, DMB_OUTPUT_HOOK_LOAD, place_of(&r, 0.0)), -pull * L, 1e-6);
    check_relative("torque of the rig", dmb_sim_value(r.s.sim, DMB_OUTPUT_ROTATION_TORQUE, place_of(&r, 0.0)),
                   twist * L, 1e-6);
    rig_close(&r.s);
}

static void damped_across(uint32_t elements)
{
    const double speeds[6] = {0.0, 1e-3, 0.0, 0.0, 0.0, 0.0}, q = lateral_damping * 1e-3;
    rod r = open_dragged(DMB_PIPE_FLEXIBLE, elements, DMB_FREE_Y, speeds);
    for (double f = 0.05; f < 1.0; f += 0.1) {
        const double beyond = (1.0 - f) * rod_length;
        check_close("shear force by damping", section_of(&r, f, 1), -q * beyond, 1e-6 * q);
        check_close("bending moment by damping", section_of(&r, f, 5), -0.5 * q * beyond * beyond, 1e-6 * q);
    }
    rig_close(&r.s);
}

/* The same of a pipe that ends with a tool joint, whose node is beyond it. */
static void damped_tool_joints(uint32_t elements)
{
    const double speed = 0.3, length = 1.5;
    rig s;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_environment_def environment = dmb_environment_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    environment.gravity[2] = 0.0;
    environment.lateral_damping = lateral_damping;
    environment.axial_damping = axial_damping;
    must_model(&s, dmb_model_set_environment(s.model, &environment));
    def.start_free = DMB_FREE_XY;
    pipe.elements = elements;
    pipe.joint_length = 0.3, pipe.joint_outer_diameter = 0.1, pipe.joint_mass = 12.0;
    pipe.damping_time = 1e-2;
    pipe.string = add_string(&s, &def);
    (void)add_pipes(&s, &pipe, 2);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, pipe.string, DMB_X, add_constant(&s, speed));
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, pipe.string, DMB_Y, add_constant(&s, 1e-3 * speed));
    dmb_sim_options options = dmb_sim_options_default();
    options.spectral_radius = 0.0, options.newton_tolerance = 1e-12;
    (void)rig_start(&s, &options);
    take_divided_steps(&s, 1e-2, 2000);
    for (uint32_t p = 0; p < 2; p++)
        for (double f = 0.0; f <= 1.0; f += 0.0625) {
            const double beyond = (2.0 - p - f) * length, pull = axial_damping * speed,
                         q = 1e-3 * lateral_damping * speed;
            dmb_section section = dmb_section_default();
            must(&s, dmb_query_section(s.sim, dmb_station(pipe.string, p, f), &section));
            check_close("axial force by damping", section.force[0], -pull * beyond, 1e-5 * pull);
            check_close("shear force by damping", section.force[1], -q * beyond, 1e-3 * q);
            check_close("bending moment by damping", section.force[5], -0.5 * q * beyond * beyond, 1e-3 * q);
        }
    rig_close(&s);
}

static void external_damping_is_distributed(void **state)
{
    (void)state;
    for (uint32_t elements = 1; elements <= 4; elements *= 2) {
        damped_along_and_about(DMB_PIPE_FLEXIBLE, elements);
        damped_along_and_about(DMB_PIPE_AXIAL_TORSIONAL, elements);
        damped_across(elements);
        damped_tool_joints(elements);
    }
}

/* ---- Added mass -------------------------------------------------------------------------------------------------- */

/* A rod that its rig end swings with a constant angular acceleration, once it has settled: the inertia of rod and mud
 * grows along it. Bent by `curvature` its elements are evaluated alone, otherwise in lanes. */
static void swung_in_mud(uint32_t elements, double curvature)
{
    static const double time[2] = {0.0, 100.0}, speed[2] = {0.0, 1e-2};
    const double L = rod_length, area = 0.25 * PI * 0.02 * 0.02, rate = speed[1] / time[1];
    dmb_pipe_def pipe = beam_pipe(L, elements, EA, GA, GJ, EI);
    dmb_environment_def mud = dmb_environment_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_segment ramp = dmb_segment_default();
    rod r = {.at = 1.0};
    rig_open(&r.s, 0.0, 0.0, 0.0);
    mud.gravity[2] = 0.0;
    mud.fluid_density = 1000.0;
    mud.added_mass = 20.0;
    must_model(&r.s, dmb_model_set_environment(r.s.model, &mud));
    pipe.damping_time = 0.3;
    pipe.curvature[2] = curvature;
    r.string = add_beam(&r.s, &pipe, DMB_FREE_RZ);
    ramp.kind = DMB_SEGMENT_TABLE;
    ramp.table_count = 2, ramp.table_time = time, ramp.table_value = speed;
    (void)add_simple_drive(&r.s, DMB_DRIVE_MOTION, r.string, DMB_RZ, add_time_function(&r.s, &ramp, 1));
    options.spectral_radius = 0.0, options.newton_tolerance = 1e-12;
    (void)rig_start(&r.s, &options);
    take_steps(&r.s, 1e-2, 800);
    const double q = rate * area * (pipe.density + mud.added_mass * mud.fluid_density);
    for (double f = 0.05; f < 1.0; f += 0.1) {
        const double x = f * L;
        check_close("shear force by inertia", section_of(&r, f, 1), -0.5 * q * (L * L - x * x), 1e-5 * q * L * L);
        check_close("bending moment by inertia", section_of(&r, f, 5),
                    -q * (L * L * L / 3.0 - 0.5 * x * L * L + x * x * x / 6.0), 1e-5 * q * L * L * L);
    }
    rig_close(&r.s);
}

static void mud_is_accelerated(void **state)
{
    (void)state;
    for (uint32_t elements = 1; elements <= 4; elements *= 2)
        for (int bent = 0; bent < 2; bent++) swung_in_mud(elements, 1e-6 * bent);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(assumed_slip),       cmocka_unit_test(forces_inside),
        cmocka_unit_test(contact_along),      cmocka_unit_test(contact_in_a_turning_hole),
        cmocka_unit_test(eccentric_mass),     cmocka_unit_test(falling),
        cmocka_unit_test(tool_joints),        cmocka_unit_test(external_damping_is_distributed),
        cmocka_unit_test(mud_is_accelerated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
