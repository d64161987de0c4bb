/* Pressures of the mud with the string's far end at any depth: circulation, and tripping with a closed end.
 *
 * A closed string that moves along at the speed v displaces v A_o into the annulus of the area A, and its surface drags
 * mud along: the pressure is that of a flow A (v A_o/A + K v) past a string at rest (eq:mud.trip). K is the mean speed,
 * over v, of the mud dragged along by the pipe surface, kappa the ratio of the diameters:
 *     laminar K = (kappa^2 - 2 kappa^2 ln kappa - 1)/(2 (1 - kappa^2) ln kappa), exact for Newtonian mud;
 *     turbulent K = (sqrt((kappa^4 + kappa)/(1 + kappa)) - kappa^2)/(1 - kappa^2)   (Burkhardt 1961). */
#include <math.h>

#include "analysis/torque_drag/soft_string.h"
#include "base/value_check.h"
#include "force/hole.h"
#include "force/mud_flow.h"
#include "math/vec3.h"
#include "model/section.h"
#include "sim/access.h"

DMB_DEFINE_INIT(dmb_hydraulics, 96, {.depth = 0.0})

#define STEP_MAX 2.0 /* [m] length with a constant hole diameter, that of its middle */
#define SPEED_MAX 10.0

typedef struct column {
    const dmb_scene *scene;
    dmb_mud_flow flow;
    double speed; /* [m/s] trip speed */
    dmb_hydraulics sum;
    double hole, pipe; /* [m] diameters of `shape` */
    dmb_annulus_shape shape;
    double last_bore; /* [m] inner diameter at the far end */
} column;

/* ---- One length of pipe in a hole of constant diameter ----------------------------------------------------------- */

/* K of the head comment, k = kappa. */
static double clinging(double k, int turbulent)
{
    const double area = (1.0 - k) * (1.0 + k), logarithm = log(k);
    if (turbulent) return (sqrt((k * k * k * k + k) / (1.0 + k)) - k * k) / area;
    return (k * k - 2.0 * k * k * logarithm - 1.0) / (2.0 * area * logarithm);
}

static void largest(double value, double *of)
{
    if (value > *of) *of = value;
}

/* Pressure loss of tripping: laminar first, with the turbulent constant above the critical Reynolds number. The limit
 * 3470 - 1370 n is that of laminar flow of a power-law mud with the exponent n (eq:mud.turbulent). */
static dmb_flow_loss trip_loss(const column *c, double pipe, double hole)
{
    const double k = pipe / hole, area = dmb_ring_area(hole, pipe), displaced = dmb_ring_area(pipe, 0.0);
    dmb_mud_flow flow = c->flow;
    flow.rate = c->speed * (displaced + clinging(k, 0) * area);
    const dmb_flow_loss laminar = dmb_annulus_loss_by(&flow, pipe, hole, &c->shape);
    if (laminar.reynolds <= 3470.0 - 1370.0 * flow.exponent) return laminar;
    flow.rate = c->speed * (displaced + clinging(k, 1) * area);
    return dmb_annulus_loss_by(&flow, pipe, hole, &c->shape);
}

static void add_length(column *c, const double diameter[2], double hole, double length)
{
    if (c->pipe != diameter[0] || c->hole != hole) {
        c->pipe = diameter[0];
        c->hole = hole;
        c->shape = dmb_annulus_shape_of(&c->flow, c->pipe / hole);
    }
    const dmb_flow_loss bore = dmb_bore_loss(&c->flow, diameter[1]);
    const dmb_flow_loss annulus = dmb_annulus_loss_by(&c->flow, diameter[0], hole, &c->shape);
    const dmb_flow_loss trip = trip_loss(c, diameter[0], hole);
    c->sum.bore_loss += length * bore.gradient;
    c->sum.annulus_loss += length * annulus.gradient;
    c->sum.trip_pressure += length * trip.gradient;
    largest(bore.reynolds, &c->sum.reynolds);
    largest(annulus.reynolds, &c->sum.reynolds);
    largest(trip.reynolds, &c->sum.reynolds);
}

/* ---- The string, from its far end upwards ------------------------------------------------------------------------ */

static void add_part(column *c, const dmb_pipe_def *pipe, int in_tool_joint, double from, double to)
{
    double diameter[2];
    if (!(to > from)) return;
    const uint32_t parts = 1 + (uint32_t)((to - from) / STEP_MAX - 1e-9);
    const double length = (to - from) / parts;
    dmb_pipe_diameters(pipe, in_tool_joint, diameter);
    if (!(c->last_bore > 0.0)) c->last_bore = diameter[1];
    for (uint32_t i = 0; i < parts; i++)
        add_length(c, diameter, 2.0 * dmb_hole_radius(&c->scene->hole, to - (i + 0.5) * length), length);
}

/* The string's lower end is at `depth`: pipes of the description from the last one on, each with its tool joint at the
 * lower end, up to the rig end. */
