/* Events: stops at crossings of levels by outputs. A crossing is detected at the end of the step that contains it.
 *
 *     call           after the step with a crossing                            time of the crossing
 *     ------------   -------------------------------------------------------   ----------------------------------------
 *     to a time      reverted and repeated with shorter lengths until the      end of the step
 *                    crossing is bracketed within its tolerance
 *     equal steps    ends as it is                                             parabola through the ends of two steps
 *
 * Of several crossings in a step the first is located: each of them gives an estimate by false position (Illinois:
 * Dowell, Jarratt, BIT 11, 1971), and the smallest is tried; if two tries have not halved the bracket, its midpoint is
 * tried.
 *
 * State of an output that is held `hold` seconds (event_since):
 *
 *     NaN          not beyond its level
 *     time         beyond since that crossing; reported when `hold` has passed
 *     infinite     reported, or beyond when the call began: counts again after it has returned */
#include <float.h>
#include <math.h>
#include <string.h>

#include "integrator/step.h"
#include "query/query.h"
#include "run/run.h"
#include "sim/access.h"
#include "sim/layout.h"

DMB_DECLARE_STRUCT(dmb_step_report)

/* clang-format off */
DMB_DEFINE_INIT(dmb_event_report, 40, {.crossing = (double)NAN})
/* clang-format on */

enum { MARGIN = 100, SLOW = 2, HALVINGS = 20 };

/* Outputs less their levels, with the sign of their direction: > 0 is beyond. */
typedef struct gaps {
    double value[DMB_EVENTS_MAX];
} gaps;

typedef struct hunt {
    dmb_sim *sim;
    dmb_stepping stepping;
    double end;        /* [s] where the call is to end */
    double wanted;     /* [s] step length of the control */
    gaps before;       /* at the start of the step */
    uint64_t reported; /* events */
    double located;    /* [s] width of the bracket */
    double crossing;   /* [s] of the first of them */
    double from;       /* [s] start of the step */
    int32_t equal;     /* 1: equal steps, which do not end at crossings */
    int32_t looks;     /* 1: no step is accepted yet */
} hunt;

static int32_t ask(dmb_sim *sim, gaps *found)
{
    for (uint32_t i = 0; i < sim->scene->event_count; i++) {
        const dmb_scene_event *event = sim->scene->events + i;
        double value = 0.0;
        const int32_t status = dmb_output_value(sim, &event->output, &value);
        if (status < 0 || !isfinite(value)) {
            dmb_message words;
            dmb_message_set(&sim->message,
                            "event %u (%s): its output, %s, cannot be asked: %s; see to its quantity and place", i,
                            event->name, dmb_output_words(sim->model, &event->output, &words),
                            status < 0 ? dmb_status_text(status) : "it is not finite");
            return status < 0 ? status : DMB_ERR_NOT_FINITE;
        }
        found->value[i] = event->direction == DMB_EVENT_FALLING ? event->level - value : value - event->level;
    }
    return DMB_OK;
}

void dmb_events_begin(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->event_count; i++) sim->event_since[i] = (double)NAN;
}

int32_t dmb_events_check(dmb_sim *sim)
{
    gaps unused;
    return sim->scene->event_count > 0 ? ask(sim, &unused) : DMB_OK;
}

/* ---- Crossings --------------------------------------------------------------------------------------------------- */

static int is_either(const dmb_sim *sim, uint32_t i)
{
    return sim->scene->events[i].direction == DMB_EVENT_EITHER;
}

static double side_of(double gap)
{
    return gap > 0.0 ? 1.0 : gap < 0.0 ? -1.0 : 0.0;
}

/* 1: the output crosses: EITHER from its last side to the other; RISING or FALLING from not beyond to beyond. */
static int crosses(const dmb_sim *sim, uint32_t i, double before, double after)
{
    if (!is_either(sim, i)) return !(before > 0.0) && after > 0.0;
    const double side = before != 0.0 ? side_of(before) : sim->event_side[i];
    return side != 0.0 && side_of(after) == -side;
}

static uint64_t crossings(const hunt *h, const gaps *after)
{
    uint64_t found = 0;
    for (uint32_t i = 0; i < h->sim->scene->event_count; i++)
        if (crosses(h->sim, i, h->before.value[i], after->value[i])) found |= UINT64_C(1) << i;
    return found;
}

/* ---- Time of a crossing ------------------------------------------------------------------------------------------ */

