#include "relations.h"

/* ---- Verdicts --------------------------------------------------------------------------------------------------- */

static void say_broken(trial *t, const char *what, double figure, double tolerance)
{
    if (t->verdict == VERDICT_BROKEN) return; /* the first one is told */
    t->verdict = VERDICT_BROKEN;
    (void)snprintf(t->broken, sizeof t->broken, "%s: %.6g, allowed %.6g", what, figure, tolerance);
}

void hold(trial *t, const char *what, double figure, double tolerance)
{
    const double ratio = figure == 0.0 ? 0.0 : figure / tolerance;
    if (!(ratio <= t->ratio)) {
        t->ratio = ratio;
        (void)snprintf(t->what, sizeof t->what, "%s %.3g of %.3g", what, figure, tolerance);
    }
    if (!(ratio <= 1.0)) say_broken(t, what, figure, tolerance);
}

void broken(trial *t, const char *what, double a, double b)
{
    say_broken(t, what, a, b);
}

void left_out(trial *t, const char *reason)
{
    if (t->verdict != VERDICT_HELD) return;
    t->verdict = VERDICT_LEFT_OUT;
    (void)snprintf(t->what, sizeof t->what, "%s", reason);
}

void refused(trial *t, int32_t status, const char *message)
{
    if (t->verdict != VERDICT_HELD) return;
    t->verdict = VERDICT_REFUSED;
    (void)snprintf(t->what, sizeof t->what, "%s: %.150s", dmb_status_name(status), message);
}

/* ---- Rounding --------------------------------------------------------------------------------------------------- */

/* Stiffest element, stiffest ring of the wall, stiffest spring, and the mass that a node moves in a step: [N/m]. */
static double stiffest(const scene *s, double step)
{
    double k = 0.0;
    for (uint32_t i = 0; i < s->bodies; ++i) k = fmax(k, s->body[i].def.mass / (step * step));
    for (uint32_t i = 0; i < s->strings; ++i) {
        const dmb_pipe_def *const p = &s->string[i].pipe[0];
        const double area = 0.25 * PI * (p->outer_diameter * p->outer_diameter - p->inner_diameter * p->inner_diameter);
        const double free = (p->length - p->joint_length) / p->elements;
        k = fmax(k, p->young_modulus * area / free);
        k = fmax(k, p->density * area * p->length / (step * step));
        if (s->has_wall) k = fmax(k, s->wall.stiffness * p->length);
    }
    for (uint32_t i = 0; i < s->joints; ++i)
        for (int c = 0; c < 3; ++c) k = fmax(k, s->joint[i].def.stiffness[c] + s->joint[i].def.damping[c] / step);
    return k;
}

/* Stiffest spring against turning [N m/rad]. */
static double stiffest_turning(const scene *s, double step)
{
    double k = 0.0;
    for (uint32_t i = 0; i < s->joints; ++i)
        for (int c = 3; c < 6; ++c) k = fmax(k, s->joint[i].def.stiffness[c] + s->joint[i].def.damping[c] / step);
    return k;
}

static double shortest(const scene *s)
{
    double length = s->strings > 0 ? 1e30 : 0.3;
    for (uint32_t i = 0; i < s->strings; ++i)
        length = fmin(length, s->string[i].pipe[0].length / s->string[i].pipe[0].elements);
    return length;
}

void rounding_of(const scene *s, double reach, double step, double floor[ANSWER_GROUPS])
{
    const double x = DBL_EPSILON * reach, k = stiffest(s, step), element = shortest(s);
    const double turning = stiffest_turning(s, step) * x / element;
    floor[ANSWER_POSITION] = x;
    floor[ANSWER_ROTATION] = x / element;
    floor[ANSWER_VELOCITY] = x / step;
    floor[ANSWER_SPIN] = x / element / step;
    floor[ANSWER_FORCE] = k * x + turning / element;
    floor[ANSWER_MOMENT] = k * x * element + turning;
    floor[ANSWER_ENERGY] = k * x * 0.1; /* of a force of which 0.1 m is the travel */
}

static void perturb(double p, uint32_t count, double *x)
{
    for (uint32_t i = 0; i < count; ++i) x[i] *= 1.0 + p * (i % 2 == 0 ? 1.0 : -0.7);
}

void scene_perturb(const scene *s, double p, scene *out)
{
    *out = *s;
    perturb(p, 3, out->environment.gravity);
    perturb(p, 1, &out->wall.diameter);
    for (uint32_t k = 0; k < s->strings; ++k) {
        perturb(p, 6, out->string[k].def.velocity);
        for (uint32_t i = 0; i < s->string[k].pipes; ++i) {
            perturb(p, 1, &out->string[k].pipe[i].eccentricity);
            perturb(p, 1, &out->string[k].pipe[i].young_modulus);
        }
    }
    for (uint32_t i = 0; i < s->bodies; ++i) perturb(p, 6, out->body[i].def.velocity);
    for (uint32_t i = 0; i < s->joints; ++i) perturb(p, 6, out->joint[i].def.stiffness);
    for (uint32_t i = 0; i < s->loads; ++i) perturb(p, 3, out->load[i].def.force);
    for (uint32_t i = 0; i < s->drives; ++i) perturb(p, 1, &out->drive[i].time_function.term[0].h1);
}

void condition_add(condition *c, const answers *a, const answers *perturbed, double perturbation)
{
    double difference[ANSWER_GROUPS], size[ANSWER_GROUPS];
    answers_difference(a, perturbed, difference);
    answers_size(a, size);
    c->growth = fmax(c->growth, 1.0);
    for (int g = 0; g < ANSWER_GROUPS; ++g) {
        const double apart = difference[g] * fabs(PERTURBATION / perturbation);
        c->apart[g] = fmax(c->apart[g], apart);
        if (g <= ANSWER_SPIN && size[g] > 0.0) c->growth = fmax(c->growth, apart / (PERTURBATION * size[g]));
    }
}

