/* How hard can a string be pushed in its hole before it buckles, what happens then, and when does it lock up?
 *
 * A string on the low side of a horizontal hole buckles sideways into a sine at 2 sqrt(EI w/r) (Dawson, Paslay 1984; w
 * weight per metre, r clearance), short ones later. It goes on carrying more, swinging up the wall, until it lets go of
 * it. Pushed harder it winds into a helix of pitch 2 pi sqrt(2 EI/F), which presses F^2 r/(4 EI) a metre on the wall:
 * friction on that takes up mu F^2 r/(4 EI) a metre, so that 1/F falls linearly towards the rig, and at the length 4
 * EI/(mu r F) from the bit no rig is strong enough: the string locks up. */
#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>

#include "command_line.h"

#define PI 3.14159265358979323846
#define PIPE 1.5         /* [m] */
#define CLEARANCE 0.0105 /* [m] of a pipe of 73 mm in a hole of 94 mm */
#define WALL 1e8         /* [N/m2] stiffness of the wall a metre */
#define BENDING 198411.2 /* [N m2] EI of a pipe of 73 by 55 mm */
#define WEIGHT 139.3513  /* [N/m] */
#define TICK 1e-6        /* [s] */

typedef struct string_model {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string, push;
    uint32_t pipes;
} string_model;

static int32_t failed(const string_model *s, int32_t status)
{
    (void)fprintf(stderr, "%s: %s %s\n", dmb_status_name(status), dmb_model_message(s->model), dmb_sim_message(s->sim));
    return status;
}

static dmb_pipe_def steel_pipe(double length, uint32_t elements)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.length = length;
    pipe.elements = elements;
    pipe.outer_diameter = 0.073;
    pipe.inner_diameter = 0.055;
    return pipe;
}

/* ---- On the low side --------------------------------------------------------------------------------------------- */

/* Clamped at the rig; at the bit guided along the hole and pushed back by 1 N times the factor of the analyses. */
static int32_t describe_lying(string_model *s, uint32_t pipes)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = steel_pipe(PIPE, 3);
    dmb_load_def push = dmb_load_def_default();
    const dmb_segment off = dmb_segment_default(); /* of height 0 */
    int32_t status = dmb_model_create(NULL, &s->model);
    s->sim = NULL;
    s->pipes = pipes;
    wall.friction_law = DMB_FRICTION_NONE;
    wall.stiffness = WALL;
    def.start_free = DMB_FREE_NONE;
    def.end_free = DMB_FREE_CYLINDRICAL;
    def.offset[1] = -(CLEARANCE + WEIGHT / WALL);
    push.force[0] = -1.0;
    if (status >= 0) status = dmb_model_add_wall(s->model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_string(s->model, &def, &pipe.string);
    if (status >= 0) status = dmb_model_add_pipes(s->model, &pipe, pipes, &s->string);
    if (status >= 0) status = dmb_model_add_time_function(s->model, &off, 1, &push.time_function);
    push.place = dmb_station(s->string, pipes - 1, 1.0);
    if (status >= 0) status = dmb_model_add_load(s->model, &push, &s->push);
    if (status >= 0) status = dmb_model_compile(s->model, NULL);
    if (status >= 0) status = dmb_sim_create(s->model, NULL, &s->sim);
    return status < 0 ? status : dmb_analysis_static(s->sim, NULL, NULL);
}

static int32_t critical_push(uint32_t pipes, double *push)
{
    string_model s;
    dmb_buckling *found = NULL;
    dmb_buckling_options options = dmb_buckling_options_default();
    int32_t status = describe_lying(&s, pipes);
    options.scale = DMB_SCALE_PART;
    options.part = s.push;
    if (status >= 0) status = dmb_analysis_buckling(s.sim, &options, &found);
    if (status >= 0) status = dmb_buckling_factor(found, 0, push);
    if (status < 0) (void)failed(&s, status);
    dmb_buckling_destroy(&found);
    dmb_sim_destroy(&s.sim);
    dmb_model_destroy(&s.model);
    return status;
}

/* Describes the last point of a path. */
typedef struct picture {
    const string_model *s;
    double swing, wall; /* [rad] largest angle up the wall, [N] */
} picture;

static int32_t look(void *context, const dmb_sim *at, const dmb_path_point *point)
{
    picture *p = context;
    dmb_contact_total contacts = dmb_contact_total_default();
    p->swing = 0.0;
    for (uint32_t i = 0; i < p->s->pipes; i++) {
        dmb_pose pose = dmb_pose_default();
        if (dmb_query_pose(at, dmb_station(p->s->string, i, 1.0), &pose) < 0) return 1;
        p->swing = fmax(p->swing, fabs(atan2(pose.position[1], -pose.position[2])));
    }
    if (dmb_query_contact_total(at, &contacts) < 0) return 1;
    p->wall = contacts.normal_force;
    return point->kind == DMB_PATH_LIMIT; /* it carries no more */
}