/* Output less its level at three ends of steps, signed so that it crosses from <= 0 to > 0 in the last step. */
typedef struct parabola {
    double slope, bend; /* Newton's form from the start of the last step: gap + slope s + bend s (s - length) */
    double gap, length;
} parabola;

/* Second divided difference of the output over the last two steps. Where the step before has not ended in the present
 * output and time, for example because an input was set between, the chord alone is used. */
static parabola parabola_of(const double past[DMB_PAST_SIZE], double before, double after, double from, double to)
{
    const double sign = after > 0.0 || before < 0.0 ? 1.0 : -1.0, earlier = from - past[DMB_PAST_TIME];
    parabola p = {.gap = sign * before, .length = to - from};
    p.slope = sign * (after - before) / p.length;
    /* the output and the time are those in which the step before has ended: nothing has changed between */
    const int follows = !(past[DMB_PAST_END] < before || past[DMB_PAST_END] > before) &&
                        !(past[DMB_PAST_END_TIME] < from || past[DMB_PAST_END_TIME] > from);
    if (follows && earlier > 0.0)
        p.bend = (p.slope - sign * (before - past[DMB_PAST_GAP]) / earlier) / (p.length + earlier);
    return p;
}

/* [s] Time since the start of the step at which it changes sign: bisection, since the signs at both ends are given. */
static double root_of(const parabola *p)
{
    double low = 0.0, high = p->length;
    for (int k = 0; k < DBL_MANT_DIG; k++) {
        const double s = 0.5 * (low + high);
        if (p->gap + s * (p->slope + p->bend * (s - p->length)) > 0.0)
            high = s;
        else
            low = s;
    }
    return high;
}

/* [s] Time at which the output of an event crosses its level in the step that is done: its end, where steps end at
 * crossings. */
static double crossing_time(const hunt *h, uint32_t i, double after)
{
    const double to = h->sim->clock->time;
    if (!h->equal) return to;
    const double *past = h->sim->event_past + DMB_PAST_SIZE * (size_t)i;
    const parabola p = parabola_of(past, h->before.value[i], after, h->from, to);
    return fmin(h->from + root_of(&p), to);
}

/* ---- Holds: since when outputs are beyond their levels ----------------------------------------------------------- */

/* At the start of a call: outputs beyond their level, and not held since a crossing, count only after they have
 * returned. */
static void look_around(dmb_sim *sim, const gaps *now)
{
    for (uint32_t i = 0; i < sim->scene->event_count; i++) {
        const int beyond = now->value[i] > 0.0;
        if (now->value[i] != 0.0) sim->event_side[i] = side_of(now->value[i]);
        if (is_either(sim, i)) continue;
        if (!beyond) sim->event_since[i] = (double)NAN;
        if (beyond && isnan(sim->event_since[i])) sim->event_since[i] = (double)INFINITY;
    }
}

/* After the first step: until then a failing call has changed nothing. */
static void look_first(hunt *h)
{
    if (h->looks) look_around(h->sim, &h->before);
    h->looks = 0;
}

/* [s] Time at which the first hold ends of outputs that are beyond their levels; INFINITY if none is active. */
static double hold_end(const dmb_sim *sim, const gaps *now)
{
    double first = (double)INFINITY;
    for (uint32_t i = 0; i < sim->scene->event_count; i++)
        if (now->value[i] > 0.0 && isfinite(sim->event_since[i]))
            first = fmin(first, sim->event_since[i] + sim->scene->events[i].hold);
    return first;
}

/* The bit of an event that crossed at `time`, which is reported. */
static uint64_t note_crossing(hunt *h, uint32_t i, double time)
{
    h->crossing = fmin(h->crossing, time); /* of NaN and a number the number */
    return UINT64_C(1) << i;
}

/* [s] Time up to which an output has been beyond its level in the step. */
static double beyond_until(const hunt *h, uint32_t i, double after)
{
    if (after > 0.0) return h->sim->clock->time;
    return h->equal ? crossing_time(h, i, after) : -(double)INFINITY; /* there, holds end at ends of steps */
}

static uint64_t end_hold(hunt *h, uint32_t i, double after, int crossed)
{
    double *since = h->sim->event_since + i;
    uint64_t reported = 0;
    if (crossed) *since = crossing_time(h, i, after);
    if (isfinite(*since) && beyond_until(h, i, after) >= *since + h->sim->scene->events[i].hold) {
        reported = note_crossing(h, i, *since);
        *since = (double)INFINITY;
    }
    if (!(after > 0.0)) *since = (double)NAN;
    return reported;
}

