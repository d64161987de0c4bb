/* Torque and drag of the soft string (eq:drilling.soft-string): rows of operations and depths (a broomstick plot has
 * one operation at many depths), profile of one operation along the string, friction factor from a measurement. All
 * three integrate from the far end to the rig (soft_string.c), with the string's lower end at the requested depth. The
 * sim contributes model and present mud flow, not its state. */
#include <math.h>
#include <string.h>

#include "analysis/torque_drag/soft_string.h"
#include "base/failure.h"
#include "base/memory.h"
#include "base/value_check.h"
#include "model/field_check.h"
#include "model/section.h"
#include "query/query.h"
#include "sim/access.h"

DMB_DEFINE_INIT(dmb_operation, 40, {.axial_speed = 0.0})
DMB_DEFINE_INIT(dmb_torque_drag_row, 128, {.locked = 0})

enum { DEPTHS_MAX = 1 << 20, OPERATIONS_MAX = 4096, OPERATIONS = DMB_OPERATION_BACK_REAM + 1 };

/* Speeds [m/s, rad/s], downwards positive. Only their ratio matters for the soft string, which shares one friction
 * force in that ratio: the usual values stand for "much faster along than around" and the like. */
int32_t dmb_operation_usual(int32_t operation, dmb_operation *out)
{
    static const double usual[OPERATIONS][2] = {
        [DMB_OPERATION_PICK_UP] = {-0.1, 0.0},      [DMB_OPERATION_SLACK_OFF] = {0.1, 0.0},
        [DMB_OPERATION_ROTATE] = {0.0, DMB_TWO_PI}, [DMB_OPERATION_DRILL] = {0.005, DMB_TWO_PI},
        [DMB_OPERATION_SLIDE] = {0.005, 0.0},       [DMB_OPERATION_BACK_REAM] = {-0.1, DMB_TWO_PI},
    };
    dmb_operation answer = dmb_operation_default();
    if (out == NULL) return dmb_failed("operation", DMB_ERR_NULL);
    if (operation < 0 || operation >= OPERATIONS) return dmb_failed("operation", DMB_ERR_VALUE);
    answer.axial_speed = usual[operation][0];
    answer.rotary_speed = usual[operation][1];
    return dmb_failed("operation", dmb_operation_write(out, &answer));
}

const char *dmb_operation_name(int32_t operation)
{
    static const char *const names[OPERATIONS] = {
        [DMB_OPERATION_PICK_UP] = "pick-up", [DMB_OPERATION_SLACK_OFF] = "slack-off",
        [DMB_OPERATION_ROTATE] = "rotate",   [DMB_OPERATION_DRILL] = "drill",
        [DMB_OPERATION_SLIDE] = "slide",     [DMB_OPERATION_BACK_REAM] = "back-ream",
    };
    return operation >= 0 && operation < OPERATIONS ? names[operation] : NULL;
}

/* ---- String and options ------------------------------------------------------------------------------------------ */

typedef struct request {
    dmb_sim *sim;
    dmb_torque_drag_options options;
    dmb_soft_string soft;
    double described; /* [m] measured depth of the far end in the description */
} request;

/* [kg] Mass of bodies and bits attached to the far end, less the displaced mud. */
static double end_mass(const dmb_model *model, uint32_t string, double density)
{
    const dmb_body_def *bodies = model->bodies.items;
    const dmb_bit_def *bits = model->bits.items;
    double mass = 0.0;
    for (uint32_t i = 0; i < model->bodies.count + model->bits.count; i++)
        if (dmb_body_is_at_end(model, i, string, DMB_ATTACH_END))
            mass += i < model->bodies.count
                        ? bodies[i].mass - density * bodies[i].displaced_volume
                        : bits[i - model->bodies.count].mass - density * bits[i - model->bodies.count].displaced_volume;
    return mass;
}

static int32_t refuse(request *r, int32_t status, const char *text)
{
    dmb_message_set(&r->sim->message, "torque and drag: %s", text);
    return status;
}

