#include "query/input_query.h"

#include <math.h>

#include "base/sized_struct.h"
#include "drillmbd/control.h"
#include "force/reference.h"
#include "sim/access.h"
#include "sim/own_scene.h"

DMB_DEFINE_INIT(dmb_input_state, 40, {.value = 0.0})

int32_t dmb_input_present(const dmb_sim *sim, uint32_t i, double *value, double *rate)
{
    const uint32_t programme = dmb_described_programme(sim->scene, i);
    *rate = 0.0;
    *value = sim->input_value[i];
    if (programme == DMB_NONE) return DMB_OK;
    return dmb_programme_value(sim->scene->programmes + programme, sim->clock->time, value, rate);
}

int32_t dmb_sim_get_input(const dmb_sim *sim, dmb_id input, dmb_input_state *state)
{
    dmb_input_state answer = dmb_input_state_default();
    int32_t status = dmb_ask(sim, state);
    if (status < 0) return status;
    const uint32_t i = dmb_model_part_index(sim->model, input, DMB_PART_INPUT);
    if (i >= sim->scene->input_count) return DMB_ERR_ID;
    status = dmb_input_present(sim, i, &answer.present, &answer.rate);
    if (status < 0) return status;
    answer.is_set = !isnan(sim->input_value[i]);
    answer.value = answer.is_set ? sim->input_value[i] : answer.present;
    if (answer.is_set) answer.arrives = dmb_reference_arrival(&sim->own->references[i]);
    return dmb_input_state_write(state, &answer);
}