/* After a step: crossings start their hold, outputs that returned end it, and outputs held long enough are reported. */
static uint64_t reported_events(hunt *h, const gaps *now, uint64_t crossed)
{
    dmb_sim *sim = h->sim;
    uint64_t reported = 0;
    for (uint32_t i = 0; i < sim->scene->event_count; i++) {
        const double after = now->value[i];
        const int here = (int)(crossed >> i & 1);
        if (!is_either(sim, i)) reported |= end_hold(h, i, after, here);
        if (is_either(sim, i) && here) reported |= note_crossing(h, i, crossing_time(h, i, after));
        if (after != 0.0) sim->event_side[i] = side_of(after);
    }
    return reported;
}

/* ---- Location ---------------------------------------------------------------------------------------------------- */

/* [s] Smallest tolerance of the crossing outputs, not below the rounding of time. */
static double tolerance_of(const hunt *h, uint64_t crossed)
{
    double least = 1.0;
    for (uint32_t i = 0; i < h->sim->scene->event_count; i++)
        if (crossed >> i & 1) least = fmin(least, h->sim->scene->events[i].tolerance);
    return fmax(least, 8.0 * DBL_EPSILON * h->sim->clock->time);
}

/* End of the original step, used if the bracket still ends there. */
static dmb_step_end whole_step(const hunt *h, const dmb_clock *reached)
{
    dmb_step_end end = dmb_step_end_at(h->sim, reached->time);
    end.step = reached->step;
    end.rest = reached->rest;
    end.breakpoint = reached->breakpoint != h->sim->clock->breakpoint ? reached->breakpoint : 0.0;
    return end;
}

/* Repeats the step from the stored state with a length, or to the end `reached`. Reverted work counts as rejected. */
static int32_t step_again(hunt *h, double length, const dmb_clock *reached, gaps *found)
{
    dmb_sim *sim = h->sim;
    dmb_trial_step trial_step;
    dmb_state_restore(sim);
    const dmb_step_end end = reached != NULL ? whole_step(h, reached) : dmb_step_end_after(sim, length);
    if (!(end.time > sim->clock->time)) return dmb_stepping_stuck(sim, "length", length);
    int32_t status = dmb_trial_step_run(sim, &end, 1, &trial_step);
    if (status == DMB_NOTE_WORK_LIMITED) status = trial_step.status = DMB_ERR_NO_CONVERGENCE;
    if (status < 0) {
        dmb_stepping_reject(sim, &trial_step, &h->stepping);
        return status;
    }
    status = dmb_stepping_commit(sim, &trial_step, &h->stepping);
    if (status < 0) return status;
    dmb_advance_propose(sim, h->wanted);
    return ask(sim, found);
}

/* Bracket of the first crossing, in lengths of the step. */
typedef struct bracket {
    double low, high;
    gaps at_low, at_high; /* for estimates: halved at an end that stays */
    uint64_t crossed;     /* within it */
    int32_t last;         /* -1, 1: end moved by the last try */
    int32_t slow;         /* number of consecutive tries that did not halve it */
} bracket;

/* [s] Smallest estimate of the outputs that cross within the bracket. An output that starts on its level, such as the
 * force of an open contact, gives no information: the midpoint. */
static double guess(const hunt *h, const bracket *b, double tolerance)
{
    const double width = b->high - b->low;
    double least = b->high;
    for (uint32_t i = 0; i < h->sim->scene->event_count; i++) {
        const double low = fabs(b->at_low.value[i]), high = fabs(b->at_high.value[i]);
        if (b->crossed >> i & 1) least = fmin(least, b->low + width * (low > 0.0 ? low / (low + high) : 0.5));
    }
    if (b->slow >= SLOW) return b->low + 0.5 * width;
    return fmin(fmax(least + 0.5 * tolerance, b->low + width / MARGIN), b->high - width / MARGIN);
}