static int32_t find_string(request *r)
{
    const dmb_model *model = r->sim->model;
    const dmb_scene *scene = r->sim->scene;
    const dmb_string_plan *plans = model->strings.items;
    dmb_soft_string *soft = &r->soft;
    const dmb_id named = r->options.string;
    soft->string = named.generation == 0 ? 0 : dmb_model_part_index(model, named, DMB_PART_STRING);
    if (soft->string >= scene->string_count)
        return refuse(r, DMB_ERR_ID, "`string` does not name a string of the model");
    if (!scene->has_hole) return refuse(r, DMB_ERR_UNSUPPORTED, "the model has no hole; add a wall");
    const char *lacking = dmb_soft_string_lacks(model, scene, soft->string);
    if (lacking != NULL) return refuse(r, DMB_ERR_UNSUPPORTED, lacking);
    soft->model = model;
    soft->mud = dmb_mud_of(r->sim->scene);
    soft->flow = scene->flow_count > 0 ? &scene->flow : NULL;
    soft->hole = &scene->hole;
    dmb_vec3_copy(scene->gravity, soft->gravity);
    soft->start = plans[soft->string].def.start_depth;
    soft->length = scene->strings[soft->string].length;
    soft->end_mass = end_mass(model, soft->string, soft->mud.outside);
    r->described = soft->start + soft->length;
    return DMB_OK;
}

/* The string may be pulled out to any depth of its description, not run in further: pipes below the described end are
 * unknown. */
static int32_t check_depths(request *r)
{
    const double slack = 1e-9 * r->soft.length;
    for (uint32_t i = 0; r->options.depths != NULL && i < r->options.depth_count; i++) {
        dmb_check check = dmb_check_of(&r->sim->message, "torque and drag: depth", i);
        dmb_check_between(&check, "depths", r->options.depths[i], r->soft.start, r->described + slack);
        if (check.status < 0) return check.status;
    }
    return DMB_OK;
}

/* friction >= 0 is the coefficient itself; a negative one means that of the wall, by depth, with a factor of 1. */
static int32_t read_options(request *r, const dmb_torque_drag_options *given)
{
    dmb_check check = dmb_check_of(&r->sim->message, "torque and drag options", DMB_NONE);
    dmb_torque_drag_options *options = &r->options;
    dmb_options_get(&check, DMB_OPTIONS_OF(dmb_torque_drag_options), given, options);
    dmb_check_count(&check, "depth_count", options->depth_count, 1, options->depths != NULL ? DEPTHS_MAX : 1);
    if (check.status < 0) return check.status;
    const int32_t status = find_string(r);
    if (status < 0) return status;
    r->soft.post_buckling = options->post_buckling;
    r->soft.wall_friction = r->sim->scene->friction_law.mu_dynamic;
    r->soft.by_depth = options->friction < 0.0;
    r->soft.friction = options->friction >= 0.0                                ? options->friction
                       : r->sim->scene->friction_law.kind == DMB_FRICTION_NONE ? 0.0
                                                                               : 1.0;
    return check_depths(r);
}

static double depth_of(const request *r, uint32_t i)
{
    return r->options.depths != NULL ? fmin(r->options.depths[i], r->described) : r->described;
}

/* Operation i of the caller's array, whose stride is the struct_size of the first item. */
static int32_t read_operation(request *r, const dmb_operation *operations, uint32_t i, dmb_operation *out)
{
    dmb_check check = dmb_check_of(&r->sim->message, "torque and drag: operation", i);
    const unsigned char *item = (const unsigned char *)operations + (size_t)i * operations->struct_size;
    uint32_t size;
    memcpy(&size, item, sizeof size);
    if (size != operations->struct_size || dmb_operation_read(out, item) < 0)
        return refuse(r, DMB_ERR_STRUCT_SIZE,
                      "struct_size of an operation is not one of this library, or not that of the first");
    dmb_check_within(&check, "axial_speed", out->axial_speed, -DMB_SPEED_MAX, DMB_SPEED_MAX);
    dmb_check_within(&check, "rotary_speed", out->rotary_speed, -DMB_SPEED_MAX, DMB_SPEED_MAX);
    dmb_check_within(&check, "weight_on_bit", out->weight_on_bit, -DMB_FORCE_MAX, DMB_FORCE_MAX);
    dmb_check_within(&check, "torque_on_bit", out->torque_on_bit, 0.0, DMB_FORCE_MAX);
    return check.status;
}

