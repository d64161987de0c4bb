/* Strings of bent pipes in flight with gravity against the same without it. A body that nothing holds falls with g,
 * whatever it does meanwhile: in a uniform translation of any deformed state mass, momentum, kinetic energy and weight
 * are those of its whole mass, and nothing of it strains the pipes. The scheme keeps that to second order in the step.
 */
#include "relations.h"

enum {
    TOPIC_FLIGHT = TOPIC_OF_RELATION + 97,
    STEPS = 40,
    LEVELS = 4,
    FIGURES = 5,
    FORCES_MOST = 12 * SCENE_STRINGS * SCENE_PIPES
};

typedef struct flight {
    double time;
    dmb_momentum momentum;
    dmb_energy energy;
    uint32_t count;
    double force[FORCES_MOST], size; /* [N] of sections, the largest */
} flight;

static flight still, falling;

/* Pipes of one, two or four elements that turn by up to 1 rad each, about any axis across. */
static void bend(scene *s, stream *n)
{
    for (uint32_t k = 0; k < s->strings; ++k)
        for (uint32_t i = 0; i < s->string[k].pipes; ++i) {
            dmb_pipe_def *const p = &s->string[k].pipe[i];
            const double angle = draw_number(n, 0.02, 1.0), about = draw_number(n, 0.0, 2.0 * PI);
            p->elements = 1U << draw_count(n, 0, 2);
            p->curvature[1] = angle * p->elements / p->length * cos(about);
            p->curvature[2] = angle * p->elements / p->length * sin(about);
        }
}

static void take_sections(const scene *s, const built *b, flight *out)
{
    out->count = 0;
    out->size = 0.0;
    for (uint32_t k = 0; k < s->strings; ++k)
        for (uint32_t i = 0; i < s->string[k].pipes; ++i)
            for (int half = 0; half < 2; ++half) {
                dmb_section section = dmb_section_default();
                (void)dmb_query_section(b->sim, dmb_station(b->string[k], i, 0.3 + 0.4 * half), &section);
                for (int c = 0; c < 6; ++c) {
                    out->force[out->count++] = section.force[c];
                    out->size = fmax(out->size, fabs(section.force[c]));
                }
            }
}

static int32_t fly(const scene *s, uint32_t level, built *b, flight *out)
{
    int32_t status = scene_open(s, 0, NULL, b);
    if (status >= 0) status = run_steps(b, s->step / (double)(1U << level), (uint32_t)STEPS << level, NULL);
    if (status < 0) return status;
    out->time = dmb_sim_time(b->sim);
    out->momentum = dmb_momentum_default();
    out->energy = dmb_energy_default();
    (void)dmb_query_momentum(b->sim, &out->momentum);
    (void)dmb_query_energy(b->sim, &out->energy);
    take_sections(s, b, out);
    return status;
}

static double difference_of(const flight *a, const flight *b)
{
    double worst = 0.0;
    for (uint32_t i = 0; i < a->count; ++i) worst = fmax(worst, fabs(a->force[i] - b->force[i]));
    return worst;
}

/* Differences of the same motion seen from axes that fall with g: centre [m], momentum [kg m/s], kinetic and strain
 * energy [J], section forces [N]; and the rounding of each. */
static void compare(const scene *s, const double g[3], double figure[FIGURES], double floor[FIGURES])
{
    const dmb_momentum *const a = &still.momentum, *const b = &falling.momentum;
    const double mass = a->mass, time = still.time;
    double energy = still.energy.kinetic, speed = 0.0, rounding[ANSWER_GROUPS];
    memset(figure, 0, FIGURES * sizeof *figure);
    for (int i = 0; i < 3; ++i) {
        const double v = g[i] * time;
        energy += v * a->linear[i] + 0.5 * mass * v * v;
        speed += v * v;
        figure[0] = fmax(figure[0], fabs(b->centre[i] - a->centre[i] - 0.5 * v * time));
        figure[1] = fmax(figure[1], fabs(b->linear[i] - a->linear[i] - mass * v));
    }
    figure[2] = fabs(falling.energy.kinetic - energy);
    figure[3] = fabs(falling.energy.strain - still.energy.strain);
    figure[4] = difference_of(&still, &falling);
    rounding_of(s, s->span + 10.0, s->step, rounding);
    floor[0] = 1e-11 * (s->span + sqrt(speed) * time);
    floor[1] = 1e-9 * mass * (sqrt(speed) + 1.0);
    floor[2] = floor[3] = 1e-9 * (mass * speed + fabs(energy));
    floor[4] = 1e-8 * still.size + 1e3 * rounding[ANSWER_FORCE];
}

static int32_t both_fly(trial *t, const double g[3], uint32_t level)
{
    int32_t status = DMB_OK;
    for (int pass = 0; pass < 2 && status >= 0; ++pass) {
        built b;
        for (int i = 0; i < 3; ++i) t->s.environment.gravity[i] = pass ? g[i] : 0.0;
        status = fly(&t->s, level, &b, pass ? &falling : &still);
        if (status < 0) refused(t, status, b.message);
        scene_close(&b);
    }
    return status;
}

static void prepare(trial *t, double g[3])
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_FLIGHT);
    dmb_environment_def *const e = &t->s.environment;
    e->fluid_density = e->added_mass = e->lateral_damping = e->axial_damping = e->torsional_damping = 0.0;
    e->inner_density = -1.0;
    t->s.drives = 0;
    bend(&t->s, &n);
    for (int i = 0; i < 3; ++i) g[i] = draw_number(&n, -9.81, 9.81);
}

/* A quarter is left at half the step, or rounding; steps that do not resolve the motion yet are halved once more. */
static void check_flight(trial *t)
{
    static const char *const names[FIGURES] = {"centre less g t^2/2", "momentum less m g t",
                                               "kinetic energy of the fall", "strain energy", "section forces"};
    double g[3], before[FIGURES], figure[FIGURES], floor[FIGURES];
    prepare(t, g);
    if (both_fly(t, g, 0) < 0) return;
    compare(&t->s, g, before, floor);
    for (uint32_t level = 1; level <= LEVELS; ++level) {
        int good = 1;
        if (both_fly(t, g, level) < 0) return;
        compare(&t->s, g, figure, floor);
        for (int i = 0; i < FIGURES; ++i) good = good && figure[i] <= 0.35 * before[i] + floor[i];
        for (int i = 0; i < FIGURES && (good || level == LEVELS); ++i)
            hold(t, names[i], figure[i], 0.35 * before[i] + floor[i]);
        if (good) return;
        memcpy(before, figure, sizeof before);
    }
}

const relation relation_flight = {"flight",
                                  "bent strings that nothing holds, with gravity against without it",
                                  {FAMILY_FREE, WISH_FLEXIBLE | WISH_NO_JOINTS | WISH_NO_CONTROL | WISH_NO_BIT, 4},
                                  40,
                                  0.5,
                                  check_flight,
                                  0.0};
