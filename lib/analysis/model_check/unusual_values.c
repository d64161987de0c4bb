/* Warnings about values outside the range of drill pipe, holes and mud: mostly another unit, or a zero too many. */
#include <math.h>

#include "analysis/model_check/model_check.h"
#include "model/model.h"

#define DMB_WIDE_PIPE 10.0 /* [m] no pipe or hole is this wide in metres, but some are in millimetres */
#define DMB_WIDE_HOLE 20.0 /* [m] */
#define DMB_HEAVY_MUD 3e3  /* [kg/m3] weighted muds reach 2400 */

/* Receiver of the lines. */
typedef struct sink {
    const dmb_sim *sim;
    dmb_model_check_line_fn line;
    void *context;
} sink;

/* A field and the range beyond which it is warned of. */
typedef struct usual {
    const char *field, *unit; /* the unit after a blank */
    double low, high;
} usual;

static int is_within(double value, double low, double high)
{
    return value >= low && value <= high;
}

static void meant(const sink *to, const char *part, const char *field, double value, const char *unit,
                  const char *meant_unit)
{
    dmb_message text;
    dmb_message_set(&text, "%s: %s = %g %s, which is unusual; fields are in SI units, was %s meant?", part, field,
                    value, unit, meant_unit);
    to->line(to->context, text.text);
}

/* Warns of a value outside the range: without a guess at the unit, unlike `meant`. */
static void beyond(const sink *to, const char *part, const usual *of, double value)
{
    dmb_message text;
    if (is_within(value, of->low, of->high)) return;
    dmb_message_set(&text, "%s: %s = %g%s, which is unusual; usual are %g .. %g; check value and unit", part, of->field,
                    value, of->unit, of->low, of->high);
    to->line(to->context, text.text);
}

/* Stiffness: from softer than plastic to harder than steel; softer than rubber it is probably in GPa. */
static void stiffness(const sink *to, const char *part, const dmb_pipe_def *pipe)
{
    static const usual modulus = {"young_modulus", " Pa", 1e9, 1e12}, damping = {"damping_time", " s", 0.0, 0.01},
                       strength = {"yield_strength", " Pa", 5e7, 3e9};
    if (is_within(pipe->young_modulus, 30.0, 500.0))
        meant(to, part, "young_modulus", pipe->young_modulus, "Pa", "GPa");
    else
        beyond(to, part, &modulus, pipe->young_modulus);
    beyond(to, part, &damping, pipe->damping_time);
    if (pipe->yield_strength > 0.0) beyond(to, part, &strength, pipe->yield_strength);
}

/* The density of a pipe with given mass per length is not used. */
static void mass(const sink *to, const char *part, const dmb_pipe_def *pipe)
{
    static const usual density = {"density", " kg/m3", 500.0, 25e3};
    const usual eccentricity = {"eccentricity", " m", 0.0, 0.1 * pipe->outer_diameter};
    if (is_within(pipe->density, 1.2, 20.0))
        meant(to, part, "density", pipe->density, "kg/m3", "g/cm3");
    else if (pipe->section_mass == 0.0)
        beyond(to, part, &density, pipe->density);
    beyond(to, part, &eccentricity, pipe->eccentricity);
}

static void pipes(const sink *to)
{
    const dmb_list *runs = &to->sim->model->runs;
    for (uint32_t i = 0; i < runs->count; i++) {
        const dmb_pipe_run *run = DMB_LIST_AT(dmb_pipe_run, *runs, i);
        const dmb_pipe_def *pipe = &run->def;
        dmb_message name;
        dmb_pipes_text(&name, run->string, pipe);
        if (pipe->outer_diameter > DMB_WIDE_PIPE)
            meant(to, name.text, "outer_diameter", pipe->outer_diameter, "m", "mm");
        if (pipe->kind == DMB_PIPE_RIGID) continue;
        stiffness(to, name.text, pipe);
        mass(to, name.text, pipe);
    }
}

static void wall(const sink *to)
{
    static const usual at_rest = {"mu_static", "", 0.0, 1.5}, sliding = {"mu_dynamic", "", 0.0, 1.5};
    const dmb_wall_def *def = &to->sim->model->wall;
    const double diameter = 2.0 * dmb_hole_radius(&to->sim->scene->hole, 0.0);
    if (diameter > DMB_WIDE_HOLE) meant(to, "wall", "diameter", diameter, "m", "mm");
    if (def->friction_law == DMB_FRICTION_NONE) return;
    beyond(to, "wall", &at_rest, def->mu_static);
    beyond(to, "wall", &sliding, def->mu_dynamic);
}

static void mud(const sink *to)
{
    static const usual outside = {"fluid_density", " kg/m3", 0.0, DMB_HEAVY_MUD},
                       inside = {"inner_density", " kg/m3", 0.0, DMB_HEAVY_MUD};
    const dmb_environment_def *def = &to->sim->model->environment;
    beyond(to, "environment", &outside, def->fluid_density);
    if (def->inner_density >= 0.0) beyond(to, "environment", &inside, def->inner_density);
}

void dmb_unusual_values(const dmb_sim *sim, dmb_model_check_line_fn line, void *context)
{
    const sink to = {sim, line, context};
    pipes(&to);
    mud(&to);
    if (sim->scene->has_hole) wall(&to);
}