static void add_string(column *c, const dmb_model *model, double start, double depth)
{
    const dmb_pipe_run *runs = model->runs.items;
    double below = depth;
    for (uint32_t r = model->runs.count; r-- > 0;)
        for (uint32_t i = 0; i < runs[r].count && below > start; i++) {
            const dmb_pipe_def *pipe = &runs[r].def;
            const double joint = below - pipe->joint_length, top = below - pipe->length;
            add_part(c, pipe, 1, fmax(joint, start), below);
            add_part(c, pipe, 0, fmax(top, start), fmax(joint, start));
            below = top;
        }
}

/* ---- Query ------------------------------------------------------------------------------------------------------- */

/* [m] Vertical depth of a place of the hole below its start, along gravity; 0 without gravity. */
static double vertical_depth(const dmb_scene *scene, double start, double depth)
{
    const double g = dmb_vec3_norm(scene->gravity);
    double top[3], x[3], t[3], down[3];
    dmb_hole_frame(&scene->hole, start, top, t, NULL);
    dmb_hole_frame(&scene->hole, depth, x, t, NULL);
    dmb_vec3_sub(x, top, down);
    return g > 0.0 ? dmb_vec3_dot(scene->gravity, down) / g : 0.0;
}

/* [kg/m3] Density of a mud at rest with the same pressure (eq:mud.ecd); NaN above or at the height of the collar. */
static double equivalent(const column *c, double pressure)
{
    const double column_weight = dmb_vec3_norm(c->scene->gravity) * c->sum.vertical_depth;
    return column_weight > 0.0 ? c->flow.outside + pressure / column_weight : (double)NAN;
}

/* The pump provides the losses and, if the mud inside is lighter, the difference of the two columns
 * (eq:mud.balance). */
static void finish(column *c)
{
    dmb_hydraulics *sum = &c->sum;
    if (c->flow.open) c->flow.nozzle_area = dmb_ring_area(c->last_bore, 0.0);
    sum->bit_loss = dmb_nozzle_loss(&c->flow);
    sum->pump_pressure = sum->bore_loss + sum->bit_loss + sum->annulus_loss +
                         (c->flow.outside - c->flow.inside) * dmb_vec3_norm(c->scene->gravity) * sum->vertical_depth;
    sum->circulating_density = equivalent(c, sum->annulus_loss);
    sum->surge_density = equivalent(c, sum->trip_pressure);
    sum->swab_density = equivalent(c, -sum->trip_pressure);
}

static int32_t check_range(dmb_sim *sim, const column *c)
{
    dmb_check check = dmb_check_of(&sim->message, "hydraulics", DMB_NONE);
    if (c->sum.reynolds <= DMB_FLOW_REYNOLDS_MAX) return DMB_OK;
    dmb_check_fail(&check, DMB_ERR_VALUE, "Reynolds number", c->sum.reynolds,
                   "<= 1e6, up to which the law of friction was measured; lower the flow rate or the trip speed");
    return check.status;
}

static int32_t find(dmb_sim *sim, double depth, double trip_speed, dmb_hydraulics *answer)
{
    const dmb_scene *scene = sim->scene;
    const double start =
        scene->flow_count > 0 ? DMB_LIST_AT(const dmb_string_plan, sim->model->strings, 0)->def.start_depth : 0.0;
    dmb_check check = dmb_check_of(&sim->message, "hydraulics", DMB_NONE);
    column c = {.scene = scene, .flow = scene->flow, .speed = trip_speed};
    if (dmb_hydraulics_read(&c.sum, answer) < 0) {
        dmb_message_set(&sim->message, "hydraulics: struct_size of the result is not one of this library");
        return DMB_ERR_STRUCT_SIZE;
    }
    c.sum = dmb_hydraulics_default();
    if (scene->flow_count == 0) {
        dmb_message_set(&sim->message,
                        "hydraulics: the scene has no flow; set flow_rate, consistency and fluid_density of "
                        "the environment");
        return DMB_ERR_UNSUPPORTED;
    }
    dmb_check_between(&check, "depth", depth, start, start + scene->strings[0].length * (1.0 + 1e-9));
    dmb_check_within(&check, "trip_speed", trip_speed, 0.0, SPEED_MAX);
    if (check.status < 0) return check.status;
    c.sum.depth = depth;
    c.sum.vertical_depth = vertical_depth(scene, start, depth);
    add_string(&c, sim->model, start, depth);
    finish(&c);
    const int32_t status = check_range(sim, &c);
    return status < 0 ? status : dmb_hydraulics_write(answer, &c.sum);
}

int32_t dmb_analysis_hydraulics(dmb_sim *sim, double depth, double trip_speed, dmb_hydraulics *answer)
{
    if (sim == NULL || answer == NULL) return dmb_sim_failed(sim, "hydraulics", DMB_ERR_NULL);
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, find(sim, depth, trip_speed, answer));
}
