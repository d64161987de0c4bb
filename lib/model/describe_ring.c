/* Rings on strings, as the caller gives them. */
#include "drillmbd/ring.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/limits.h"
#include "model/part_name.h"
#include "model/section.h"

DMB_DEFINE_INIT(dmb_ring_def, 96, {.fraction = 0.5, .outer_diameter = 0.09, .length = 0.3, .density = 7850.0})

/* One of the two inertias may be that of the cylinder, whose inner diameter is known when the string is: it is judged
 * with none, where its share about the axis is least. */
static void check_mass(dmb_check *check, const dmb_ring_def *def)
{
    dmb_rigid_part part;
    dmb_check_zero_or_within(check, "mass", def->mass, DMB_MASS_MIN, DMB_MASS_MAX);
    dmb_check_each_zero_or_within(check, "inertia", def->inertia, 2, DMB_INERTIA_MIN, DMB_INERTIA_MAX);
    dmb_check_within(check, "density", def->density, DMB_DENSITY_MIN, DMB_DENSITY_MAX);
    if (check->status < 0) return;
    dmb_ring_body_of(def, 0.0, &part);
    dmb_check_inertia_of_revolution(check, "inertia", part.inertia);
}

static int32_t check_ring(dmb_model *model, const dmb_ring_def *def)
{
    dmb_message part;
    dmb_check check = dmb_check_of(
        &model->message, dmb_part_text(&part, "ring", model->rings.count, def->name, sizeof def->name), DMB_NONE);
    dmb_check_part_name(&check, model, DMB_PART_RING, def->name);
    dmb_check_id_or_none(&check, model, "string", def->string, DMB_PART_STRING, "string");
    dmb_check_within(&check, "fraction", def->fraction, 0.0, 1.0);
    dmb_check_within(&check, "outer_diameter", def->outer_diameter, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    dmb_check_within(&check, "length", def->length, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    check_mass(&check, def);
    return check.status;
}

int32_t dmb_model_add_ring(dmb_model *model, const dmb_ring_def *def, dmb_id *ring)
{
    dmb_ring_def read = dmb_ring_def_default();
    int32_t status = dmb_describe_open(model, "ring", def);
    if (status < 0) return status;
    status = dmb_ring_def_read(&read, def);
    if (status >= 0) status = check_ring(model, &read);
    if (status >= 0) status = dmb_describe_append(model, &model->rings, &read, sizeof read, DMB_PART_RING, ring);
    return dmb_describe_end(model, "ring", &read, sizeof read, status);
}
