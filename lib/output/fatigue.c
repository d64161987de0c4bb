/* Fatigue of places during a run: stress around the section (eq:fatigue.stress), counted by rainflow, damage summed
 * with an S-N curve (eq:fatigue.damage). */
#include "output/fatigue.h"

#include <math.h>
#include <string.h>

#include "base/failure.h"
#include "base/sized_struct.h"
#include "base/value_check.h"
#include "drillmbd/ask.h"
#include "math/real.h"
#include "model/field_check.h"
#include "model/section.h"
#include "query/query.h"
#include "sim/access.h"

DMB_DEFINE_INIT(dmb_fatigue_result, 80, {.damage = 0.0})

enum { PLACES_MAX = 65536 };

/* ---- Creation ---------------------------------------------------------------------------------------------------- */

static int32_t read_options(dmb_sim *sim, const dmb_fatigue_options *given, uint32_t place_count,
                            dmb_fatigue_options *out)
{
    dmb_check check = dmb_check_of(&sim->message, "fatigue", DMB_NONE);
    dmb_options_get(&check, DMB_OPTIONS_OF(dmb_fatigue_options), given, out);
    dmb_check_count(&check, "place_count", place_count, 1, PLACES_MAX);
    return check.status;
}

/* 1 for an axial-torsional pipe in a curved hole: its rotating bending is not contained in its section force. */
static int bends_unseen(const dmb_sim *sim, dmb_place place)
{
    const dmb_scene *scene = sim->scene;
    dmb_material_point point;
    if (!scene->has_hole || dmb_hole_is_straight(&scene->hole)) return 0;
    (void)dmb_material_point_of(sim, place, &point); /* the place has a section, which has been checked */
    return scene->layout.size[scene->element_node[point.element]] == DMB_NODE_AXIAL_TORSIONAL;
}

static int32_t check_places(dmb_sim *sim, const dmb_place *places, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        dmb_section unused = dmb_section_default();
        const int32_t status = dmb_answer_section(sim, places[i], &unused);
        if (status == DMB_OK && bends_unseen(sim, places[i])) {
            dmb_message_set(&sim->message,
                            "fatigue: place %u, pipe %u: an axial-torsional pipe in a hole that bends, whose bending "
                            "it does not compute; make the pipe flexible (DMB_PIPE_FLEXIBLE)",
                            i, places[i].pipe);
            return DMB_ERR_UNSUPPORTED;
        }
        if (status == DMB_OK) continue;
        dmb_message_set(&sim->message, "fatigue: place %u, pipe %u, fraction %g: %s; name a place on a flexible pipe",
                        i, places[i].pipe, places[i].fraction, dmb_status_text(status));
        return status;
    }
    return DMB_OK;
}

/* [byte] Size of the block with all arrays; more than any block can have if the sum is too large. Summed as doubles,
 * which do not overflow: 65536 places of many points and classes exceed 32 bits. A counter keeps at most classes + 2
 * turning points that are not counted yet (rainflow.c). */
static size_t bytes_of(const dmb_fatigue_options *options, uint32_t places)
{
    const double counters = (double)places * options->points;
    const double bytes = (double)sizeof(dmb_fatigue) + places * (double)sizeof(dmb_fatigue_section) +
                         counters * ((double)sizeof(dmb_fatigue_counter) + options->classes * (double)sizeof(double) +
                                     (options->classes + 4.0) * (double)sizeof(dmb_turn)) +
                         2.0 * options->points * (double)sizeof(double);
    return (size_t)fmin(bytes, 0.75 * (double)SIZE_MAX);
}

/* Area and section modulus are those of the place, not of the pipe: in a tool joint stresses are smaller. */
static void read_section(const dmb_sim *sim, dmb_place place, dmb_fatigue_section *out)
{
    const uint32_t string = dmb_model_part_index(sim->model, place.part, DMB_PART_STRING);
    const dmb_pipe_def *def = &dmb_pipe_run_of(sim->model, string, place.pipe)->def;
    dmb_material_point point;
    double diameters[2];
    (void)dmb_material_point_of(sim, place, &point);
    dmb_pipe_diameters(def, point.beyond > 0.0, diameters);
    out->place = place;
    out->area = dmb_ring_area(diameters[0], diameters[1]);
    out->modulus = dmb_ring_second_moment(diameters[0], diameters[1]) / (0.5 * diameters[0]);
}