/* The branch that leaves the straight string where it buckles, up to a push. */
static int32_t after_buckling(const string_model *s, double push, picture *p, dmb_path_report *report)
{
    dmb_path_options options = dmb_path_options_default();
    options.scale = DMB_SCALE_PART;
    options.part = s->push;
    options.factor_end = push;
    options.branch = 1;
    options.branch_size = options.step_max = 5e-4; /* other branches are close by */
    options.callback = look;
    options.callback_context = p;
    p->s = s;
    const int32_t status = dmb_analysis_path(s->sim, &options, report);
    return status < 0 ? failed(s, status) : status;
}

static int32_t on_the_low_side(void)
{
    string_model s;
    dmb_path_report report = dmb_path_report_default();
    picture p;
    printf("length [m]   critical push [kN]\n");
    for (uint32_t pipes = 10; pipes <= 160; pipes *= 2) {
        double push;
        if (critical_push(pipes, &push) < 0) return 1;
        printf("%9.0f %20.4f\n", PIPE * pipes, push / 1e3);
    }
    printf("2 sqrt(EI w/r) %15.4f\n\n", 2.0 * sqrt(BENDING * WEIGHT / CLEARANCE) / 1e3);
    int32_t status = describe_lying(&s, 20);
    if (status < 0) (void)failed(&s, status);
    printf("30 m: push [kN]   swing up the wall [deg]   force on the wall [kN]\n");
    for (double push = 120e3; status >= 0 && push <= 180e3; push += 20e3) {
        status = after_buckling(&s, push, &p, &report);
        if (status >= 0) printf("%15.1f %25.4f %24.4f\n", report.factor / 1e3, p.swing * 180.0 / PI, p.wall / 1e3);
    }
    if (status >= 0) status = after_buckling(&s, 250e3, &p, &report);
    if (status >= 0) printf("it carries no more than %9.1f\n\n", report.first_limit / 1e3);
    dmb_sim_destroy(&s.sim);
    dmb_model_destroy(&s.model);
    return status < 0;
}

/* ---- As a helix -------------------------------------------------------------------------------------------------- */

/* A string without weight, its rig end beside the axis, wound up by loads that turn with a pitch of its own. The push
 * at the bit goes by a time function, another takes the winding loads off over one tick. */
typedef struct helix_case {
    uint32_t pipes;
    double pipe, clearance; /* [m] */
    double friction;
    double pitch, winding;      /* [m, N] of the loads that wind it up: not the pitch it takes */
    double from, to;            /* [N] push at the bit */
    double begins, ends, wound; /* ticks: ramp of the push, end of the winding loads */
} helix_case;

static dmb_segment step_of(double h0, double h1, double from, double to)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_STEP;
    term.h0 = h0;
    term.h1 = h1;
    term.x0 = from * TICK;
    term.x1 = to * TICK;
    return term;
}

static dmb_wall_def rough_wall(const helix_case *c)
{
    dmb_wall_def wall = dmb_wall_def_default();
    wall.diameter = 0.073 + 2.0 * c->clearance;
    wall.stiffness = WALL;
    wall.friction_law = DMB_FRICTION_COULOMB;
    wall.mu_static = wall.mu_dynamic = c->friction;
    wall.smoothing_speed = 1.0; /* the assumed slip turns friction up: mu slip/sqrt(slip^2 + 1) */
    return wall;
}

static int32_t add_push(string_model *s, const helix_case *c)
{
    const dmb_segment ramp = step_of(c->from, c->to, c->begins, c->ends),
                      off = step_of(1.0, 0.0, c->wound, c->wound + 1.0);
    dmb_load_def load = dmb_load_def_default();
    int32_t status = dmb_model_add_time_function(s->model, &ramp, 1, &load.time_function);
    load.frame = DMB_FRAME_HOLE;
    load.place = dmb_station(s->string, s->pipes - 1, 1.0);
    load.force[0] = -1.0;
    if (status >= 0) status = dmb_model_add_load(s->model, &load, NULL);
    if (status >= 0) status = dmb_model_add_time_function(s->model, &off, 1, &load.time_function);
    load.force[0] = 0.0;
    for (uint32_t i = 0; i < s->pipes && status >= 0; i++) {
        const double angle = 2.0 * PI * c->pipe * (i + 1) / c->pitch;
        load.place = dmb_station(s->string, i, 1.0);
        load.force[1] = c->winding * cos(angle);
        load.force[2] = c->winding * sin(angle);
        status = dmb_model_add_load(s->model, &load, NULL);
    }
    return status;
}

