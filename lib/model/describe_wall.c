#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "drillmbd/scene.h"
#include "force/friction_law.h"
#include "force/mud_flow.h"
#include "math/real.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/model.h"

enum { CUTS_MAX = 1 << 18 };

static const double rounding = 1e-9; /* [rad] a survey's last digits may lie beyond the bounds */

/* Beyond its bounds an angle has no meaning of its own; a survey in degrees is the likely cause. */
static void check_angle(dmb_check *check, uint32_t station, const char *name, double angle, double low, double high)
{
    if (check->status < 0 || (angle >= low - rounding && angle <= high + rounding)) return;
    check->status = isfinite(angle) ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE;
    dmb_message_set(check->message,
                    "wall, station %u: %s = %g rad, must be in [%g, %g] rad; a survey in degrees is given times pi/180",
                    station, name, angle, low, high);
}

static void check_survey(dmb_check *check, dmb_message *message, const dmb_wall_def *def)
{
    dmb_check station;
    dmb_check_pointer(check, "survey", def->survey);
    for (uint32_t i = 0; i < def->survey_count && check->status == DMB_OK; ++i) {
        const double *row = def->survey + 3 * (size_t)i;
        station = dmb_check_of(message, "wall, station", i);
        dmb_check_within(&station, "measured depth", row[0], -DMB_POSITION_MAX, DMB_POSITION_MAX);
        check_angle(&station, i, "inclination", row[1], 0.0, DMB_PI);
        check_angle(&station, i, "azimuth", row[2], -DMB_TWO_PI, DMB_TWO_PI);
        /* closer than that, the curvature between two stations has no meaning */
        if (i > 0) dmb_check_at_least(&station, "measured depth", row[0], row[-3] + DMB_LENGTH_MIN);
        check->status = station.status;
    }
}

static void check_direction(dmb_check *check, const dmb_wall_def *def)
{
    const double *d = def->direction;
    if (fabs(d[0]) > 0.0 || fabs(d[1]) > 0.0 || fabs(d[2]) > 0.0) return;
    dmb_check_fail(check, DMB_ERR_VALUE, "direction", 0.0, "of length > 0");
}

/* Bounds between two fields are asked for only where the law uses both. */
static void check_laws(dmb_check *check, const dmb_wall_def *def)
{
    const int32_t law = def->friction_law;
    if (def->normal_law == DMB_NORMAL_FLORES)
        dmb_check_above(check, "restitution", def->restitution, 0.0); /* its mu is like 1/e */
    if (def->friction_table_count == 0 && dmb_friction_has_static(law))
        dmb_check_at_least_field(check, "mu_static", def->mu_static, "mu_dynamic", def->mu_dynamic);
    if (check->status >= 0 && (law == DMB_FRICTION_CALLBACK) != (def->friction_callback != NULL))
        dmb_check_fail(check, DMB_ERR_NULL, "friction_law", law,
                       "DMB_FRICTION_CALLBACK with a friction_callback, or another law without one");
    if (law != DMB_FRICTION_CALLBACK && def->friction_state_count != 0)
        dmb_check_fail(check, DMB_ERR_VALUE, "friction_state_count", def->friction_state_count,
                       "0 without friction_callback");
    if (check->status >= 0 && law != DMB_FRICTION_CALLBACK && def->friction_accept != NULL)
        dmb_check_fail(check, DMB_ERR_UNSUPPORTED, "friction_law", law, "DMB_FRICTION_CALLBACK with a friction_accept");
    if (law == DMB_FRICTION_AMBROSIO)
        dmb_check_above_field(check, "full_speed", def->full_speed, "smoothing_speed", def->smoothing_speed);
}

/* The table of the coefficient against the speed. */
static void check_friction_table(dmb_check *check, const dmb_wall_def *def)
{
    const uint32_t n = def->friction_table_count;
    if (check->status < 0 || n == 0) return;
    dmb_check_increasing(check, "friction_table_speed", def->friction_table_speed, n, 1);
    if (check->status < 0) return;
    dmb_check_within(check, "friction_table_speed[0]", def->friction_table_speed[0], 0.0, 0.0);
    for (uint32_t i = 1; i < n && check->status >= 0; ++i)
        if (def->friction_table_speed[i] - def->friction_table_speed[i - 1] < DMB_SPEED_MIN)
            dmb_check_fail(check, DMB_ERR_VALUE, "friction_table_speed", def->friction_table_speed[i],
                           "> the one before, by 1e-12");
    dmb_check_within(check, "friction_table_mu (the last one)", def->friction_table_mu[n - 1], DMB_NUMBER_MIN,
                     DMB_NUMBER_MAX);
    if (check->status < 0 || dmb_friction_has_static(def->friction_law)) return;
    dmb_check_fail(check, DMB_ERR_UNSUPPORTED, "friction_law", def->friction_law,
                   "DMB_FRICTION_STRIBECK or DMB_FRICTION_BRISTLE with friction_table_count > 0");
}

