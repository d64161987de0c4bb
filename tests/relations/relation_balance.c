/* Newton's second law of the whole: the support's reaction against weight, loads and contacts at rest, and the impulse
 * of all of them against the momentum of a run. The energy ledger against one's own sum of force times speed, and work
 * against energy plus dissipation. */
#include "relations.h"

enum { TOPIC_BALANCE = TOPIC_OF_RELATION + 60 };

/* ---- Forces on the whole ---------------------------------------------------------------------------------------- */

typedef struct forces {
    double sum[3], size; /* [N] resultant and sum of the sizes */
    double moment[3];    /* [N m] about the world's origin, contacts left out */
} forces;

static void add_force(forces *f, const double force[3], const double at[3])
{
    for (int i = 0; i < 3; ++i) f->sum[i] += force[i];
    f->moment[0] += at[1] * force[2] - at[2] * force[1];
    f->moment[1] += at[2] * force[0] - at[0] * force[2];
    f->moment[2] += at[0] * force[1] - at[1] * force[0];
    f->size += sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
}

static void add_reaction(const built *b, forces *f)
{
    double reaction[6], force[3], moment[3];
    dmb_pose pose = dmb_pose_default();
    (void)dmb_query_pose(b->sim, dmb_station(b->string[0], 0, 0.0), &pose);
    (void)dmb_query_reaction(b->sim, b->string[0], reaction);
    matrix_apply(pose.rotation, reaction, force);
    matrix_apply(pose.rotation, reaction + 3, moment);
    add_force(f, force, pose.position);
    for (int i = 0; i < 3; ++i) f->moment[i] += moment[i];
}

/* part: the time function's value. */
static void add_load(const scene *s, const built *b, double part, forces *f)
{
    double force[3], moment[3];
    dmb_pose pose = dmb_pose_default();
    if (s->loads == 0) return;
    const dmb_load_def *const l = &s->load[0].def;
    const scene_view straight = view_identity();
    (void)dmb_query_pose(b->sim, built_place(b, s->load[0].place), &pose);
    const double *const axes = l->frame == DMB_FRAME_BODY ? pose.rotation : straight.matrix;
    matrix_apply(axes, l->force, force);
    matrix_apply(axes, l->moment, moment);
    for (int i = 0; i < 3; ++i) force[i] *= part;
    add_force(f, force, pose.position);
    for (int i = 0; i < 3; ++i) f->moment[i] += part * moment[i];
}

static void add_weight(const scene *s, const built *b, forces *f)
{
    dmb_momentum m = dmb_momentum_default();
    double weight[3];
    (void)dmb_query_momentum(b->sim, &m);
    for (int i = 0; i < 3; ++i) weight[i] = m.mass * s->environment.gravity[i];
    add_force(f, weight, m.centre);
}

/* Friction acts along the hole's axis t and along t x normal. */
static void add_contacts(const scene *s, const built *b, forces *f)
{
    const double origin[3] = {0.0, 0.0, 0.0}, *const t = s->wall.direction; /* a unit vector */
    dmb_model_info info = dmb_model_info_default();
    (void)dmb_model_get_info(b->model, &info);
    for (uint32_t i = 0; i < info.contact_points; ++i) {
        dmb_contact c = dmb_contact_default();
        double force[3];
        (void)dmb_query_contact(b->sim, i, &c);
        const double *const n = c.normal;
        const double across[3] = {t[1] * n[2] - t[2] * n[1], t[2] * n[0] - t[0] * n[2], t[0] * n[1] - t[1] * n[0]};
        for (int k = 0; k < 3; ++k)
            force[k] = -c.normal_force * n[k] + c.friction[0] * t[k] + c.friction[1] * across[k];
        add_force(f, force, origin);
    }
}

static forces forces_on(const scene *s, const built *b, double part)
{
    forces f = {{0.0}, 0.0, {0.0}};
    add_reaction(b, &f);
    add_load(s, b, part, &f);
    add_weight(s, b, &f);
    if (s->has_wall) add_contacts(s, b, &f);
    return f;
}

