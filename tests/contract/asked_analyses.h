/* The analyses of a sim, each by one call of what is asked of it: tests let each of their allocations fail, and each
 * question to functions of the caller's. A call that fails gives nothing out; what it gives is given back at once.
 * After rig.h. */
#ifndef DMB_TESTS_ASKED_ANALYSES_H
#define DMB_TESTS_ASKED_ANALYSES_H

#include "rig.h"

typedef struct asked_of {
    dmb_sim *sim;
    dmb_place place;   /* of forces and motion */
    int32_t component; /* DMB_Y ..., of both */
    uint32_t points;   /* of responses and speeds */
    double frequency;  /* [Hz] of stepped sines */
    double factor_max; /* of buckling */
} asked_of;

#define GIVES_NOTHING_OUT(result) assert_true(status >= 0 || (result) == NULL)

static inline int32_t ask_statics(const asked_of *a)
{
    return dmb_analysis_static(a->sim, NULL, NULL);
}

static inline int32_t ask_statics_laid(const asked_of *a)
{
    dmb_static_options options = dmb_static_options_default();
    options.lay_on_wall = 1;
    return dmb_analysis_static(a->sim, &options, NULL);
}

static inline int32_t ask_statics_in_steps(const asked_of *a)
{
    dmb_static_options options = dmb_static_options_default();
    options.load_steps = 3;
    return dmb_analysis_static(a->sim, &options, NULL);
}

static inline int32_t ask_steady(const asked_of *a)
{
    dmb_static_options options = dmb_static_options_default();
    options.steady = DMB_STEADY_AT_REST;
    return dmb_analysis_static(a->sim, &options, NULL);
}

static inline int32_t ask_check_model(const asked_of *a)
{
    dmb_check_report report = dmb_check_report_default();
    return dmb_analysis_check(a->sim, &report);
}

static inline int32_t ask_check_as_text(const asked_of *a)
{
    char text[8192];
    size_t needed;
    return dmb_analysis_check_text(a->sim, text, sizeof text, &needed);
}

static inline int32_t ask_buckle(const asked_of *a, int32_t follow)
{
    dmb_buckling_options options = dmb_buckling_options_default();
    dmb_buckling *found = NULL;
    options.follow = follow;
    options.factor_max = a->factor_max;
    const int32_t status = dmb_analysis_buckling(a->sim, &options, &found);
    GIVES_NOTHING_OUT(found);
    dmb_buckling_destroy(&found);
    return status;
}

static inline int32_t ask_buckling(const asked_of *a)
{
    return ask_buckle(a, 0);
}

static inline int32_t ask_followed_buckling(const asked_of *a)
{
    return ask_buckle(a, 1);
}

static inline int32_t ask_path(const asked_of *a)
{
    dmb_path_options options = dmb_path_options_default();
    options.max_points = 4;
    return dmb_analysis_path(a->sim, &options, NULL);
}

static inline int32_t ask_modes_of(const asked_of *a, int32_t kind, int32_t select)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *found = NULL;
    options.kind = kind;
    options.select = select;
    options.count = 3;
    options.band[1] = 20.0;
    const int32_t status = dmb_analysis_modes(a->sim, &options, &found);
    GIVES_NOTHING_OUT(found);
    dmb_modes_destroy(&found);
    return status;
}

static inline int32_t ask_lowest_modes(const asked_of *a)
{
    return ask_modes_of(a, DMB_MODES_UNDAMPED, DMB_MODES_LOWEST);
}

static inline int32_t ask_all_modes(const asked_of *a)
{
    return ask_modes_of(a, DMB_MODES_UNDAMPED, DMB_MODES_ALL);
}

static inline int32_t ask_modes_of_a_band(const asked_of *a)
{
    return ask_modes_of(a, DMB_MODES_UNDAMPED, DMB_MODES_BAND);
}

static inline int32_t ask_damped_modes(const asked_of *a)
{
    return ask_modes_of(a, DMB_MODES_DAMPED, DMB_MODES_LOWEST);
}

static inline int32_t ask_all_damped_modes(const asked_of *a)
{
    return ask_modes_of(a, DMB_MODES_DAMPED, DMB_MODES_ALL);
}

