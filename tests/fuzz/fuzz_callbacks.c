/* Constraints and forces of the caller out of bytes: functions that give polynomials of the poses with any
 * coefficients, jump, are not what their Jacobian says, or fail at any call. Creation and steps end with a known
 * status; a call that fails changes nothing; the state that is left can be saved and restored and has finite numbers.
 */
#include "fuzz_frame.h"

enum { ROWS = 3, PLACES = 2, BODIES = 3, STEPS = 4 };

/* value_i = offset_i + sum_k a_ik q_k + b_ik q_k^2 over a few numbers q of the poses, a jump at a call. */
typedef struct function {
    double offset[ROWS], a[ROWS][6], b[ROWS][6], wrong, jump;
    uint32_t rows, places, calls, fails_at, jumps_at;
} function;

typedef struct subject {
    byte_source source;
    uint32_t more; /* 1: forces have axes, offsets, steps, tangents and potentials, 2: and act on a joint */
    function constraint, force;
    dmb_model *model;
    dmb_id body[BODIES], joint;
} subject;

static double coefficient(byte_source *s)
{
    if (draw_chance(s, 5)) return draw_nonsense(s);
    return draw_chance(s, 128) ? 0.0 : draw_number(s, -2.0, 2.0);
}

static void draw_function(byte_source *s, function *f)
{
    f->rows = 1 + draw_below(s, ROWS);
    f->places = 1 + draw_below(s, PLACES);
    for (uint32_t i = 0; i < ROWS; i++)
        for (uint32_t k = 0; k < 6; k++) {
            f->a[i][k] = coefficient(s);
            f->b[i][k] = coefficient(s);
        }
    f->wrong = draw_chance(s, 30) ? coefficient(s) : 0.0;
    f->jump = draw_chance(s, 60) ? coefficient(s) : 0.0;
    f->jumps_at = draw_byte(s);
    f->fails_at = draw_chance(s, 40) ? 1 + draw_byte(s) : 0;
}

static double evaluate(const function *f, uint32_t row, const double (*poses)[12])
{
    double value = f->offset[row] + (f->calls > f->jumps_at ? f->jump : 0.0);
    for (uint32_t k = 0; k < 6; k++) {
        const double q = poses[k / 3 % f->places][k % 3];
        value += q * (f->a[row][k] + f->b[row][k] * q);
    }
    return value;
}

/* World positions by body-frame displacements: the columns of the rotation matrix. */
static void differentiate(const function *f, uint32_t row, const double (*poses)[12], double *jacobian)
{
    memset(jacobian, 0, 6 * f->places * sizeof *jacobian);
    for (uint32_t k = 0; k < 6; k++) {
        const uint32_t place = k / 3 % f->places, i = k % 3;
        const double slope = f->a[row][k] + 2.0 * f->b[row][k] * poses[place][i] + f->wrong;
        for (uint32_t j = 0; j < 3; j++) jacobian[6 * place + j] += slope * poses[place][3 + 3 * i + j];
    }
}

static int32_t constrain(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                         double *jacobian)
{
    function *f = context;
    (void)time, (void)count;
    if (++f->calls == f->fails_at) return 1;
    for (uint32_t i = 0; i < f->rows; i++) {
        value[i] = evaluate(f, i, poses);
        if (jacobian != NULL) differentiate(f, i, poses, jacobian + 6 * (size_t)f->places * i);
    }
    return 0;
}

/* In the axes of the world: positions and velocities alone count. */
static void differentiate_force(const function *f, uint32_t count, const double (*poses)[12], double *tangent)
{
    const size_t width = 6 * (size_t)count;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t row = 0; row < ROWS; row++) {
            double *by_pose = tangent + width * (6 * i + row), *by_speed = by_pose + width * width;
            for (uint32_t k = 0; k < 6; k++) {
                const uint32_t place = k / 3 % f->places;
                if (place < count)
                    by_pose[6 * place + k % 3] += f->a[row][k] + 2.0 * f->b[row][k] * poses[place][k % 3] + f->wrong;
            }
            by_speed[6 * i + row] -= 0.1 * f->a[row][0];
        }
}

static int32_t push(void *context, double time, uint32_t count, const double (*poses)[12],
                    const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                    const dmb_law_memory *memory)
{
    (void)memory;
    function *f = context;
    (void)time;
    if (++f->calls == f->fails_at) return 1;
    if (tangent != NULL) differentiate_force(f, count, poses, tangent);
    if (potential != NULL) *potential = evaluate(f, 0, poses);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < ROWS; k++) forces[i][k] = evaluate(f, k, poses) - 0.1 * f->a[k][0] * velocities[i][k];
    return 0;
}

