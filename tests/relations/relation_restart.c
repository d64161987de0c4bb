/* A run that goes on from a snapshot of its middle against the run straight through: the same bits. A run handed over
 * to another sim and back (dmb_sim_transfer_state) against one that stays: the same to rounding, and the state of any
 * run handed over. */
#include "hash.h"
#include "relations.h"

enum { STEPS = 60, BYTES = 4000000 };

/* ---- Snapshots -------------------------------------------------------------------------------------------------- */

static unsigned char block[BYTES];

/* Fixed steps, then some that the error control chooses. */
static int32_t go_on(built *b, double step)
{
    int32_t status = run_steps(b, step, STEPS / 2, NULL);
    if (status < 0) return status;
    status = dmb_sim_advance(b->sim, dmb_sim_time(b->sim) + 3.0 * step, NULL);
    return status < 0 ? built_fail(b, status) : status;
}

static int32_t straight_and_restored(const scene *s, const dmb_sim_options *options, built *a, dmb_sim **again,
                                     uint64_t hash[2])
{
    size_t size = 0;
    int32_t status = go_on(a, s->step);
    if (status >= 0) status = dmb_sim_snapshot_size(a->sim, &size);
    if (status >= 0 && size > BYTES) status = DMB_ERR_TOO_LARGE;
    if (status >= 0) status = dmb_sim_snapshot(a->sim, block, size);
    if (status >= 0) status = go_on(a, s->step);
    hash[0] = hash_of(a->sim);
    if (status >= 0) status = dmb_sim_create(a->model, options, again);
    if (status >= 0) status = dmb_sim_restore(*again, block, size);
    if (status < 0) return status;
    dmb_sim *const first = a->sim;
    a->sim = *again;
    status = go_on(a, s->step);
    hash[1] = hash_of(a->sim);
    a->sim = first;
    return status;
}

static void check_snapshot(trial *t)
{
    built a;
    dmb_sim *again = NULL;
    uint64_t hash[2] = {0, 1};
    dmb_sim_options options = scene_options(&t->s);
    options.newton_tolerance = 1e-8;
    options.max_steps = 500;
    int32_t status = scene_open(&t->s, 0, &options, &a);
    if (status >= 0) status = straight_and_restored(&t->s, &options, &a, &again, hash);
    if (status < 0)
        refused(t, status, a.message);
    else if (hash[0] != hash[1])
        broken(t, "other bits after a snapshot", (double)hash[0], (double)hash[1]);
    dmb_sim_destroy(&again);
    scene_close(&a);
}

/* ---- Carried over ----------------------------------------------------------------------------------------------- */

static answers plain, other, aside;
static scene perturbed, longer;

/* The same scene with a pipe more at the rig end of its first string, in line with it. */
static void lengthen(const scene *s, scene *out)
{
    *out = *s;
    string_data *const k = &out->string[0];
    const double length = k->pipe[0].length;
    double R[9];
    rotation_of_vector(k->def.rotation, R);
    for (int i = 0; i < 3; ++i) k->def.position[i] -= length * R[3 * i];
    k->def.start_depth -= length;
    for (uint32_t i = k->pipes; i > 0; --i) k->pipe[i] = k->pipe[i - 1];
    ++k->pipes;
    for (uint32_t i = 0; i < out->joints; ++i) {
        if (out->joint[i].a.kind == PART_STRING && out->joint[i].a.index == 0) ++out->joint[i].a.pipe;
        if (out->joint[i].b.kind == PART_STRING && out->joint[i].b.index == 0) ++out->joint[i].b.pipe;
    }
    for (uint32_t i = 0; i < out->loads; ++i)
        if (out->load[i].place.kind == PART_STRING && out->load[i].place.index == 0) ++out->load[i].place.pipe;
}

/* Goes on in a sim of `to`. */
static int32_t hand_over(const scene *to, built *b)
{
    built next;
    int32_t status = scene_open(to, 0, NULL, &next);
    if (status >= 0) status = dmb_sim_transfer_state(next.sim, b->sim);
    if (status < 0) (void)built_fail(&next, status);
    scene_close(b);
    *b = next;
    return status;
}