/* At least four stations: those at both ends are never cut. */
static void check_cuts(dmb_check *check, const dmb_wall_def *def)
{
    if (check->status < 0 || !(def->cut_spacing > 0.0)) return;
    dmb_check_at_least(check, "cut_end", def->cut_end, def->cut_start + 3.0 * def->cut_spacing);
    if (check->status < 0 || def->cut_end - def->cut_start <= (CUTS_MAX - 1) * def->cut_spacing) return;
    dmb_check_fail(check, DMB_ERR_TOO_LARGE, "(cut_end - cut_start)/cut_spacing",
                   (def->cut_end - def->cut_start) / def->cut_spacing,
                   "<= 262143; give a larger spacing or a shorter part");
}

/* The ends of a table are the coefficients at rest and in fast sliding. */
static void take_friction_table(dmb_wall_def *def)
{
    if (def->friction_table_count == 0) return;
    def->mu_static = def->friction_table_mu[0];
    def->mu_dynamic = def->friction_table_mu[def->friction_table_count - 1];
}

static int32_t check_wall(dmb_model *model, dmb_wall_def *def)
{
    dmb_check check = dmb_check_of(&model->message, "wall", DMB_NONE);
    dmb_check_fields(&check, model, DMB_FIELDS_OF(dmb_wall_def), def);
    if (check.status < 0) return check.status;
    take_friction_table(def);
    check_direction(&check, def);
    check_laws(&check, def);
    check_friction_table(&check, def);
    check_cuts(&check, def);
    if (def->survey_count != 0) check_survey(&check, &model->message, def);
    return check.status;
}

static size_t survey_size(const dmb_wall_def *wall)
{
    return 3 * (size_t)wall->survey_count * sizeof(double);
}

/* The caller's survey gives way to the model's own copy. */
static int32_t copy_survey(dmb_wall_def *wall, const dmb_allocator *allocator)
{
    double *copy;
    if (wall->survey_count == 0) {
        wall->survey = NULL;
        return DMB_OK;
    }
    copy = dmb_allocate(allocator, survey_size(wall));
    if (copy == NULL) return DMB_ERR_NO_MEMORY;
    memcpy(copy, wall->survey, survey_size(wall));
    wall->survey = copy;
    return DMB_OK;
}

void dmb_wall_release(dmb_wall_def *wall, const dmb_allocator *allocator)
{
    void *block;
    memcpy(&block, &wall->survey, sizeof block); /* the model owns what others may only read */
    dmb_release(allocator, block, survey_size(wall));
    wall->survey = NULL;
}

int32_t dmb_model_add_wall(dmb_model *model, const dmb_wall_def *def, dmb_id *wall)
{
    dmb_wall_def read = dmb_wall_def_default();
    int32_t status = dmb_describe_open(model, "wall", def);
    if (status < 0) return status;
    if (model->wall_count > 0) {
        dmb_message_set(&model->message, "wall: the model has one already, must be one hole a model");
        return dmb_describe_end(model, "wall", NULL, 0, DMB_ERR_ORDER);
    }
    if (model->placed_without_hole) {
        dmb_message_set(
            &model->message,
            "wall: a sub was placed behind a string that follows the hole, must come after the hole; add the "
            "wall first, or give the string follows_hole = 0");
        return dmb_describe_end(model, "wall", NULL, 0, DMB_ERR_ORDER);
    }
    status = dmb_wall_def_read(&read, def);
    if (status >= 0) status = check_wall(model, &read);
    if (status >= 0) status = copy_survey(&read, &model->allocator);
    if (status >= 0) {
        model->wall = read;
        model->wall_count = 1;
        if (wall != NULL) *wall = dmb_model_id(model, DMB_PART_WALL, 0);
    }
    return dmb_describe_end(model, "wall", NULL, 0, status);
}

/* Gravity, fluid and external damping. */

