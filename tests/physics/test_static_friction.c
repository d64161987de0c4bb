/* Contact queries after a static start that slips, against Newton's law of the whole: friction, normal forces, weight
 * and the force at the far end balance what the support and the drive hold, in every law and direction, after a
 * snapshot too; a step in time takes it away again. */
#include <stdlib.h>

#include "rig.h"

#define PIPES 20
#define MU 0.3

/* Holes in a vertical plane: inclination at the start and its rate [rad/m]. */
typedef struct scene_choice {
    int32_t law, kind;
    double inclination, bend, slip[2], end[6];
} scene_choice;

typedef struct scene {
    rig rig;
    dmb_id string, drive;
    const scene_choice *choice;
} scene;

static void add_hole(scene *s)
{
    const scene_choice *c = s->choice;
    const double survey[6] = {0.0, c->inclination, 0.0, 200.0, c->inclination + 200.0 * c->bend, 0.0};
    dmb_wall_def wall = s1_hole();
    wall.survey = survey;
    wall.survey_count = 2;
    wall.friction_law = c->law;
    wall.mu_static = wall.mu_dynamic = MU;
    wall.smoothing_speed = c->law == DMB_FRICTION_AMBROSIO ? 1e-4 : 1e-3;
    wall.stribeck_speed = 2e-2;
    if (c->law == DMB_FRICTION_STRIBECK || c->law == DMB_FRICTION_BRISTLE) wall.mu_static = 0.35;
    (void)add_wall(&s->rig, &wall);
}

static void open_scene(scene *s, const scene_choice *choice)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    dmb_load_def load = dmb_load_def_default();
    s->choice = choice;
    rig_open(&s->rig, 0.0, 0.0, -9.81);
    add_hole(s);
    def.start_free = DMB_FREE_X;
    def.start_depth = 5.0;
    pipe.kind = choice->kind;
    pipe.elements = 1; /* so that each contact is at the far end of its pipe */
    pipe.string = s->string = add_string(&s->rig, &def);
    (void)add_pipes(&s->rig, &pipe, PIPES);
    load.frame = DMB_FRAME_WORLD;
    load.place = dmb_station(s->string, PIPES - 1, 1.0);
    for (int i = 0; i < 3; i++) load.force[i] = choice->end[i], load.moment[i] = choice->end[3 + i];
    (void)add_load(&s->rig, &load);
    s->drive = add_simple_drive(&s->rig, DMB_DRIVE_MOTION, s->string, DMB_X, add_constant(&s->rig, 0.0));
    (void)rig_start(&s->rig, NULL);
}

static void rest(const scene *s)
{
    dmb_static_options options = dmb_static_options_default();
    options.slip_axial = s->choice->slip[0];
    options.slip_rotation = s->choice->slip[1];
    options.tolerance = 1e-13;
    (void)find_equilibrium(&s->rig, &options);
}

static double drive_force(const scene *s)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(&s->rig, dmb_query_drive(s->rig.sim, s->drive, &state));
    return state.force;
}

/* Direction of the hole at a point of its plane, world: along t0, or around the centre of the arc. */
static void tangent_at(const scene *s, dmb_place place, double t[3])
{
    const double bend = s->choice->bend, I = s->choice->inclination;
    const dmb_pose pose = pose_at(&s->rig, place);
    double inclination = I;
    if (bend != 0.0) {
        const double side = bend > 0.0 ? 1.0 : -1.0;
        const double x = cos(I) / bend - pose.position[0], z = sin(I) / bend - pose.position[2];
        inclination = atan2(side * z, side * x);
    }
    t[0] = sin(inclination);
    t[1] = 0.0;
    t[2] = -cos(inclination);
}

/* Force of a contact on the pipe, world: -N n + F_t t + F_b t x n. */
static void add_contact_force(const scene *s, const dmb_contact *c, double f[3])
{
    double t[3];
    const int start = c->pipe == DMB_NONE;
    tangent_at(s, dmb_station(s->string, start ? 0 : c->pipe, start ? 0.0 : 1.0), t);
    const double b[3] = {t[1] * c->normal[2] - t[2] * c->normal[1], t[2] * c->normal[0] - t[0] * c->normal[2],
                         t[0] * c->normal[1] - t[1] * c->normal[0]};
    for (int i = 0; i < 3; i++) f[i] += -c->normal_force * c->normal[i] + c->friction[0] * t[i] + c->friction[1] * b[i];
}

