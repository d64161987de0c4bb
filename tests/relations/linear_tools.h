/* Tools of relations between linear analyses: states of rest, and places that are pushed and looked at. */
#ifndef DMB_RELATIONS_LINEAR_TOOLS_H
#define DMB_RELATIONS_LINEAR_TOOLS_H

#include <complex.h>

#include "relations.h"

static inline int32_t open_at_rest(const scene *s, const dmb_sim_options *options, built *b)
{
    int32_t status = scene_open(s, 0, options, b);
    if (status < 0) return status;
    dmb_static_options exact = dmb_static_options_default();
    exact.tolerance = 1e-12; /* next to nothing is left that moves beside a small excitation */
    status = dmb_analysis_static(b->sim, &exact, NULL);
    return status < 0 ? built_fail(b, status) : status;
}

/* A place and a component of it in the world. */
typedef struct material_point {
    part_ref place;
    int32_t component;
} material_point;

static inline material_point draw_spot(const scene *s, stream *n, int32_t components)
{
    const uint32_t k = draw_count(n, 0, s->strings - 1);
    const part_ref place = {PART_STRING, k, draw_count(n, 0, s->string[k].pipes - 1), 1.0};
    const material_point out = {place, (int32_t)draw_count(n, 0, (uint32_t)components - 1)};
    return out;
}

static inline dmb_excitation input_of(const built *b, const material_point *at)
{
    dmb_excitation input = dmb_excitation_default();
    input.place = built_place(b, at->place);
    input.component = at->component;
    return input;
}

static inline dmb_output output_of(const built *b, const material_point *at)
{
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    output.place = built_place(b, at->place);
    output.quantity += at->component;
    return output;
}

static inline double complex number(const double pair[2])
{
    return pair[0] + pair[1] * (double complex)I;
}

#endif
