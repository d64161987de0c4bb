#include "modal.h"

#include <string.h>

dmb_id lay_string(rig *s, const dmb_pipe_def *pipe, uint32_t count, int32_t start_free, int32_t end_free)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def with = *pipe;
    rig_open(s, 0, 0, 0);
    string.start_free = start_free;
    string.end_free = end_free;
    with.string = add_string(s, &string);
    (void)add_pipes(s, &with, count);
    return with.string;
}

dmb_modes *find_modes(const rig *s, const dmb_modes_options *options)
{
    dmb_modes *modes = NULL;
    must(s, dmb_analysis_modes(s->sim, options, &modes));
    return modes;
}

dmb_modes *lowest_modes(const rig *s, int32_t kind, uint32_t count)
{
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = kind;
    options.count = count;
    return find_modes(s, &options);
}

dmb_modes *all_modes(const rig *s, int32_t kind)
{
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = kind;
    options.select = DMB_MODES_ALL;
    return find_modes(s, &options);
}

dmb_modes *modes_in_band(const rig *s, int32_t kind, double low, double high)
{
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = kind;
    options.select = DMB_MODES_BAND;
    options.band[0] = low;
    options.band[1] = high;
    return find_modes(s, &options);
}

dmb_modes_info info_of(const dmb_modes *modes)
{
    dmb_modes_info info = dmb_modes_info_default();
    assert_int_equal(dmb_modes_get_info(modes, &info), DMB_OK);
    return info;
}

dmb_mode mode_at(const dmb_modes *modes, uint32_t index)
{
    dmb_mode mode = dmb_mode_default();
    assert_int_equal(dmb_modes_get(modes, index, &mode), DMB_OK);
    return mode;
}

dmb_mode_shape shape_at(const dmb_modes *modes, uint32_t index, dmb_place place)
{
    dmb_mode_shape shape = dmb_mode_shape_default();
    assert_int_equal(dmb_modes_shape(modes, index, place, &shape), DMB_OK);
    return shape;
}

double frequency_at(const dmb_modes *modes, uint32_t index)
{
    return mode_at(modes, index).frequency;
}

double frequency_of_kind(const dmb_modes *modes, int kind, uint32_t number)
{
    const uint32_t count = info_of(modes).count;
    for (uint32_t i = 0; i < count; i++) {
        const dmb_mode mode = mode_at(modes, i);
        if (!mode.rigid && mode.share[kind] > 0.5 && number-- == 0) return mode.frequency;
    }
    fail_msg("no further mode of kind %d among %u", kind, count);
    return 0.0;
}

double closest_mode(const dmb_modes *modes, double w)
{
    double least = 1e9;
    for (uint32_t i = 0; i < info_of(modes).count; i++)
        least = fmin(least, fabs(mode_at(modes, i).eigenvalue[1] - w) / w);
    return least;
}

modes_refusal refused_modes(const rig *s, const dmb_modes_options *options)
{
    modes_refusal refusal;
    dmb_modes *modes = NULL;
    uint64_t before = 0, after = 0;
    memset(&refusal, 0, sizeof refusal);
    must(s, dmb_sim_hash(s->sim, &before));
    refusal.status = dmb_analysis_modes(s->sim, options, &modes);
    (void)strncpy(refusal.text, dmb_sim_message(s->sim), sizeof refusal.text - 1);
    must(s, dmb_sim_hash(s->sim, &after));
    assert_true(refusal.status < 0);
    assert_null(modes);
    assert_true(before == after);
    return refusal;
}