/* Values are 0 where the bodies are described, most of the time. */
static void add_constraint(subject *c)
{
    byte_source *s = &c->source;
    function *f = &c->constraint;
    dmb_constraint_def def = dmb_constraint_def_default();
    draw_function(s, f);
    double poses[PLACES][12] = {{0.0}, {0.0}};
    poses[1][1] = 1.0;
    for (uint32_t i = 0; i < ROWS && !draw_chance(s, 20); i++)
        f->offset[i] = -evaluate(f, i, (const double(*)[12])poses);
    def.kind = draw_chance(s, 40) ? DMB_CONSTRAINT_NONHOLONOMIC : DMB_CONSTRAINT_HOLONOMIC;
    def.row_count = f->rows;
    def.place_count = f->places;
    for (uint32_t i = 0; i < f->places; i++) def.place[i] = dmb_station(c->body[i], 0, 0.0);
    def.provides = draw_chance(s, 128) ? DMB_PROVIDES_JACOBIAN : 0;
    def.callback = constrain;
    def.callback_context = f;
    known(dmb_model_add_constraint(c->model, &def, NULL));
}

static void draw_more_force(subject *c, dmb_force_def *def)
{
    byte_source *s = &c->source;
    def->frame = (int32_t)draw_below(s, 2);
    def->provides = (int32_t)draw_below(s, 5); /* one too many */
    def->offset[draw_below(s, 6)] = draw_number(s, -1.0, 1.0);
    def->pose_step = draw_size(s, 1e-9, 1e-2);
    def->speed_step = draw_size(s, 1e-9, 1e-2);
    draw_spoil(s, &def->pose_step, 2);
    if ((c->more & 2) == 0 || c->joint.generation == 0) return;
    def->place[0] = dmb_station(c->joint, 0, 0.0);
    def->component[0] = (int32_t)draw_below(s, 6);
}

static void add_force(subject *c)
{
    dmb_force_def def = dmb_force_def_default();
    draw_function(&c->source, &c->force);
    def.place_count = c->force.places;
    for (uint32_t i = 0; i < def.place_count; i++) def.place[i] = dmb_station(c->body[BODIES - 1 - i], 0, 0.0);
    if (c->more & 1) draw_more_force(c, &def);
    def.callback = push;
    def.callback_context = &c->force;
    known(dmb_model_add_force(c->model, &def, NULL));
}

static int describe(subject *c)
{
    byte_source *s = &c->source;
    for (uint32_t i = 0; i < BODIES; i++) {
        dmb_body_def body = dmb_body_def_default();
        body.position[1] = i;
        body.velocity[draw_below(s, 6)] = draw_number(s, -1.0, 1.0);
        MUST(dmb_model_add_body(c->model, &body, &c->body[i]) == DMB_OK);
    }
    if (draw_chance(s, 128)) {
        dmb_joint_def joint = dmb_joint_def_default();
        joint.kind = (int32_t)draw_below(s, 6);
        joint.place_a = dmb_station(c->body[1], 0, 0.0);
        joint.place_b = dmb_station(c->body[2], 0, 0.0);
        joint.match = 1;
        MUST(dmb_model_add_joint(c->model, &joint, &c->joint) == DMB_OK);
    }
    if (!draw_chance(s, 60)) add_constraint(c);
    if (draw_chance(s, 128)) add_force(c);
    const int32_t status = dmb_model_compile(c->model, NULL);
    known(status);
    return status >= 0;
}

static void check_state(const subject *c, dmb_sim *sim)
{
    for (uint32_t i = 0; i < BODIES; i++) {
        dmb_motion motion = dmb_motion_default();
        MUST(dmb_query_motion(sim, dmb_station(c->body[i], 0, 0.0), &motion) == DMB_OK);
        for (int k = 0; k < 3; k++) MUST(isfinite(motion.velocity[k]));
    }
    check_restore(sim);
}

static void run(subject *c)
{
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *sim = NULL;
    options.max_cuts = 2;
    options.max_steps = 5;
    const int32_t made = dmb_sim_create(c->model, &options, &sim);
    known(made);
    if (made < 0) return;
    for (int i = 0; i < STEPS; i++) {
        const uint64_t before = hash_of(sim);
        const int32_t status = dmb_sim_step(sim, draw_size(&c->source, 1e-5, 0.1), NULL);
        known(status);
        MUST(status >= 0 || hash_of(sim) == before);
        check_state(c, sim);
    }
    dmb_check_report report = dmb_check_report_default();
    known(dmb_analysis_check(sim, &report));
    dmb_sim_destroy(&sim);
}

FUZZ_ENTRY(subject, describe, run)
