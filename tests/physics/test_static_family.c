/* Families of statics far from their start. A state that is reported as stable with status 0 has no negative eigenvalue
 * in dense matrices either and does not accelerate; where the search ends on an unstable state or cannot count, the
 * status says so. DMB_SEEDS=n draws more. */
#include <stdlib.h>

#include "dense_signs.h"

#define PART 1e-14 /* [-] of the norm, eigenvalues that count as 0 */

/* [m/s2, rad/s2] largest of the state. */
static double acceleration_of(const rig *s)
{
    uint64_t count = 0;
    double most = 0.0;
    must(s, dmb_analysis_array(s->sim, DMB_ARRAY_ACCELERATION, NULL, &count));
    double *values = malloc(count * sizeof *values);
    must(s, dmb_analysis_array(s->sim, DMB_ARRAY_ACCELERATION, values, &count));
    for (uint64_t i = 0; i < count; i++) most = fmax(most, fabs(values[i]));
    free(values);
    return most;
}

/* ---- Slack strings ----------------------------------------------------------------------------------------------- */

static const double length = 200.0; /* [m] */

typedef struct slack {
    double share, inclination; /* [-] of the length, [rad] of the line between the ends */
    uint32_t pipes, elements;
    int32_t start_free, end; /* mask, kind of the joint at the far end */
} slack;

/* The middle of a chain of the length between two points, from the first of them, x and z [m]: half its length lies
 * before it. a cosh: sqrt(L^2 - h^2) = 2 a sinh(s/2a), tanh(m/a) = h/L. */
static void middle_of_chain(double span, double rise, double middle[2])
{
    const double ratio = sqrt(length * length - rise * rise) / span;
    double low = 1e-6, high = 30.0;
    for (int k = 0; k < 200; k++) {
        const double x = 0.5 * (low + high);
        if (sinh(x) / x < ratio)
            low = x;
        else
            high = x;
    }
    const double a = 0.5 * span / low, first = a * atanh(rise / length) - 0.5 * span;
    const double x = a * asinh(sinh(first / a) + 0.5 * length / a);
    middle[0] = x - first;
    middle[1] = a * (cosh(x / a) - cosh(first / a));
}

static void open_slack(const slack *c, rig *s, dmb_id *string)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    const double along[3] = {cos(c->inclination), 0.0, sin(c->inclination)};
    rig_open(s, 0.0, 0.0, -9.81);
    def.follows_hole = 0, def.start_free = c->start_free, def.rotation[1] = -c->inclination;
    pipe.string = *string = add_string(s, &def);
    pipe.length = length / c->pipes, pipe.elements = c->elements;
    (void)add_pipes(s, &pipe, c->pipes);
    dmb_joint_def end = joint_between(c->end, (dmb_place){0}, dmb_station(*string, c->pipes - 1, 1.0));
    for (int i = 0; i < 3; i++) {
        end.origin_a[i] = c->share * length * along[i];
        end.axis_a[i] = c->end == DMB_JOINT_FIXED ? along[i] : i == 1;
        end.normal_a[i] = c->end == DMB_JOINT_FIXED ? i == 1 : i == 0;
        end.axis_b[i] = c->end == DMB_JOINT_FIXED ? i == 0 : i == 1;
        end.normal_b[i] = c->end == DMB_JOINT_FIXED ? i == 1 : i == 0;
    }
    (void)add_joint(s, &end);
    options.assembly_energy = 1e12; /* described longer than the way between its ends, and pressed together */
    (void)rig_start(s, &options);
}

/* Bending within (EI/w)^(1/3) = 11 m of a clamp, and where a slack string turns back, takes it off the chain by so
 * much. */