/* From the static state on, whose load grows after the hand-over. */
static int32_t run_carried(const scene *s, const scene *by_way_of, char message[256], answers *out)
{
    built b;
    int32_t status = scene_open(s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, NULL, NULL);
    if (status < 0) (void)built_fail(&b, status);
    if (status >= 0) status = run_steps(&b, s->step, 2, NULL);
    if (status >= 0 && by_way_of) status = hand_over(by_way_of, &b);
    if (status >= 0 && by_way_of) status = hand_over(s, &b);
    if (status >= 0) status = run_steps(&b, s->step, STEPS / 2, NULL);
    if (status >= 0) answers_take(s, s, NULL, &b, out);
    memcpy(message, b.message, sizeof b.message);
    scene_close(&b);
    return status;
}

static void check_carried(trial *t)
{
    char first[256], second[256], third[256];
    double floor[ANSWER_GROUPS];
    condition hair = {{0.0}, 0.0};
    if (t->s.loads > 0) t->s.load[0].time_function = time_function_step(1.0, 0.5, 2.0 * t->s.step, 20.0 * t->s.step);
    lengthen(&t->s, &longer);
    scene_perturb(&t->s, PERTURBATION, &perturbed);
    const int32_t one = run_carried(&t->s, NULL, first, &plain);
    const int32_t two = run_carried(&t->s, &longer, second, &other);
    const int32_t three = run_carried(&perturbed, NULL, third, &aside);
    if (one < 0) {
        refused(t, one, first);
    } else if (two < 0 || three < 0) {
        broken(t, two < 0 ? second : third, two, three);
    } else {
        rounding_of(&t->s, t->s.span + 10.0, t->s.step, floor);
        condition_add(&hair, &plain, &aside, PERTURBATION);
        (void)hold_rounding(t, &plain, &other, &hair, 0, floor, 0);
    }
}

/* ---- Handed over under way -------------------------------------------------------------------------------------- */

/* The step in which a bristle breaks away ends with the friction of sticking, and the state after it has that of
 * sliding: its accelerations, computed again, are different (seed 1, scene 306). */
static int bristles_break_away(const scene *s)
{
    return s->has_wall && s->wall.friction_law == DMB_FRICTION_BRISTLE;
}

/* The state is handed over: positions, speeds, forces and works are those of the sim it comes from. The steps after it
 * are another run, since accelerations are computed again. Reactions of a step in which a contact opens by its mean
 * force contain that force, and those computed again do not, because the state keeps nothing of an open contact: in
 * seed 21, scene 442 a joint differs by 7.8 N of 461 N, in seed 77, scene 162 a rig end by 0.66 N of 117 N, with equal
 * accelerations. */
static void check_handed(trial *t)
{
    if (bristles_break_away(&t->s)) {
        left_out(t, "bristles, which may break away");
        return;
    }
    built b;
    double floor[ANSWER_GROUPS];
    const condition none = {{0.0}, 1.0};
    int32_t status = scene_open(&t->s, 0, NULL, &b);
    if (status >= 0) status = run_steps(&b, t->s.step, STEPS / 2, NULL);
    if (status < 0) {
        refused(t, status, b.message);
    } else {
        answers_take(&t->s, &t->s, NULL, &b, &plain);
        status = hand_over(&t->s, &b);
        if (status < 0)
            broken(t, b.message, status, 0.0);
        else
            answers_take(&t->s, &t->s, NULL, &b, &other);
        rounding_of(&t->s, t->s.span + 10.0, t->s.step, floor);
        if (status >= 0) (void)hold_rounding(t, &plain, &other, &none, 1, floor, 0);
    }
    scene_close(&b);
}

const relation relation_snapshot = {"snapshot",
                                    "a run from a snapshot of its middle against the run straight through",
                                    {FAMILY_ALL, 0, 0},
                                    40,
                                    0.7,
                                    check_snapshot,
                                    0.0};
const relation relation_carried = {"carried",
                                   "a run handed over to another model and back against one that stays",
                                   {FAMILY_LINE, WISH_STILL | WISH_ELASTIC | WISH_NO_CONTROL, 4},
                                   40,
                                   0.5,
                                   check_carried,
                                   0.0};
const relation relation_handed = {"handed",
                                  "the state of a run under way against what another sim makes of it",
                                  {FAMILY_ALL, 0, 4},
                                  40,
                                  0.7,
                                  check_handed,
                                  0.0};