/* Structs first, then doubles, then turning points, which have the alignment of doubles. */
static void lay_out(dmb_fatigue *fatigue, const dmb_sim *sim, const dmb_place *places)
{
    const uint32_t points = fatigue->options.points, classes = fatigue->options.classes;
    const size_t counters = (size_t)fatigue->place_count * points;
    dmb_turn *turns;
    double *numbers;
    fatigue->sections = (dmb_fatigue_section *)(void *)(fatigue + 1);
    fatigue->counters = (dmb_fatigue_counter *)(void *)(fatigue->sections + fatigue->place_count);
    fatigue->cosine = (double *)(void *)(fatigue->counters + counters);
    fatigue->sine = fatigue->cosine + points;
    numbers = fatigue->sine + points;
    turns = (dmb_turn *)(void *)(numbers + counters * classes);
    for (uint32_t i = 0; i < fatigue->place_count; i++) read_section(sim, places[i], &fatigue->sections[i]);
    for (uint32_t k = 0; k < points; k++) {
        fatigue->cosine[k] = cos(DMB_TWO_PI * k / points);
        fatigue->sine[k] = sin(DMB_TWO_PI * k / points);
    }
    for (size_t i = 0; i < counters; i++) {
        fatigue->counters[i].cycles = numbers + i * classes;
        fatigue->counters[i].flow.turns = turns + i * (classes + 4);
        fatigue->counters[i].lowest = (double)INFINITY;
        fatigue->counters[i].highest = -(double)INFINITY;
    }
}

static int32_t create(dmb_sim *sim, const dmb_fatigue_options *given, const dmb_place *places, uint32_t place_count,
                      dmb_fatigue **out)
{
    dmb_fatigue_options options;
    dmb_fatigue *made;
    int32_t status = read_options(sim, given, place_count, &options);
    if (status >= 0) status = check_places(sim, places, place_count);
    if (status < 0) return status;
    const size_t bytes = bytes_of(&options, place_count);
    made = dmb_allocate(&sim->allocator, bytes);
    if (made == NULL) {
        dmb_message_set(&sim->message, "fatigue: no memory for %u places of %u points and %u classes; ask for fewer",
                        place_count, options.points, options.classes);
        return DMB_ERR_NO_MEMORY;
    }
    memset(made, 0, bytes);
    made->magic = DMB_HANDLE_FATIGUE;
    made->bytes = bytes;
    made->allocator = sim->allocator;
    made->options = options;
    made->place_count = place_count;
    lay_out(made, sim, places);
    *out = made;
    return DMB_OK;
}

int32_t dmb_fatigue_create(dmb_sim *sim, const dmb_fatigue_options *options, const dmb_place *places,
                           uint32_t place_count, dmb_fatigue **fatigue)
{
    if (fatigue == NULL) return dmb_sim_failed(sim, "fatigue", DMB_ERR_NULL);
    *fatigue = NULL;
    if (sim == NULL || options == NULL || places == NULL) return dmb_sim_failed(sim, "fatigue", DMB_ERR_NULL);
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, create(sim, options, places, place_count, fatigue));
}

void dmb_fatigue_destroy(dmb_fatigue **fatigue)
{
    dmb_fatigue *found;
    if (fatigue == NULL) return;
    found = *fatigue;
    *fatigue = NULL;
    if (!dmb_handle_is(found, DMB_HANDLE_FATIGUE)) return;
    const dmb_allocator allocator = found->allocator;
    found->magic = DMB_HANDLE_DEAD;
    dmb_release(&allocator, found, found->bytes);
}

/* ---- Damage ------------------------------------------------------------------------------------------------------ */

/* Damage of one cycle (eq:fatigue.damage): amplitude corrected for a tensile mean stress by Goodman's rule; 0 up to the
 * endurance limit, infinite if the mean stress reaches the tensile strength. */
static double damage_of(const dmb_fatigue_options *options, double low, double high)
{
    const double mean = 0.5 * (low + high);
    double amplitude = 0.5 * (high - low);
    if (options->tensile_strength > 0.0 && mean > 0.0)
        amplitude =
            mean < options->tensile_strength ? amplitude / (1.0 - mean / options->tensile_strength) : (double)INFINITY;
    if (!(amplitude > options->endurance)) return 0.0;
    return pow(amplitude / options->curve_stress, options->slope) / options->curve_cycles;
}