int hold_rounding(trial *t, const answers *a, const answers *b, const condition *c, int alike,
                  const double floor[ANSWER_GROUPS], int silent)
{
    const double e = alike ? DBL_EPSILON : NEWTON_TOLERANCE;
    double difference[ANSWER_GROUPS], size[ANSWER_GROUPS];
    int good = 1;
    if (a->overflow) broken(t, "room for answers", a->count, ANSWERS_MOST);
    answers_difference(a, b, difference);
    answers_size(a, size);
    for (int g = 0; g < ANSWER_GROUPS; ++g) {
        const double tolerance =
            1000.0 * (c->growth * (e / DBL_EPSILON * floor[g] + e * size[g]) + e / PERTURBATION * c->apart[g]);
        good &= difference[g] <= tolerance;
        if (!silent) hold(t, answer_group_name((answer_group)g), difference[g], tolerance);
    }
    return good;
}

void scene_kick(scene *s, const double force[3], double time)
{
    load_data *const kick = &s->load[s->loads++];
    kick->def = dmb_load_def_default();
    memcpy(kick->def.force, force, sizeof kick->def.force);
    kick->place = s->load[0].place;
    kick->time_function = time_function_step(0.0, 1.0, 0.0, 0.5 * time);
    kick->time_function.term[0] = kick->time_function.term[1];
    kick->time_function.term[0].x0 = 0.5 * time;
    kick->time_function.term[0].x1 = time;
    kick->time_function.term[0].h1 = -1.0;
}

/* ---- Runs ------------------------------------------------------------------------------------------------------- */

/* FNV-1a of numbers */
static void follow(uint64_t *hash, uint32_t number)
{
    if (*hash == 0) *hash = UINT64_C(0xcbf29ce484222325);
    *hash = (*hash ^ number) * UINT64_C(0x100000001b3);
}

int32_t run_steps(built *b, double step, uint32_t steps, decisions *d)
{
    for (uint32_t i = 0; i < steps; ++i) {
        dmb_step_report report = dmb_step_report_default();
        const int32_t status = dmb_sim_step(b->sim, step, &report);
        if (status < 0) return built_fail(b, status);
        if (d == NULL) continue;
        follow(&d->divided, report.steps);
        follow(&d->iterations, report.iterations);
        d->rejected += report.rejected;
    }
    return DMB_OK;
}

static run_record plain, other, aside;
static scene perturbed;

static void run(const scene *original, const comparison *c, run_record *r)
{
    built b;
    memset(&r->decisions, 0, sizeof r->decisions);
    r->status = scene_open(c->seen, c->reversed, c->options, &b);
    if (r->status >= 0) r->status = run_steps(&b, original->step, c->steps, &r->decisions);
    if (r->status >= 0) answers_take(original, c->seen, c->view, &b, &r->answers);
    memcpy(r->message, b.message, sizeof b.message);
    scene_close(&b);
}

static double reach_of(const scene *s, const scene_view *view)
{
    double reach = s->span + 10.0;
    for (int i = 0; i < 3; ++i) reach += fabs(view->shift[i]);
    return reach;
}

/* Perturbations one after the other, until the runs hold together: contacts that one of them does not reach, another
 * does. Returns the status of the first that fails. */
static int32_t hold_condition(trial *t, const comparison *first, int alike, const double floor[ANSWER_GROUPS])
{
    static const double sizes[] = {1.0, -1.0, 0.3, -0.3, 3.0, -3.0};
    condition c;
    memset(&c, 0, sizeof c);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        comparison hair = *first;
        hair.seen = &perturbed;
        scene_perturb(&t->s, sizes[i] * PERTURBATION, &perturbed);
        run(&t->s, &hair, &aside);
        if (aside.status < 0) return aside.status;
        condition_add(&c, &plain.answers, &aside.answers, sizes[i] * PERTURBATION);
        if (hold_rounding(t, &plain.answers, &other.answers, &c, alike, floor, 1)) break;
    }
    (void)hold_rounding(t, &plain.answers, &other.answers, &c, alike, floor, 0);
    return DMB_OK;
}

/* Steps that Newton fails at are divided: that it fails may hang on rounding, and then the runs differ as their steps.
 */
void hold_runs(trial *t, const comparison *c)
{
    double floor[ANSWER_GROUPS];
    scene_view as_it_is = view_identity();
    as_it_is.motion_only = c->view->motion_only;
    const comparison first = {&t->s, &as_it_is, 0, c->steps, NULL, 0};
    run(&t->s, &first, &plain);
    run(&t->s, c, &other);
    const int alike = plain.decisions.iterations == other.decisions.iterations && !c->loose;
    const int divided = plain.decisions.divided != other.decisions.divided;
    if (plain.status < 0 && other.status < 0) {
        refused(t, plain.status, plain.message);
    } else if (plain.status < 0 || other.status < 0) {
        broken(t, plain.status < 0 ? plain.message : other.message, plain.status, other.status);
    } else if (divided || (!alike && plain.decisions.rejected > 0)) {
        left_out(t, "a step that is divided by a hair");
    } else {
        rounding_of(&t->s, reach_of(&t->s, c->view), t->s.step, floor);
        if (hold_condition(t, &first, alike, floor) < 0) left_out(t, "a run that fails by a hair");
    }
}