/* mesh_flow looks at what the scene must be for it. */
static void check_flow(dmb_check *check, const dmb_environment_def *def)
{
    if (check->status >= 0 && def->flow_eccentricity > 0.0)
        dmb_check_within(check, "flow_exponent", def->flow_exponent, DMB_FLOW_ECCENTRIC_EXPONENT,
                         DMB_FLOW_EXPONENT_MAX);
    if (check->status >= 0 && def->flow_eccentricity > 0.0 && def->yield_stress > 0.0)
        dmb_check_fail(check, DMB_ERR_UNSUPPORTED, "yield_stress", def->yield_stress,
                       "0 with a flow_eccentricity, whose law is that of the power law");
    if (check->status >= 0 && def->flow_rate > 0.0 && !(def->consistency > 0.0))
        dmb_check_fail(check, DMB_ERR_VALUE, "consistency", def->consistency, "> 0 with a flow_rate");
    if (check->status >= 0 && def->flow_rate > 0.0 && !(def->fluid_density > 0.0))
        dmb_check_fail(check, DMB_ERR_VALUE, "fluid_density", def->fluid_density, "> 0 with a flow_rate");
    if (check->status >= 0 && def->flow_rate > 0.0 && def->inner_density >= 0.0 && !(def->inner_density > 0.0))
        dmb_check_fail(check, DMB_ERR_VALUE, "inner_density", def->inner_density, "> 0 with a flow_rate, or -1");
}

static int32_t check_environment(dmb_model *model, const dmb_environment_def *def)
{
    dmb_check check = dmb_check_of(&model->message, "environment", DMB_NONE);
    dmb_check_fields(&check, model, DMB_FIELDS_OF(dmb_environment_def), def);
    check_flow(&check, def);
    return check.status;
}

int32_t dmb_model_set_environment(dmb_model *model, const dmb_environment_def *def)
{
    dmb_environment_def read;
    int32_t status = dmb_describe_open(model, "environment", def);
    if (status < 0) return status;
    status = dmb_environment_def_read(&read, def);
    if (status >= 0) status = check_environment(model, &read);
    if (status >= 0) model->environment = read;
    return dmb_describe_end(model, "environment", NULL, 0, status);
}

/* ---- Sections of the hole ---------------------------------------------------------------------------------------- */

enum { SECTIONS_MAX = 1 << 18 };

/* Sections stand one after the other, as far apart as the first one says. All say the same. */
static int32_t read_section(const dmb_hole_section *sections, uint32_t i, dmb_hole_section *out)
{
    const unsigned char *item = (const unsigned char *)sections + (size_t)i * sections->struct_size;
    uint32_t size;
    memcpy(&size, item, sizeof size);
    *out = dmb_hole_section_default();
    return size == sections->struct_size ? dmb_hole_section_read(out, item) : DMB_ERR_STRUCT_SIZE;
}

static int32_t check_sections(dmb_model *model, const dmb_hole_section *sections, uint32_t count)
{
    const uint32_t before = model->sections.count;
    double above = before > 0 ? DMB_LIST_AT(const dmb_hole_section, model->sections, before - 1)->depth : 0.0;
    for (uint32_t i = 0; i < count; i++) {
        dmb_hole_section read;
        dmb_check check = dmb_check_of(&model->message, "hole section", before + i);
        const int32_t status = read_section(sections, i, &read);
        if (status < 0) return status;
        dmb_check_fields(&check, model, DMB_FIELDS_OF(dmb_hole_section), &read);
        if (before + i > 0) dmb_check_at_least(&check, "depth", read.depth, above + DMB_LENGTH_MIN);
        if (check.status < 0) return check.status;
        above = read.depth;
    }
    return DMB_OK;
}

static int32_t append_sections(dmb_model *model, const dmb_hole_section *sections, uint32_t count)
{
    const uint32_t before = model->sections.count;
    for (uint32_t i = 0; i < count; i++) {
        dmb_hole_section read;
        (void)read_section(sections, i, &read);
        const int32_t status = dmb_list_append(&model->sections, &model->allocator, &read, sizeof read);
        if (status >= 0) continue;
        model->sections.count = before;
        return status;
    }
    return DMB_OK;
}

int32_t dmb_model_add_hole_sections(dmb_model *model, const dmb_hole_section *sections, uint32_t count)
{
    dmb_hole_section first = dmb_hole_section_default();
    const dmb_described given = {"hole sections", &first, sizeof first, count};
    int32_t status = dmb_describe_open(model, "hole sections", sections);
    if (status < 0) return status;
    dmb_check check = dmb_check_of(&model->message, "hole sections", DMB_NONE);
    dmb_check_count(&check, "count", count, 1, SECTIONS_MAX - model->sections.count);
    status = check.status;
    if (status >= 0) status = read_section(sections, 0, &first);
    if (status >= 0) status = check_sections(model, sections, count);
    if (status >= 0) status = append_sections(model, sections, count);
    return dmb_describe_part(model, &given, status);
}