typedef struct counting {
    const dmb_fatigue_options *options;
    dmb_fatigue_counter *to;
} counting;

static void add_damage(void *context, const dmb_turn *low, const dmb_turn *high, double weight)
{
    counting *c = context;
    const uint32_t levels = high->level - low->level;
    c->to->count += weight;
    c->to->damage += weight * damage_of(c->options, low->value, high->value);
    c->to->range = fmax(c->to->range, high->value - low->value);
    if (levels > c->to->largest) c->to->largest = levels;
}

static void count_cycle(void *context, const dmb_turn *low, const dmb_turn *high, double weight)
{
    counting *c = context;
    c->to->cycles[high->level - low->level] += weight;
    add_damage(context, low, high, weight);
}

/* ---- Samples ----------------------------------------------------------------------------------------------------- */

/* Level of the stress for counting, and 1 if it is beyond the range of levels, which run from -stress_range to
 * stress_range. Equal levels are no turning point, so that noise below a class does not fill the memory. The value
 * itself is kept, so that only the order of turning points depends on levels, and damage is that of the values
 * (eq:fatigue.rainflow). */
static int read_stress(dmb_fatigue *fatigue, dmb_fatigue_counter *to, double stress)
{
    const double classes = fatigue->options.classes;
    const double level = floor((stress / fatigue->options.stress_range + 1.0) * 0.5 * classes);
    counting c = {&fatigue->options, to};
    to->lowest = fmin(to->lowest, stress);
    to->highest = fmax(to->highest, stress);
    dmb_rainflow_add(&to->flow, (uint32_t)fmin(fmax(level, 0.0), classes - 1.0), stress, count_cycle, &c);
    return !(fabs(stress) <= fatigue->options.stress_range);
}

/* Bending stress at the angle a from y to z (eq:fatigue.stress): N/A + (M_y sin a - M_z cos a) r/I. */
static void read_section_stress(dmb_fatigue *fatigue, uint32_t place, const dmb_section *loads)
{
    dmb_fatigue_section *at = &fatigue->sections[place];
    int clipped = 0;
    for (uint32_t k = 0; k < fatigue->options.points; k++) {
        const double bending = loads->force[4] * fatigue->sine[k] - loads->force[5] * fatigue->cosine[k];
        const double stress = fatigue->options.concentration * (loads->force[0] / at->area + bending / at->modulus);
        clipped |= read_stress(fatigue, &fatigue->counters[(size_t)place * fatigue->options.points + k], stress);
    }
    at->clipped += (uint64_t)clipped;
}

/* Reads all places before any is counted, so that an error at one of them changes nothing. */
static int32_t ask_all(const dmb_fatigue *fatigue, const dmb_sim *sim)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < fatigue->place_count && status >= 0; i++) {
        dmb_section loads = dmb_section_default();
        status = dmb_answer_section(sim, fatigue->sections[i].place, &loads);
        for (int k = 0; k < 6 && status >= 0; k++)
            if (!isfinite(loads.force[k])) status = DMB_ERR_NOT_FINITE;
    }
    return status;
}

/* Samples that are earlier than the last one would count the stresses in between twice. */
static int32_t check_order(const dmb_fatigue *fatigue, const dmb_sim *sim)
{
    dmb_message why;
    if (fatigue->samples == 0 || !(dmb_sim_time(sim) < fatigue->last)) return DMB_OK;
    dmb_message_set(&why,
                    "fatigue: time of the sim = %g s, must be >= %g s, that of the last sample; restore the fatigue of "
                    "that time with the sim, or create another one",
                    dmb_sim_time(sim), fatigue->last);
    return dmb_sim_fail(sim, DMB_ERR_ORDER, "fatigue", why.text);
}

int32_t dmb_fatigue_take(dmb_fatigue *fatigue, const dmb_sim *sim)
{
    int32_t status = dmb_sim_check(sim);
    if (status < 0) return dmb_sim_failed(sim, "fatigue", status);
    if (fatigue == NULL) return dmb_sim_failed(sim, "fatigue", DMB_ERR_NULL);
    if (!dmb_handle_is(fatigue, DMB_HANDLE_FATIGUE)) return dmb_sim_failed(sim, "fatigue", DMB_ERR_HANDLE);
    status = check_order(fatigue, sim);
    if (status < 0) return status;
    status = ask_all(fatigue, sim);
    if (status < 0) return dmb_sim_failed(sim, "fatigue", status);
    for (uint32_t i = 0; i < fatigue->place_count; i++) {
        dmb_section loads = dmb_section_default();
        (void)dmb_answer_section(sim, fatigue->sections[i].place, &loads);
        read_section_stress(fatigue, i, &loads);
    }
    if (fatigue->samples++ == 0) fatigue->first = dmb_sim_time(sim);
    fatigue->last = dmb_sim_time(sim);
    return DMB_OK;
}