typedef struct totals {
    double force[3], torque, friction[2], normal;
    uint32_t closed;
} totals;

static totals sum_of_contacts(const scene *s)
{
    totals sum = {{0.0, 0.0, 0.0}, 0.0, {0.0, 0.0}, 0.0, 0};
    for (uint32_t i = 0;; i++) {
        dmb_contact c = dmb_contact_default();
        if (dmb_query_contact(s->rig.sim, i, &c) < 0) break;
        if (!c.closed) {
            assert_true(c.friction[0] == 0.0 && c.friction[1] == 0.0);
            continue;
        }
        if (s->choice->kind == DMB_PIPE_FLEXIBLE) add_contact_force(s, &c, sum.force);
        for (int k = 0; k < 2; k++) sum.friction[k] += c.friction[k];
        sum.torque += 0.0365 * c.friction[1];
        sum.normal += c.normal_force;
        sum.closed++;
    }
    return sum;
}

/* [-] What the Stribeck law has beyond mu(s) r at speed v, r = v/s (eq:friction.peak), y = r exp(-s/v_s). */
static double raise_of(double v)
{
    const double eps = 1e-3, v_s = 2e-2, y = v / hypot(v, eps) * exp(-hypot(v, eps) / v_s);
    double most = 0.0;
    for (double x = eps; x < 10.0 * eps; x *= 1.00001) most = fmax(most, x / hypot(x, eps) * exp(-hypot(x, eps) / v_s));
    return pow(y / most, 4) * (0.05 * (1.0 - most) + MU * (1.0 - v / hypot(v, eps)));
}

/* Friction by the law at that slip over the normal force: mu(s) v/sqrt(v^2 + v_eps^2), in the Stribeck law raised to
 * the maximum mu_static; Ambrosio in full. */
static void check_law(const scene *s, const totals *sum)
{
    const double *slip = s->choice->slip, v[2] = {slip[0], 0.0365 * slip[1]};
    const double speed = hypot(v[0], v[1]);
    const int full = s->choice->law == DMB_FRICTION_AMBROSIO;
    const double smoothed = full ? speed : hypot(speed, 1e-3);
    const int falls = s->choice->law == DMB_FRICTION_STRIBECK || s->choice->law == DMB_FRICTION_BRISTLE;
    const double raised = s->choice->law == DMB_FRICTION_STRIBECK ? raise_of(speed) * smoothed / speed : 0.0;
    const double mu = MU + (falls ? 0.05 * exp(-smoothed / 2e-2) : 0.0) + raised;
    for (int k = 0; k < 2; k++)
        check_close("friction by its law", sum->friction[k], -mu * sum->normal * v[k] / smoothed, 1e-9 * sum->normal);
}

static void check_sum_query(const scene *s, const totals *sum)
{
    const dmb_contact_total told = contacts_of(&s->rig);
    assert_int_equal(told.closed, sum->closed);
    for (int k = 0; k < 2; k++) check_close("sum of friction", told.friction[k], sum->friction[k], 1e-9 * sum->normal);
}

/* Of the whole: the support's reaction and the drive's force, in the axes of the rig end, with all others. */
static void check_balance(const scene *s, const totals *sum)
{
    const double weight = PIPES * 1.5 * s1_values().weight, *end = s->choice->end;
    const dmb_pose start = pose_at(&s->rig, dmb_station(s->string, 0, 0.0));
    double reaction[6];
    must(&s->rig, dmb_query_reaction(s->rig.sim, s->string, reaction));
    check_relative("drive and reaction", drive_force(s), reaction[0], 1e-12);
    for (int i = 0; i < 3; i++) {
        double rest_of = sum->force[i] + end[i] - (i == 2 ? weight : 0.0);
        for (int j = 0; j < 3; j++) rest_of += start.rotation[3 * i + j] * reaction[j];
        check_below("force left over", fabs(rest_of), 1e-9 * weight);
    }
}