static void narrow(const hunt *h, bracket *b, double at, const gaps *tried)
{
    const double width = b->high - b->low;
    const uint64_t crossed = crossings(h, tried);
    const int32_t end = crossed ? 1 : -1;
    if (crossed) {
        b->high = at;
        b->at_high = *tried;
        b->crossed = crossed;
    } else {
        b->low = at;
        b->at_low = *tried;
    }
    for (uint32_t i = 0; i < h->sim->scene->event_count && end == b->last; i++)
        (crossed ? b->at_low.value : b->at_high.value)[i] *= 0.5;
    b->last = end;
    b->slow = b->high - b->low > 0.5 * width ? b->slow + 1 : 0;
}

/* A step of a length within the bracket. Newton may fail there although it converges for the whole step, for example if
 * a contact closes shortly before: then half the distance from the bracket's lower end is tried, repeatedly. */
static int32_t try_length(hunt *h, const bracket *b, double *length, gaps *tried)
{
    int32_t status = step_again(h, *length, NULL, tried);
    for (int i = 0; i < HALVINGS && status == DMB_ERR_NO_CONVERGENCE; i++) {
        *length = b->low + 0.5 * (*length - b->low);
        status = step_again(h, *length, NULL, tried);
    }
    return status;
}

/* Reverts the step that contains a crossing and ends at the first one; `found`: the outputs there. If a length fails
 * and a shorter step does not reach the crossing, it ends with that step, before the crossing, and the next step
 * continues from there. */
static int32_t locate(hunt *h, gaps *found)
{
    const dmb_clock reached = *h->sim->clock;
    const uint32_t steps = h->stepping.report.steps - 1;
    bracket b = {.high = reached.step, .at_low = h->before, .at_high = *found, .crossed = crossings(h, found)};
    double last = b.high;
    int32_t status = DMB_OK;
    for (double tolerance; tolerance = tolerance_of(h, b.crossed), status >= 0 && b.high - b.low > tolerance;) {
        gaps tried;
        const double wanted = last = guess(h, &b, tolerance);
        h->stepping.report.steps = steps;
        h->stepping.report.rejected++;
        status = try_length(h, &b, &last, &tried);
        if (status >= 0 && last < wanted && !crossings(h, &tried)) {
            *found = tried;
            return status;
        }
        if (status >= 0) narrow(h, &b, last, &tried);
        if (status >= 0 && b.last > 0) *found = tried;
    }
    h->located = b.high - b.low;
    if (status >= 0 && last != b.high) {
        h->stepping.report.steps = steps;
        status = step_again(h, b.high, b.high == reached.step ? &reached : NULL, found);
    }
    if (status >= 0) return status;
    dmb_state_restore(h->sim);
    h->stepping.report.steps = steps;
    return status;
}

/* ---- The call ---------------------------------------------------------------------------------------------------- */

/* One step towards the end of the call or of a hold, and location of the first crossing in it. */
static int32_t go(hunt *h)
{
    dmb_sim *sim = h->sim;
    gaps now;
    const double goal = fmin(h->end, hold_end(sim, &h->before));
    uint64_t crossed = 0;
    now = h->before;
    h->located = 0.0;
    if (goal > sim->clock->time) {
        dmb_state_back_up(sim);
        int32_t status = dmb_advance_once(sim, goal, &h->wanted, &h->stepping);
        if (status >= 0) status = ask(sim, &now);
        if (status < 0) return status;
        crossed = crossings(h, &now);
        if (crossed) status = locate(h, &now);
        if (status < 0) return status;
        if (crossed) crossed = crossings(h, &now);
    }
    look_first(h);
    h->reported = reported_events(h, &now, crossed);
    if (!(h->reported & crossed)) h->located = 0.0;
    h->before = now;
    return DMB_OK;
}

static uint32_t ones(uint64_t bits)
{
    uint32_t count = 0;
    for (; bits != 0; bits &= bits - 1) count++;
    return count;
}

/* "stopped at time 1.5 by event contact, off bottom" */
static void set_message(hunt *h)
{
    dmb_sim *sim = h->sim;
    dmb_message names, longer;
    dmb_message_clear(&names);
    for (uint32_t i = 0; i < sim->scene->event_count; i++) {
        if (!(h->reported >> i & 1)) continue;
        dmb_message_set(&longer, "%s%s%s", names.text, names.text[0] ? ", " : "", sim->scene->events[i].name);
        names = longer;
    }
    dmb_message_set(&sim->message, "stopped at time %g by event %s", sim->clock->time, names.text);
}