/* ---- Results ----------------------------------------------------------------------------------------------------- */

/* Returns a copy of a counter with its residual turning points counted, as if the run ended now; its histogram is
 * unchanged. The counter itself goes on: half cycles of today may close to whole ones. */
static dmb_fatigue_counter whole(const dmb_fatigue *fatigue, uint32_t place, uint32_t point)
{
    dmb_fatigue_counter found = fatigue->counters[(size_t)place * fatigue->options.points + point];
    counting c = {&fatigue->options, &found};
    dmb_rainflow_rest(&found.flow, add_damage, &c);
    return found;
}

/* [-] Damages whose relative difference is smaller count as equal: those of two points of one circle differ by
 * rounding. */
#define DMB_DAMAGES_ALIKE 1e-9

/* Points of equal damage differ by rounding: then the one with the larger range is worse. */
static int is_worse(const dmb_fatigue_counter *a, const dmb_fatigue_counter *b)
{
    if (a->damage > b->damage * (1.0 + DMB_DAMAGES_ALIKE)) return 1;
    return !(a->damage * (1.0 + DMB_DAMAGES_ALIKE) < b->damage) && a->largest > b->largest;
}

static uint32_t worst_point(const dmb_fatigue *fatigue, uint32_t place)
{
    uint32_t worst = 0;
    dmb_fatigue_counter most = whole(fatigue, place, 0);
    for (uint32_t k = 1; k < fatigue->options.points; k++) {
        const dmb_fatigue_counter other = whole(fatigue, place, k);
        if (is_worse(&other, &most)) {
            most = other;
            worst = k;
        }
    }
    return worst;
}

static int32_t check_ask(const dmb_fatigue *fatigue, uint32_t place, const void *answer)
{
    if (fatigue == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(fatigue, DMB_HANDLE_FATIGUE)) return DMB_ERR_HANDLE;
    if (answer == NULL) return DMB_ERR_NULL;
    return place < fatigue->place_count ? DMB_OK : DMB_ERR_VALUE;
}

/* life: time until damage 1 if the run went on like this. */
int32_t dmb_fatigue_get(const dmb_fatigue *fatigue, uint32_t place, dmb_fatigue_result *result)
{
    const int32_t status = check_ask(fatigue, place, result);
    dmb_fatigue_result answer = {0};
    if (status < 0) return dmb_failed("fatigue", status);
    answer.point = worst_point(fatigue, place);
    const dmb_fatigue_counter found = whole(fatigue, place, answer.point);
    answer.samples = fatigue->samples;
    answer.clipped = fatigue->sections[place].clipped;
    answer.damage = found.damage;
    answer.cycles = found.count;
    answer.largest_range = found.range;
    answer.lowest = fatigue->samples > 0 ? found.lowest : 0.0;
    answer.highest = fatigue->samples > 0 ? found.highest : 0.0;
    answer.time = fatigue->last - fatigue->first;
    answer.life = found.damage > 0.0 ? answer.time / found.damage : (double)INFINITY;
    return dmb_failed("fatigue", dmb_fatigue_result_write(result, &answer));
}

static void add_to_histogram(void *context, const dmb_turn *low, const dmb_turn *high, double weight)
{
    ((double *)context)[high->level - low->level] += weight;
}

int32_t dmb_fatigue_histogram(const dmb_fatigue *fatigue, uint32_t place, double *cycles)
{
    const int32_t status = check_ask(fatigue, place, cycles);
    const dmb_fatigue_counter *at;
    if (status < 0) return dmb_failed("fatigue", status);
    at = &fatigue->counters[(size_t)place * fatigue->options.points + worst_point(fatigue, place)];
    memcpy(cycles, at->cycles, fatigue->options.classes * sizeof(double));
    dmb_rainflow_rest(&at->flow, add_to_histogram, cycles);
    return DMB_OK;
}