/* ---- Rows -------------------------------------------------------------------------------------------------------- */

/* The largest of those up to now; NaN once one is. Comparisons with NaN raise no exception. */
static void keep_largest(double value, double depth, double *largest, double *at)
{
    if (!isgreater(value, *largest) && !isnan(value)) return;
    *largest = value;
    if (at != NULL) *at = depth;
}

/* Von Mises stress (eq:drilling.von-mises) over the yield strength, with the bending moment of
 * eq:drilling.bending. */
static double yield_share(const dmb_soft_place *place)
{
    const dmb_pipe_def *pipe = place->pipe;
    dmb_pipe_section section;
    dmb_section_of(pipe, &section);
    return dmb_tube_von_mises(
               pipe->outer_diameter, pipe->inner_diameter, place->state[DMB_SOFT_FORCE], place->state[DMB_SOFT_TORQUE],
               fmax(section.stiffness[4], section.stiffness[5]) * dmb_body_curvature(pipe, place->curvature)) /
           (pipe->yield_strength > 0.0 ? pipe->yield_strength : (double)NAN);
}

/* Extremes along the string, and the state at the place visited last, which is the rig end. NaN (no closed form there)
 * is kept: a share must not look small because it was not computed. transfer is the reciprocal of dN(0)/dN(L)
 * (eq:drilling.transmission). */
static void visit_row(void *context, const dmb_soft_place *place)
{
    dmb_torque_drag_row *row = context;
    const double N = place->state[DMB_SOFT_FORCE];
    if (!(N >= row->lowest_force)) {
        row->lowest_force = N;
        row->lowest_at = place->depth;
    }
    keep_largest(place->helical, place->depth, &row->helical_share, &row->buckled_at);
    keep_largest(place->sinusoidal, place->depth, &row->sinusoidal_share, NULL);
    if (isnan(place->helical)) row->helical_share = row->sinusoidal_share = (double)NAN;
    if (!isnan(row->yield_share)) keep_largest(yield_share(place), place->depth, &row->yield_share, &row->yield_at);
    if (!islessequal(place->helical, 1.0)) row->helix_length += place->step;
    row->hook_load = N;
    row->torque = place->state[DMB_SOFT_TORQUE];
    row->transfer = 1.0 / place->state[DMB_SOFT_GROWTH];
    row->stretch = place->state[DMB_SOFT_STRETCH];
    row->wind_up = place->state[DMB_SOFT_WIND_UP];
    row->wall_force = place->state[DMB_SOFT_WALL];
}

/* A string that locks up has no readings, but its depth, and no part of a further push arrives at the bit: transfer
 * 0. */
static void lock(dmb_torque_drag_row *row)
{
    const double depth = row->depth;
    double *values = &row->depth;
    for (size_t i = 0; i < (sizeof *row - offsetof(dmb_torque_drag_row, depth)) / sizeof(double); i++)
        values[i] = (double)NAN;
    row->depth = depth;
    row->transfer = 0.0;
    row->locked = 1;
}

static dmb_torque_drag_row row_of(const dmb_soft_string *soft, const dmb_operation *operation, double depth)
{
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    row.depth = depth;
    row.lowest_force = (double)INFINITY;
    row.buckled_at = row.yield_at = depth;
    if (!dmb_soft_string_march(soft, operation, depth, 0.0, visit_row, &row)) lock(&row);
    return row;
}

static void write_row(dmb_torque_drag_row *rows, size_t i, const dmb_torque_drag_row *row)
{
    const uint32_t stride = rows->struct_size;
    unsigned char *to = (unsigned char *)rows + stride * i;
    memcpy(to, &stride, sizeof stride);
    (void)dmb_torque_drag_row_write(to, row);
}

