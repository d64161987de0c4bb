/* Perturbed states y +- step dy/dp: their fields, how they are read and set. The state as one array of numbers is the
 * list of fields of sim/sim.h in its order: configuration, then memory; fields that are no numbers (contact segments,
 * flags) are taken from the sim, the partition is that of the factors. */
#include "analysis/sensitivity/sensitivity.h"

#include <math.h>
#include <string.h>

#include "base/sized_struct.h"
#include "sim/own_scene.h"
#include "system/constrain/constrain.h"
#include "system/system.h"

void dmb_state_fields_of(const dmb_sim *sim, int32_t group, dmb_state_fields *of)
{
    dmb_field memory[DMB_FIELD_MAX];
    of->count = dmb_sim_fields(sim, group, group, of->field);
    const size_t more = dmb_sim_fields(sim, DMB_GROUP_MEMORY, DMB_GROUP_MEMORY, memory);
    memcpy(of->field + of->count, memory, more * sizeof *memory);
    of->count += more;
}

/* 1: the choice of independent coordinates, with which the present factors were computed. */
static int is_partition(const dmb_field *field)
{
    return field->check == DMB_CHECK_RANKS || field->check == DMB_CHECK_ROW_ORDER ||
           field->check == DMB_CHECK_COLUMN_ORDER;
}

size_t dmb_state_count(const dmb_sim *sim)
{
    dmb_state_fields of;
    size_t count = 0;
    dmb_state_fields_of(sim, DMB_GROUP_NOW, &of);
    for (size_t i = 0; i < of.count; i++)
        if (dmb_field_has_numbers(&of.field[i])) count += of.field[i].bytes / sizeof(double);
    return count;
}

void dmb_state_read(const dmb_sim *sim, int32_t group, double *to)
{
    dmb_state_fields of;
    dmb_state_fields_of(sim, group, &of);
    for (size_t i = 0; i < of.count; i++) {
        if (!dmb_field_has_numbers(&of.field[i])) continue;
        memcpy(to, of.field[i].data, of.field[i].bytes);
        to += of.field[i].bytes / sizeof(double);
    }
}

static void normalise(const dmb_sim *sim, double *quaternion)
{
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        double *q = quaternion + 4 * (size_t)i;
        const double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        for (int k = 0; k < 4; k++) q[k] /= norm;
    }
}

/* The scene may be that of a side, left by the companion step before. */
void dmb_sensitivity_stand(dmb_sensitivity *s)
{
    s->worker->scene = s->sim->scene;
    s->worker->model = s->sim->model;
    dmb_state_assign(s->sim, s->worker);
    for (uint32_t k = 0; k < s->worker->scene->cluster_count; k++) dmb_cluster_note_places(s->worker, k);
}

/* Quaternions are moved as four numbers and normalised: the difference to a rotation by the rate is of second order and
 * the same on both sides. The worker enters the scene of that side; its inputs keep their present values. */
void dmb_sensitivity_aside(dmb_sensitivity *s, const dmb_rated_parameter *p, int side)
{
    const double step = side == DMB_SIDE_HIGH ? p->step : -p->step, *rate = p->rates;
    dmb_state_fields from, to;
    dmb_state_fields_of(s->sim, DMB_GROUP_NOW, &from);
    dmb_state_fields_of(s->worker, DMB_GROUP_NOW, &to);
    for (size_t i = 0; i < from.count; i++) {
        const double *numbers = from.field[i].data;
        double *moved = to.field[i].data;
        if (!dmb_field_has_numbers(&from.field[i])) {
            if (!is_partition(&from.field[i])) memcpy(to.field[i].data, from.field[i].data, from.field[i].bytes);
            continue;
        }
        const size_t count = from.field[i].bytes / sizeof(double);
        for (size_t k = 0; k < count; k++) moved[k] = numbers[k] + step * rate[k];
        rate += count;
    }
    normalise(s->sim, s->worker->now.quaternion);
    dmb_own_scene_enter(s->worker, p->model[side]);
}

const double *dmb_rates_of(const dmb_sensitivity *s, const dmb_rated_parameter *p, const void *data)
{
    const double *rate = p->rates;
    dmb_state_fields of;
    dmb_state_fields_of(s->sim, DMB_GROUP_NOW, &of);
    for (size_t i = 0; i < of.count; i++) {
        if (of.field[i].data == data) break;
        if (dmb_field_has_numbers(&of.field[i])) rate += of.field[i].bytes / sizeof(double);
    }
    return rate;
}

int32_t dmb_sensitivity_alive(const dmb_sensitivity *s)
{
    if (s == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(s, DMB_HANDLE_SENSITIVITY)) return DMB_ERR_HANDLE;
    return s->busy ? DMB_ERR_ORDER : dmb_sim_check(s->sim);
}