static void check_slack(const slack *c)
{
    rig s;
    dmb_id string;
    double chain[2];
    dmb_static_report report = dmb_static_report_default();
    open_slack(c, &s, &string);
    const int32_t status = dmb_analysis_static(s.sim, NULL, &report);
    must(&s, status);
    middle_of_chain(c->share * length * cos(c->inclination), c->share * length * sin(c->inclination), chain);
    const dmb_place place =
        c->pipes % 2 ? dmb_station(string, c->pipes / 2, 0.5) : dmb_station(string, c->pipes / 2 - 1, 1.0);
    const dmb_pose middle = pose_at(&s, place);
    const double off = hypot(hypot(middle.position[0] - chain[0], middle.position[2] - chain[1]), middle.position[1]);
    const dense_signs dense = dense_signs_of(&s, PART);
    const double acceleration = acceleration_of(&s), most = c->start_free == DMB_FREE_NONE ? 5.2 : 2.1;
    if (status != DMB_OK || report.negative != 0 || dense.negative != 0 || !(off < most) || !(acceleration < 1e-4))
        fail_msg(
            "share %g, %g rad, %u pipes, %u elements, start %d, end %d: status %d, %d negative, dense %d, %g m off, "
            "%g m/s2",
            c->share, c->inclination, c->pipes, c->elements, c->start_free, c->end, status, report.negative,
            dense.negative, off, acceleration);
    rig_close(&s);
}

/* 72 scenes: shares, inclinations, meshes, supports. */
static void slack_strings_hang(void **state)
{
    static const double shares[] = {0.8, 0.95, 0.99}, inclinations[] = {0.0, 0.5, 1.2};
    static const int32_t supports[][2] = {{DMB_FREE_RY, DMB_JOINT_REVOLUTE},
                                          {DMB_FREE_SPHERICAL, DMB_JOINT_SPHERICAL},
                                          {DMB_FREE_NONE, DMB_JOINT_REVOLUTE},
                                          {DMB_FREE_NONE, DMB_JOINT_FIXED}};
    static const uint32_t meshes[][2] = {{10, 2}, {25, 1}};
    (void)state;
    for (int i = 0; i < 72; i++) {
        const slack c = {.share = shares[i % 3],
                         .inclination = inclinations[i / 3 % 3],
                         .pipes = meshes[i / 9 % 2][0],
                         .elements = meshes[i / 9 % 2][1],
                         .start_free = supports[i / 18][0],
                         .end = supports[i / 18][1]};
        check_slack(&c);
    }
}

/* ---- Bent strings with rings and a body beside its joint --------------------------------------------------------- */

static uint32_t draw_whole(uint64_t *seed, uint32_t count)
{
    return (uint32_t)draw_between(seed, 0.0, 0.999999 * count);
}

typedef struct bent {
    dmb_id string;
    int hole;
    int32_t start_free, joint;
    uint32_t pipes, elements;
} bent;

static bent draw_bent(uint64_t *seed, rig *s)
{
    static const double directions[][3] = {{0, 0, -9.81}, {0, 0, -9.81}, {0, -9.81, 0}, {-9.81, 0, 0}};
    static const int32_t kinds[] = {DMB_JOINT_REVOLUTE, DMB_JOINT_SPHERICAL, DMB_JOINT_UNIVERSAL, DMB_JOINT_CYLINDRICAL,
                                    DMB_JOINT_FIXED};
    static const int32_t masks[] = {DMB_FREE_NONE, DMB_FREE_RX, DMB_FREE_RY, DMB_FREE_SPHERICAL};
    static const uint32_t pipes[] = {1, 2, 4, 10}, elements[] = {1, 2, 4};
    const double *g = directions[draw_whole(seed, 4)];
    bent b = {.hole = (int)draw_whole(seed, 2), .pipes = pipes[draw_whole(seed, 4)]};
    b.elements = elements[draw_whole(seed, 3)];
    b.start_free = masks[draw_whole(seed, b.hole ? 2 : 4)];
    b.joint = kinds[draw_whole(seed, 5)];
    rig_open(s, g[0], g[1], g[2]);
    return b;
}

static void add_bent_string(uint64_t *seed, rig *s, bent *b)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    const double bend = b->hole ? 0.02 : 0.3;
    wall.diameter = draw_whole(seed, 2) ? 0.094 : 0.2;
    if (b->hole) (void)add_wall(s, &wall);
    def.follows_hole = b->hole, def.start_free = b->start_free;
    pipe.string = b->string = add_string(s, &def);
    pipe.length = draw_whole(seed, 2) ? 1.0 : 3.0, pipe.elements = b->elements;
    for (int i = 1; i < 3; i++) pipe.curvature[i] = draw_between(seed, -bend, bend);
    (void)add_pipes(s, &pipe, b->pipes);
    ring.string = b->string, ring.pipe = draw_whole(seed, b->pipes), ring.outer_diameter = 0.09;
    ring.mass = draw_whole(seed, 2) ? 20.0 : 0.0;
    must_model(s, dmb_model_add_stabiliser(s->model, &ring, NULL));
}