/* Computes all rows before the first is written, so that a cancelled call writes none. */
static int32_t make_rows(request *r, const dmb_operation *operations, uint32_t count, dmb_torque_drag_row *rows)
{
    const uint32_t depths = r->options.depth_count;
    dmb_torque_drag_row *made = dmb_allocate_array(&r->sim->allocator, (size_t)depths * count, sizeof *made);
    int32_t status = DMB_OK;
    if (made == NULL) return refuse(r, DMB_ERR_NO_MEMORY, "no memory for the rows");
    for (uint32_t i = 0; i < depths && status >= 0; i++) {
        dmb_progress_at(r->sim, (double)i / depths);
        status = dmb_progress_pulse(r->sim);
        for (uint32_t k = 0; k < count && status >= 0; k++) {
            dmb_operation operation;
            (void)read_operation(r, operations, k, &operation);
            made[(size_t)i * count + k] = row_of(&r->soft, &operation, depth_of(r, i));
        }
    }
    for (size_t i = 0; i < (size_t)depths * count && status >= 0; i++) write_row(rows, i, made + i);
    dmb_release(&r->sim->allocator, made, (size_t)depths * count * sizeof *made);
    return status;
}

static int32_t analyse(request *r, const dmb_torque_drag_options *options, const dmb_operation *operations,
                       uint32_t count, dmb_torque_drag_row *rows)
{
    dmb_check check = dmb_check_of(&r->sim->message, "torque and drag", DMB_NONE);
    dmb_torque_drag_row unused;
    dmb_operation operation;
    int32_t status = read_options(r, options);
    if (status < 0) return status;
    if (dmb_torque_drag_row_read(&unused, rows) < 0)
        return refuse(r, DMB_ERR_STRUCT_SIZE, "struct_size of the rows is not one of this library");
    dmb_check_count(&check, "operation_count", count, 1, OPERATIONS_MAX);
    if (check.status < 0) return check.status;
    for (uint32_t k = 0; k < count && status >= 0; k++) status = read_operation(r, operations, k, &operation);
    return status < 0 ? status : make_rows(r, operations, count, rows);
}

int32_t dmb_analysis_torque_drag(dmb_sim *sim, const dmb_torque_drag_options *options, const dmb_operation *operations,
                                 uint32_t operation_count, dmb_torque_drag_row *rows)
{
    request r = {.sim = sim};
    if (sim == NULL || operations == NULL || rows == NULL) return dmb_sim_failed(sim, "torque drag", DMB_ERR_NULL);
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, analyse(&r, options, operations, operation_count, rows));
}

/* ---- Profile of one operation along the string ------------------------------------------------------------------- */

/* Places are visited from the far end; stations are counted from the rig end. */
typedef struct sampling {
    double *depth, *axial_force, *torque, *wall_force;
    double start, spacing;
    uint32_t next; /* index of the next station plus 1 */
} sampling;

static void put(double *values, uint32_t i, double value)
{
    if (values != NULL) values[i] = value;
}

/* The march stops at every station, apart from rounding; the first place at or above a station is its value, on the
 * deeper side of a jump. */
static void visit_station(void *context, const dmb_soft_place *place)
{
    sampling *s = context;
    if (s->next == 0 || place->depth > s->start + s->spacing * (s->next - 1.0) + 1e-8 * s->spacing) return;
    s->next--;
    put(s->depth, s->next, place->depth);
    put(s->axial_force, s->next, place->state[DMB_SOFT_FORCE]);
    put(s->torque, s->next, place->state[DMB_SOFT_TORQUE]);
    put(s->wall_force, s->next, place->wall);
}

static void visit_nothing(void *context, const dmb_soft_place *place)
{
    (void)context;
    (void)place;
}

/* The first march only finds out whether the string locks up, so that a failing call writes nothing. */
static int32_t sample(request *r, const dmb_torque_drag_options *options, const dmb_operation *given, uint32_t count,
                      sampling *s)
{
    dmb_check check = dmb_check_of(&r->sim->message, "torque and drag profile", DMB_NONE);
    dmb_operation operation;
    int32_t status = read_options(r, options);
    if (status >= 0) status = read_operation(r, given, 0, &operation);
    if (status < 0) return status;
    dmb_check_count(&check, "station_count", count, 2, DEPTHS_MAX);
    if (check.status < 0) return check.status;
    s->start = r->soft.start;
    s->spacing = (depth_of(r, 0) - s->start) / (count - 1.0);
    s->next = count;
    if (!dmb_soft_string_march(&r->soft, &operation, depth_of(r, 0), s->spacing, visit_nothing, NULL))
        return refuse(
            r, DMB_ERR_NO_CONVERGENCE,
            "the string locks up: no push at the rig does this operation; ask for less weight on bit or depth");
    (void)dmb_soft_string_march(&r->soft, &operation, depth_of(r, 0), s->spacing, visit_station, s);
    return DMB_OK;
}