static int32_t report_event(const hunt *h, dmb_event_report *event)
{
    dmb_event_report answer = dmb_event_report_default();
    if (event == NULL) return DMB_OK;
    answer.count = ones(h->reported);
    answer.events = h->reported;
    answer.time = h->sim->clock->time;
    answer.located = h->located;
    answer.crossing = h->crossing;
    return dmb_event_report_write(event, &answer);
}

static int32_t check_report(const dmb_event_report *event)
{
    dmb_event_report unused;
    return event == NULL ? DMB_OK : dmb_event_report_read(&unused, event);
}

/* Outputs at the start of a call. */
static int32_t begin(hunt *h)
{
    dmb_sim *sim = h->sim;
    if (sim->scene->event_count == 0) {
        dmb_message_set(&sim->message, "%s to event: the model has no events; add one, or use the call without events",
                        h->equal ? "steps" : "advance");
        return DMB_ERR_VALUE;
    }
    return ask(sim, &h->before);
}

/* The step is accepted even where an output cannot be asked after it: the caller's function sees it, and the message
 * remains that of the output. */
static void end_step(hunt *h, int32_t status)
{
    const dmb_message message = h->sim->message;
    const int32_t stopped = dmb_stepping_stops(h->sim, h->end, &h->stepping);
    if (status < 0)
        h->sim->message = message;
    else
        h->stepping.stopped = stopped;
}

static int32_t finish(hunt *h, int32_t status, dmb_event_report *event)
{
    if (status < 0) return status;
    (void)report_event(h, event);
    if (h->reported == 0) return status;
    set_message(h);
    return DMB_NOTE_EVENT;
}

static int32_t advance(dmb_sim *sim, double time, dmb_event_report *event, dmb_step_report *report)
{
    hunt h = {.sim = sim, .end = time, .crossing = (double)NAN, .looks = 1};
    int32_t status = check_report(event);
    if (status >= 0) status = dmb_stepping_begin(sim, report, &h.stepping);
    if (status >= 0) status = dmb_stepping_check(sim, "time", time, sim->clock->time);
    if (status >= 0) status = begin(&h);
    if (status < 0) return status;
    const double start = sim->clock->time;
    h.wanted = dmb_advance_first(sim);
    while (status >= 0 && sim->clock->time < time && !h.stepping.stopped && h.reported == 0) {
        dmb_progress_at(sim, (sim->clock->time - start) / (time - start));
        const double from = sim->clock->time;
        status = go(&h);
        if (sim->clock->time > from) end_step(&h, status);
    }
    return finish(&h, dmb_stepping_end(sim, status, 0, report, &h.stepping), event);
}

int32_t dmb_sim_advance_to_event(dmb_sim *sim, double time, dmb_event_report *event, dmb_step_report *report)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, advance(sim, time, event, report));
}

/* ---- Equal steps ------------------------------------------------------------------------------------------------- */

static void keep_past(const hunt *h, const gaps *now)
{
    for (uint32_t i = 0; i < h->sim->scene->event_count; i++) {
        const double past[DMB_PAST_SIZE] = {h->before.value[i], h->from, now->value[i], h->sim->clock->time};
        memcpy(h->sim->event_past + DMB_PAST_SIZE * (size_t)i, past, sizeof past);
    }
}

static int32_t look_at_step(void *context)
{
    hunt *h = context;
    gaps now;
    const int32_t status = ask(h->sim, &now);
    look_first(h);
    if (status < 0) return status;
    h->reported = reported_events(h, &now, crossings(h, &now));
    h->located = h->reported != 0 ? h->sim->clock->time - h->from : 0.0;
    keep_past(h, &now);
    h->before = now;
    h->from = h->sim->clock->time;
    return h->reported != 0;
}

static int32_t steps_to_event(dmb_sim *sim, double duration, uint32_t count, uint32_t *done, dmb_event_report *event,
                              dmb_step_report *report)
{
    hunt h = {.sim = sim, .crossing = (double)NAN, .from = sim->clock->time, .equal = 1, .looks = 1};
    const dmb_step_watch watch = {look_at_step, &h};
    int32_t status = check_report(event);
    if (status >= 0) status = begin(&h);
    if (status < 0) return status;
    return finish(&h, dmb_steps_watched(sim, duration, count, done, report, &watch), event);
}

int32_t dmb_sim_steps_to_event(dmb_sim *sim, double duration, uint32_t count, uint32_t *done, dmb_event_report *event,
                               dmb_step_report *report)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, steps_to_event(sim, duration, count, done, event, report));
}
