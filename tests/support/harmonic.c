#include "harmonic.h"

dmb_excitation force_at(dmb_place place, int32_t component)
{
    dmb_excitation input = dmb_excitation_default();
    input.place = place;
    input.component = component;
    return input;
}

dmb_excitation input_of(int32_t kind, dmb_id part, int32_t component)
{
    dmb_excitation input = force_at(dmb_station(part, 0, 0.0), component);
    input.kind = kind;
    return input;
}

dmb_output output_at(int32_t quantity, dmb_place place, int32_t component)
{
    const dmb_output output = {place, quantity + component, 0};
    return output;
}

void transfer(const rig *s, const dmb_response_options *options, const dmb_excitation *input, const dmb_output *output,
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

dmb_id open_rotor(rig *s, double speed)
{
    dmb_body_def disc = dmb_body_def_default();
    dmb_joint_def shaft = dmb_joint_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    disc.mass = 50.0;
    disc.centre[1] = 1e-4;
    disc.free_mask = DMB_FREE_Y | DMB_FREE_Z | DMB_FREE_RX;
    disc.velocity[3] = speed;
    const dmb_id body = add_body(s, &disc);
    shaft.kind = DMB_JOINT_FREE;
    shaft.place_b = dmb_station(body, 0, 0.0);
    shaft.stiffness[1] = shaft.stiffness[2] = 1e6;
    shaft.damping[1] = shaft.damping[2] = 2.0 * 0.02 * sqrt(1e6 * 50.0);
    must_model(s, dmb_model_add_joint(s->model, &shaft, NULL));
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, body, DMB_RX, add_constant(s, speed));
    (void)rig_start(s, NULL);
    return body;
}