/* Along and about a straight axis; a bend of an axial-torsional string has its own test (capstan). */
static void check_path_balance(const scene *s, const totals *sum)
{
    const double weight = PIPES * 1.5 * s1_values().weight, I = s->choice->inclination, *end = s->choice->end;
    const double t[3] = {sin(I), 0.0, -cos(I)};
    double reaction[6];
    must(&s->rig, dmb_query_reaction(s->rig.sim, s->string, reaction));
    check_below("force left over",
                fabs(drive_force(s) + sum->friction[0] + end[0] * t[0] + end[2] * t[2] - weight * t[2]), 1e-9 * weight);
    check_below("torque left over", fabs(reaction[3] + sum->torque + end[3] * t[0] + end[5] * t[2]), 1e-9 * weight);
}

static void judge(const scene *s)
{
    const totals sum = sum_of_contacts(s);
    assert_true(sum.closed > PIPES / 2);
    check_law(s, &sum);
    check_sum_query(s, &sum);
    if (s->choice->kind == DMB_PIPE_FLEXIBLE)
        check_balance(s, &sum);
    else if (s->choice->bend == 0.0)
        check_path_balance(s, &sum);
}

/* Restored into a sim of its own it says the same. */
static void judge_restored(scene *s)
{
    size_t size = 0;
    dmb_sim *other = NULL;
    must(&s->rig, dmb_sim_snapshot_size(s->rig.sim, &size));
    void *snapshot = malloc(size);
    assert_non_null(snapshot);
    must(&s->rig, dmb_sim_snapshot(s->rig.sim, snapshot, size));
    must(&s->rig, dmb_sim_create(s->rig.model, NULL, &other));
    assert_int_equal(dmb_sim_restore(other, snapshot, size), DMB_OK);
    dmb_sim *first = s->rig.sim;
    s->rig.sim = other;
    judge(s);
    s->rig.sim = first;
    dmb_sim_destroy(&other);
    free(snapshot);
}

static void check_scene(const scene_choice *choice)
{
    scene s;
    open_scene(&s, choice);
    rest(&s);
    print_message("law %d, kind %d, inclination %.2f, bend %g, slip %g %g: drive %.6g N\n", choice->law, choice->kind,
                  choice->inclination, choice->bend, choice->slip[0], choice->slip[1], drive_force(&s));
    judge(&s);
    judge_restored(&s);
    must(&s.rig, dmb_sim_step(s.rig.sim, 1e-6, NULL));
    check_below("at rest friction goes with the slip", fabs(contacts_of(&s.rig).friction[0]),
                0.2 * contacts_of(&s.rig).normal_force);
    rig_close(&s.rig);
}

static void every_law_and_direction(void **state)
{
    static const int32_t laws[] = {DMB_FRICTION_COULOMB, DMB_FRICTION_AMBROSIO, DMB_FRICTION_STRIBECK,
                                   DMB_FRICTION_BRISTLE};
    static const int32_t kinds[] = {DMB_PIPE_FLEXIBLE, DMB_PIPE_AXIAL_TORSIONAL};
    static const double slips[][2] = {{0.05, 0.0}, {-0.05, 0.0}, {0.0, 3.0}, {0.03, -2.0}};
    static const double holes[][2] = {{0.5 * PI, 0.0}, {0.4 * PI, 0.0}, {0.5 * PI, 2e-3}, {0.4 * PI, -1e-3}};
    (void)state;
    for (uint32_t k = 0; k < 2; k++)
        for (uint32_t l = 0; l < 4; l++)
            for (uint32_t i = 0; i < 4; i++) {
                const double *hole = holes[(i + l) % 4];
                const scene_choice choice = {laws[l],
                                             kinds[k],
                                             hole[0],
                                             hole[1],
                                             {slips[i][0], slips[i][1]},
                                             {-3000.0, 0.0, 0.0, -20.0, 0.0, 0.0}};
                check_scene(&choice);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_law_and_direction)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