/* Bands of so many modes that they are searched for piece by piece. */
static inline int32_t ask_modes_of_a_wide_band(const asked_of *a, int32_t kind)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *found = NULL;
    dmb_modes_info info = dmb_modes_info_default();
    options.kind = kind;
    options.select = DMB_MODES_BAND;
    options.band[0] = 0.1;
    options.band[1] = 60.0;
    const int32_t status = dmb_analysis_modes(a->sim, &options, &found);
    GIVES_NOTHING_OUT(found);
    if (status >= 0) {
        assert_int_equal(dmb_modes_get_info(found, &info), DMB_OK);
        assert_true(info.count > 64 && !info.dense);
    }
    dmb_modes_destroy(&found);
    return status;
}

static inline int32_t ask_wide_band(const asked_of *a)
{
    return ask_modes_of_a_wide_band(a, DMB_MODES_UNDAMPED);
}

static inline int32_t ask_wide_damped_band(const asked_of *a)
{
    return ask_modes_of_a_wide_band(a, DMB_MODES_DAMPED);
}

static inline dmb_excitation ask_force_on(const asked_of *a)
{
    dmb_excitation input = dmb_excitation_default();
    input.place = a->place;
    input.component = a->component;
    return input;
}

static inline dmb_output ask_motion_of(const asked_of *a)
{
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    output.place = a->place;
    output.quantity += a->component;
    return output;
}

static inline int32_t ask_response(const asked_of *a)
{
    const dmb_excitation input = ask_force_on(a);
    const dmb_output output = ask_motion_of(a);
    dmb_response_options options = dmb_response_options_default();
    dmb_response *found = NULL;
    options.points = a->points;
    options.refinement = 5;
    const int32_t status = dmb_analysis_response(a->sim, &options, &input, 1, &output, 1, &found);
    GIVES_NOTHING_OUT(found);
    dmb_response_destroy(&found);
    return status;
}

static inline int32_t ask_speeds(const asked_of *a)
{
    const dmb_output output = ask_motion_of(a);
    const double limit = 1e-6;
    dmb_order order = dmb_order_default();
    dmb_speeds_options options = dmb_speeds_options_default();
    dmb_speed_band bands[4] = {dmb_speed_band_default()};
    uint32_t count = 4;
    order.excitation = ask_force_on(a);
    options.points = a->points;
    return dmb_analysis_speeds(a->sim, &options, &order, 1, &output, &limit, 1, bands, &count, NULL);
}

/* It moves the sim on. */
static inline int32_t ask_stepped_sine(const asked_of *a)
{
    const dmb_output output = ask_motion_of(a);
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    double amplitudes[8];
    options.steps_per_period = 24;
    options.windows = 3;
    options.periods = 1;
    return dmb_analysis_stepped_sine(a->sim, a->frequency, &options, &output, 1, amplitudes, NULL);
}

static inline int32_t ask_state_space(const asked_of *a)
{
    const dmb_excitation input = ask_force_on(a);
    const dmb_output output = ask_motion_of(a);
    dmb_state_space *found = NULL;
    const int32_t status = dmb_analysis_state_space(a->sim, NULL, &input, 1, &output, 1, &found);
    GIVES_NOTHING_OUT(found);
    dmb_state_space_destroy(&found);
    return status;
}

static inline int32_t ask_reduced_state_space(const asked_of *a)
{
    const dmb_excitation input = ask_force_on(a);
    const dmb_output output = ask_motion_of(a);
    dmb_modes_options lowest = dmb_modes_options_default();
    dmb_state_space_options options = dmb_state_space_options_default();
    dmb_state_space *found = NULL;
    dmb_modes *modes = NULL;
    lowest.count = 3;
    int32_t status = dmb_analysis_modes(a->sim, &lowest, &modes);
    if (status < 0) return status;
    options.form = DMB_STATE_REDUCED;
    options.modes = modes;
    status = dmb_analysis_state_space(a->sim, &options, &input, 1, &output, 1, &found);
    GIVES_NOTHING_OUT(found);
    dmb_state_space_destroy(&found);
    dmb_modes_destroy(&modes);
    return status;
}

static inline int32_t ask_residual_array(const asked_of *a)
{
    double values[512];
    uint64_t count = 512;
    return dmb_analysis_array(a->sim, DMB_ARRAY_RESIDUAL, values, &count);
}

#endif