static void add_hanging_body(uint64_t *seed, rig *s, const bent *b)
{
    dmb_body_def body = dmb_body_def_default();
    const double arm = draw_whole(seed, 2) ? 1.0 : 0.05;
    const uint32_t axis = draw_whole(seed, 3);
    body.mass = draw_whole(seed, 2) ? 50.0 : 1.0;
    for (int i = 0; i < 3; i++) {
        body.inertia[i] = 1.0;
        body.centre[i] = draw_between(seed, -arm, arm);
    }
    const dmb_place end = dmb_station(b->string, b->pipes - 1, 1.0), at = dmb_station(add_body(s, &body), 0, 0.0);
    dmb_joint_def joint = joint_between(b->joint, end, at);
    for (uint32_t i = 0; i < 3 && b->joint == DMB_JOINT_REVOLUTE; i++) {
        joint.axis_a[i] = joint.axis_b[i] = i == axis;
        joint.normal_a[i] = joint.normal_b[i] = i == (axis + 1) % 3;
    }
    if (b->joint == DMB_JOINT_CYLINDRICAL) joint.stiffness[DMB_X] = 1e4;
    (void)add_joint(s, &joint);
}

/* Equilibria beside which a part stands on its head are reported as unstable where the search began there; eigenvalues
 * of rounding size are spins about the vertical, or turns of a round part. */
static void check_bent(const rig *s, const bent *b, uint64_t number, int32_t counts[3])
{
    dmb_static_report report = dmb_static_report_default();
    const int32_t status = dmb_analysis_static(s->sim, NULL, &report);
    if (status == DMB_ERR_GEOMETRY && b->joint == DMB_JOINT_UNIVERSAL) return; /* it rests at the right angle */
    if (status < 0) fail_msg("string %u: %s", (unsigned)number, dmb_sim_message(s->sim));
    const dense_signs dense = dense_signs_of(s, PART);
    const double acceleration = acceleration_of(s);
    const int fits = status == DMB_OK ? report.negative == 0 && dense.negative == 0
                     : status == DMB_NOTE_UNSTABLE
                         ? report.negative == dense.negative && report.method == DMB_STATIC_NEWTON
                         : status == DMB_NOTE_INCOMPLETE && dense.between > 0;
    if (!fits || !(acceleration < 1e-3))
        fail_msg(
            "string %u: status %d, method %d, %d negative, %d unresolved; dense %d negative, %d within %g; %g m/s2",
            (unsigned)number, status, report.method, report.negative, report.unresolved, dense.negative, dense.between,
            dense.bound, acceleration);
    counts[status == DMB_OK ? 0 : status == DMB_NOTE_UNSTABLE ? 1 : 2]++;
}

static void bent_strings_with_bodies_rest(void **state)
{
    const char *more = getenv("DMB_SEEDS");
    const uint64_t seeds = more != NULL ? strtoull(more, NULL, 10) : 150;
    int32_t counts[3] = {0, 0, 0};
    (void)state;
    for (uint64_t k = 1; k <= seeds; k++) {
        uint64_t seed = 7919 * k;
        rig s;
        bent b = draw_bent(&seed, &s);
        add_bent_string(&seed, &s, &b);
        add_hanging_body(&seed, &s, &b);
        (void)rig_start(&s, NULL);
        check_bent(&s, &b, k, counts);
        rig_close(&s);
    }
    print_message("  %d stable, %d start beside an unstable state, %d with a free spin\n", counts[0], counts[1],
                  counts[2]);
    assert_true(counts[0] > 0.6 * (double)seeds && counts[1] < 0.1 * (double)seeds);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slack_strings_hang),
        cmocka_unit_test(bent_strings_with_bodies_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