static double norm(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void no_fluid(scene *s)
{
    s->environment.fluid_density = s->environment.lateral_damping = s->environment.axial_damping =
        s->environment.torsional_damping = 0.0;
}

/* ---- At rest ---------------------------------------------------------------------------------------------------- */

/* In straight holes half of the strings are held as if they slid and turned; the frames of friction in a bent one are
 * not asked for. */
static dmb_static_options slipping(const scene *s)
{
    stream n = stream_of(s->seed, s->number, TOPIC_BALANCE + 1);
    dmb_static_options options = dmb_static_options_default();
    if (s->family != FAMILY_HOLE || draw_chance(&n, 0.5)) return options;
    options.slip_axial = draw_number(&n, -0.1, 0.1);
    options.slip_rotation = draw_number(&n, -10.0, 10.0);
    return options;
}

static void check_weight(trial *t)
{
    built b;
    double floor[ANSWER_GROUPS];
    const dmb_static_options options = slipping(&t->s);
    no_fluid(&t->s);
    if (t->s.string[0].pipe[0].kind == DMB_PIPE_AXIAL_TORSIONAL) {
        left_out(t, "pipes that the hole holds without a contact to ask about");
        return;
    }
    int32_t status = scene_open(&t->s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, &options, NULL);
    if (status < 0) {
        refused(t, status, b.sim ? dmb_sim_message(b.sim) : b.message);
    } else {
        const forces f = forces_on(&t->s, &b, 1.0);
        rounding_of(&t->s, t->s.span + 10.0, 1.0, floor);
        /* the residual of each node is 1e-10 of what balances in it, at most the largest section force */
        const double tolerance = 1e-8 * f.size + 1000.0 * floor[ANSWER_FORCE];
        hold(t, "sum of all forces at rest", norm(f.sum), tolerance);
        if (!t->s.has_wall)
            hold(t, "sum of all moments at rest", norm(f.moment), 10.0 * tolerance * (t->s.span + 10.0));
    }
    scene_close(&b);
}

/* ---- In motion -------------------------------------------------------------------------------------------------- */

/* Sums of a run from rest on, by trapezoids. */
typedef struct sums {
    double impulse[3], momentum[3], scale;
    double load_work, drive_work; /* [J] own sums */
    dmb_energy energy;            /* now less that of the start */
} sums;

static double load_power(const scene *s, const built *b, double part)
{
    dmb_motion motion = dmb_motion_default();
    forces f = {{0.0}, 0.0, {0.0}};
    double power = 0.0;
    dmb_pose pose = dmb_pose_default();
    if (s->loads == 0) return power;
    const dmb_place place = built_place(b, s->load[0].place);
    (void)dmb_query_motion(b->sim, place, &motion);
    (void)dmb_query_pose(b->sim, place, &pose);
    add_load(s, b, part, &f);
    double at[3] = {-pose.position[0], -pose.position[1], -pose.position[2]};
    forces about = f;
    add_force(&about, f.sum, at); /* the moment about the place itself */
    for (int i = 0; i < 3; ++i) power += f.sum[i] * motion.velocity[i] + about.moment[i] * motion.velocity[3 + i];
    return power;
}

static double drive_power(const scene *s, const built *b)
{
    double power = 0.0;
    for (uint32_t i = 0; i < s->drives; ++i) {
        dmb_drive_state d = dmb_drive_state_default();
        (void)dmb_query_drive(b->sim, b->drive[i], &d);
        power += d.force * d.speed;
    }
    return power;
}

/* STEP5 from 1 to 1.5 between the times 0 and `time`, as time_function_step gives it. */
static double part_at(double now, double time)
{
    const double d = fmin(1.0, fmax(0.0, now / time));
    return 1.0 + 0.5 * d * d * d * (10.0 - 15.0 * d + 6.0 * d * d);
}

static int32_t sum_run(const scene *s, double step, uint32_t steps, double growing, built *b, sums *out)
{
    dmb_momentum before = dmb_momentum_default(), after = dmb_momentum_default();
    memset(out, 0, sizeof *out);
    int32_t status = scene_open(s, 0, NULL, b);
    if (status >= 0) status = dmb_analysis_static(b->sim, NULL, NULL);
    if (status < 0) return built_fail(b, status);
    (void)dmb_query_momentum(b->sim, &before);
    for (uint32_t i = 0; i <= steps; ++i) {
        const double weight = (i == 0 || i == steps ? 0.5 : 1.0) * step, part = part_at(dmb_sim_time(b->sim), growing);
        const forces f = forces_on(s, b, part);
        for (int k = 0; k < 3; ++k) out->impulse[k] += weight * f.sum[k];
        out->scale += weight * f.size;
        out->load_work += weight * load_power(s, b, part);
        out->drive_work += weight * drive_power(s, b);
        if (i < steps) status = run_steps(b, step, 1, NULL);
        if (status < 0) return status;
    }
    (void)dmb_query_momentum(b->sim, &after);
    for (int k = 0; k < 3; ++k) out->momentum[k] = after.linear[k] - before.linear[k];
    out->energy = dmb_energy_default();
    return dmb_query_energy(b->sim, &out->energy);
}

static double distance_of(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return norm(d);
}

/* Loads and the turning of the rig grow smoothly from rest, slowly against the steps. */
static double prepare_run(trial *t, double growing)
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_BALANCE);
    no_fluid(&t->s);
    if (t->s.loads > 0) t->s.load[0].time_function = time_function_step(1.0, 0.5, 0.0, growing);
    for (uint32_t i = 0; i < t->s.drives; ++i)
        t->s.drive[i].time_function = time_function_step(
            0.0, draw_number(&n, -1.0, 1.0) * (t->s.drive[i].def.component == DMB_X ? 0.05 : 5.0), 0.0, growing);
    return growing;
}

