#include "harmonic.h"

dmb_input force_at(dmb_place place, int32_t component)
{
    dmb_input input = dmb_input_default();
    input.place = place;
    input.component = component;
    return input;
}

dmb_input input_of(int32_t kind, dmb_id part, int32_t component)
{
    dmb_input input = force_at(dmb_station(part, 0, 0.0), component);
    input.kind = kind;
    return input;
}

dmb_output output_at(int32_t kind, dmb_place place, int32_t component)
{
    dmb_output output = dmb_output_default();
    output.kind = kind;
    output.place = place;
    output.component = component;
    return output;
}

void transfer(const rig *s, const dmb_response_options *options, const dmb_input *input, const dmb_output *output,
              const double *frequencies, uint32_t points, double complex *values)
{
    dmb_response_options with = options != NULL ? *options : dmb_response_options_default();
    dmb_response *response = NULL;
    uint64_t before, after;
    with.frequencies = frequencies;
    with.points = points;
    must(s, dmb_sim_hash(s->sim, &before));
    must(s, dmb_analysis_response(s->sim, &with, input, 1, output, 1, &response));
    must(s, dmb_sim_hash(s->sim, &after));
    assert_true(before == after);
    assert_int_equal(dmb_response_transfer(response, 0, 0, (double *)values), DMB_OK);
    dmb_response_destroy(&response);
    assert_null(response);
}