int32_t dmb_analysis_torque_drag_profile(dmb_sim *sim, const dmb_torque_drag_options *options,
                                         const dmb_operation *operation, uint32_t station_count, double *depth,
                                         double *axial_force, double *torque, double *wall_force)
{
    request r = {.sim = sim};
    sampling s = {.depth = depth, .axial_force = axial_force, .torque = torque, .wall_force = wall_force};
    if (sim == NULL || operation == NULL) return dmb_sim_failed(sim, "torque drag profile", DMB_ERR_NULL);
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, sample(&r, options, operation, station_count, &s));
}

/* ---- Friction from a measurement --------------------------------------------------------------------------------- */

typedef struct fitting {
    request *r;
    dmb_operation operation;
    int32_t measured;
    double value;
} fitting;

/* Computed less measured quantity for a friction coefficient [N or N m]; infinite if the string locks up. */
static double misses_by(fitting *f, double friction)
{
    dmb_torque_drag_row row;
    f->r->soft.friction = friction;
    row = row_of(&f->r->soft, &f->operation, depth_of(f->r, 0));
    if (row.locked) return f->measured == DMB_MEASURED_HOOK_LOAD ? -(double)INFINITY : (double)INFINITY;
    return (f->measured == DMB_MEASURED_HOOK_LOAD ? row.hook_load : row.torque) - f->value;
}

/* Bisection: hook load and torque are monotonic in the coefficient, so that the values at 0 and at the largest
 * coefficient enclose the measured one or there is no solution. 60 halvings exhaust the digits. A string that locks up
 * is beyond every measured value: hook load minus, torque plus infinity. */
static int32_t bisect(fitting *f, double *friction)
{
    double low = 0.0, high = DMB_FRICTION_MAX;
    const double at_low = misses_by(f, low), at_high = misses_by(f, high);
    if (!((at_low <= 0.0 && at_high >= 0.0) || (at_low >= 0.0 && at_high <= 0.0)) || at_low == at_high) {
        dmb_message_set(
            &f->r->sim->message,
            "friction factor: measured value = %g, must be between %g (friction 0) and %g (friction %g); look at "
            "its sign, the operation and the weights",
            f->value, at_low + f->value, at_high + f->value, DMB_FRICTION_MAX);
        return DMB_ERR_VALUE;
    }
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        if ((misses_by(f, middle) > 0.0) == (at_high > at_low))
            high = middle;
        else
            low = middle;
    }
    *friction = 0.5 * (low + high);
    return DMB_OK;
}

/* With friction_by_depth the answer is a factor to the coefficients of the wall by depth, else one coefficient for the
 * whole hole. */
static int32_t fit(fitting *f, const dmb_torque_drag_options *options, const dmb_operation *operation, double *friction)
{
    dmb_check check = dmb_check_of(&f->r->sim->message, "friction factor", DMB_NONE);
    int32_t status = read_options(f->r, options);
    if (status >= 0) status = read_operation(f->r, operation, 0, &f->operation);
    if (status < 0) return status;
    f->r->soft.by_depth = f->r->options.friction_by_depth;
    dmb_check_choice(&check, "measured", f->measured, DMB_MEASURED_HOOK_LOAD, DMB_MEASURED_TORQUE);
    dmb_check_finite(&check, "value", f->value);
    return check.status < 0 ? check.status : bisect(f, friction);
}

int32_t dmb_analysis_friction_factor(dmb_sim *sim, const dmb_torque_drag_options *options,
                                     const dmb_operation *operation, int32_t measured, double value, double *friction)
{
    request r = {.sim = sim};
    fitting f = {.r = &r, .measured = measured, .value = value};
    if (sim == NULL || operation == NULL || friction == NULL)
        return dmb_sim_failed(sim, "friction factor", DMB_ERR_NULL);
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, fit(&f, options, operation, friction));
}