static int32_t two_runs(trial *t, double time, uint32_t count, sums *coarse, sums *fine)
{
    built b;
    const double growing = prepare_run(t, 0.75 * time), step = time / count;
    int32_t status = sum_run(&t->s, step, count, growing, &b, coarse);
    if (status < 0) refused(t, status, b.message);
    scene_close(&b);
    if (status < 0) return status;
    status = sum_run(&t->s, 0.5 * step, 2 * count, growing, &b, fine);
    if (status < 0) refused(t, status, b.message);
    scene_close(&b);
    return status;
}

/* A figure of two runs, and the limit of what it may be. Both relations are tried with shorter steps where
 * those of the scene do not resolve its motion yet. */
typedef int fall_fn(trial *t, const sums *coarse, const sums *fine, int last);

static void hold_falling(trial *t, fall_fn *fall)
{
    enum { LEVELS = 4 };
    sums coarse, fine;
    for (int level = 0; level < LEVELS && t->verdict == VERDICT_HELD; ++level) {
        if (two_runs(t, 80.0 * t->s.step, 80U << level, &coarse, &fine) < 0) break;
        if (fall(t, &coarse, &fine, level == LEVELS - 1)) break;
    }
}

/* 1 if a quarter is left at half the step, 0.35 at most; said where it is the last chance. */
static int falls(trial *t, const char *what, double coarse, double fine, double floor, int last)
{
    const int good = fabs(fine) <= 0.35 * fabs(coarse) + floor;
    if (good || last) hold(t, what, fabs(fine), 0.35 * fabs(coarse) + floor);
    return good;
}

static int impulse_falls(trial *t, const sums *coarse, const sums *fine, int last)
{
    return falls(t, "impulse less momentum at half the step", distance_of(coarse->impulse, coarse->momentum),
                 distance_of(fine->impulse, fine->momentum), 1e-8 * coarse->scale, last);
}

static void check_impulse(trial *t)
{
    hold_falling(t, impulse_falls);
}

static double stored(const dmb_energy *e)
{
    return e->kinetic + e->strain + e->gravity + e->contact;
}

static int work_falls(trial *t, const sums *coarse, const sums *fine, int last)
{
    const dmb_energy *const c = &coarse->energy, *const e = &fine->energy;
    const double floor = 1e-7 * e->input + 1e-12 * fabs(stored(e));
    hold(t, "work that is not explained", fabs(e->unexplained), 1e-6 * e->input + 1e-12 * fabs(stored(e)));
    hold(t, "balance of the ledger", fabs(e->balance - e->scheme - e->unexplained), 1e-9 * e->input);
    return falls(t, "work of loads at half the step", coarse->load_work - c->loads, fine->load_work - e->loads, floor,
                 last) &&
           falls(t, "work of drives at half the step", coarse->drive_work - c->drives, fine->drive_work - e->drives,
                 floor, last) &&
           falls(t, "energy taken by the scheme at half the step", c->scheme, e->scheme, floor, last);
}

static void check_work(trial *t)
{
    hold_falling(t, work_falls);
}

const relation relation_weight = {
    "weight",
    "reaction, weight, loads and contacts at rest against zero",
    {FAMILY_LINE | FAMILY_HOLE | FAMILY_BENT, WISH_STILL | WISH_ELASTIC | WISH_NO_CONTROL | WISH_NO_BIT, 4},
    40,
    0.5,
    check_weight,
    0.0};
const relation relation_impulse = {"impulse",
                                   "the impulse of all forces against the momentum, second order in the step",
                                   {FAMILY_LINE, WISH_STILL | WISH_ELASTIC | WISH_NO_CONTROL, 3},
                                   20,
                                   0.5,
                                   check_impulse,
                                   0.0};
const relation relation_work = {"work",
                                "the ledger against force times speed, work against energy plus dissipation",
                                {FAMILY_LINE, WISH_STILL | WISH_ELASTIC | WISH_NO_CONTROL, 3},
                                20,
                                0.5,
                                check_work,
                                0.0};