static int32_t describe_helix(string_model *s, const helix_case *c)
{
    dmb_environment_def nowhere = dmb_environment_def_default();
    const dmb_wall_def wall = rough_wall(c);
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = steel_pipe(c->pipe, 1);
    int32_t status = dmb_model_create(NULL, &s->model);
    s->sim = NULL;
    s->pipes = c->pipes;
    nowhere.gravity[2] = 0.0;
    def.start_free = DMB_FREE_NONE;
    def.offset[0] = c->clearance;
    if (status >= 0) status = dmb_model_set_environment(s->model, &nowhere);
    if (status >= 0) status = dmb_model_add_wall(s->model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_string(s->model, &def, &pipe.string);
    if (status >= 0) status = dmb_model_add_pipes(s->model, &pipe, s->pipes, &s->string);
    if (status >= 0) status = add_push(s, c);
    if (status >= 0) status = dmb_model_compile(s->model, NULL);
    return status < 0 ? status : dmb_sim_create(s->model, NULL, &s->sim);
}

static int32_t settle(const string_model *s, double slip)
{
    dmb_static_options options = dmb_static_options_default();
    options.lay_on_wall = 0;
    options.max_iterations = 200;
    options.slip_axial = slip;
    return dmb_analysis_static(s->sim, &options, NULL);
}

/* Static states from tick to tick, with a push that grows. */
static int32_t settle_for(const string_model *s, int ticks, double slip)
{
    int32_t status = settle(s, slip);
    for (int k = 0; k < ticks && status >= 0; k++) {
        status = dmb_sim_step(s->sim, TICK, NULL);
        if (status >= 0) status = settle(s, slip);
    }
    return status;
}

#define FRICTION 0.3
#define BIT_PUSH 2e5 /* [N] */

/* A push of the bit and what the rig has to push for it: where the string locks up is told by the two. */
static int32_t as_a_helix(void)
{
    const helix_case c = {133, 0.75, CLEARANCE, FRICTION, 8.0, 450.0, 0.2 * BIT_PUSH, BIT_PUSH, 0.0, 8.0, 8.0};
    const double slips[5] = {0.1, 0.2, 0.5, 1.0, 2.0}, length = 0.75 * 133;
    string_model s;
    int32_t status = describe_helix(&s, &c);
    if (status >= 0) status = settle_for(&s, 9, 0.0);
    if (status >= 0) printf("friction   rig force [kN]   closed form [kN]   locks up at [m]   closed form [m]\n");
    for (int k = 0; k < 5 && status >= 0; k++) {
        double reaction[6];
        const double mu = FRICTION * slips[k] / hypot(slips[k], 1.0), lost = mu * CLEARANCE / (4.0 * BENDING);
        status = settle(&s, slips[k]);
        if (status >= 0) status = dmb_query_reaction(s.sim, s.string, reaction);
        if (status >= 0)
            printf("%8.4f %16.3f %18.3f %17.1f %17.1f\n", mu, reaction[0] / 1e3,
                   1e-3 / (1.0 / BIT_PUSH - lost * length), length / (1.0 - BIT_PUSH / reaction[0]),
                   1.0 / (lost * BIT_PUSH));
    }
    if (status < 0) (void)failed(&s, status);
    dmb_sim_destroy(&s.sim);
    dmb_model_destroy(&s.model);
    return status < 0;
}

/* ---- Locked up --------------------------------------------------------------------------------------------------- */

#define WIDE 0.0635 /* [m] clearance of a washed-out hole */
#define ROUGH 0.5   /* friction in it */
#define SLIDING 1e3 /* [m/s] assumed slip that takes all of the friction */

/* 150 m in a wide and rough hole: the rig pushes more and more, and less and less of it arrives. Friction acts at the
 * surface of the pipe and turns the helix back a little, so that a thick pipe gets more through than the closed form
 * tells. */
static int32_t locked_up(void)
{
    const double length = 150.0, limit = 4.0 * BENDING / (ROUGH * WIDE * length);
    const helix_case c = {300, 0.5, WIDE, ROUGH, 16.0, 100.0, 0.3 * limit, 0.7 * limit, 1.0, 5.0, 0.0};
    string_model s;
    int32_t status = describe_helix(&s, &c);
    if (status >= 0) status = settle_for(&s, 1, SLIDING);
    if (status >= 0) printf("\n150 m: rig push [kN]   at the bit [kN]   bit gets no more than [kN]\n");
    for (int k = 0; k <= 4 && status >= 0; k++) {
        double reaction[6];
        dmb_section bit = dmb_section_default();
        dmb_contact last = dmb_contact_default(); /* the section before it bears its friction, the bit does not */
        if (k > 0) status = settle_for(&s, 1, SLIDING);
        if (status >= 0) status = dmb_query_reaction(s.sim, s.string, reaction);
        if (status >= 0) status = dmb_query_section(s.sim, dmb_station(s.string, s.pipes - 1, 1.0), &bit);
        if (status >= 0) status = dmb_query_contact(s.sim, s.pipes - 1, &last);
        const double arrives = -bit.force[0] + last.friction[0];
        if (status >= 0)
            printf("%22.1f %17.1f %27.1f\n", reaction[0] / 1e3, arrives / 1e3,
                   1e-3 / (1.0 / arrives - 1.0 / reaction[0]));
    }
    if (status >= 0) printf("4 EI/(mu r L), thin pipe %42.1f\n", limit / 1e3);
    if (status < 0) (void)failed(&s, status);
    dmb_sim_destroy(&s.sim);
    dmb_model_destroy(&s.model);
    return status < 0;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "How hard can a string be pushed in its hole before it buckles, what happens then, and "
                            "when does it lock up?",
                            NULL, 0);
    const int32_t first = on_the_low_side(), second = as_a_helix(), third = locked_up();
    return first || second || third;
}
