/* Outputs by all rows. They are taken from the response: their functionals as they are, forces of guides and
 * constraints by asking for their part of each row's force, a_r = -(output for a force of one on row r, nothing
 * moving). */
#include <string.h>

#include "analysis/state_space/state_space.h"

/* a_r of one row. */
static double share_of_row(dmb_space_work *w, const dmb_response_output *output, dmb_complex_array zeros,
                           dmb_complex_array force, uint32_t row)
{
    const dmb_excitation none = {.drive = DMB_NONE, .bit = DMB_NONE};
    force.re[row] = -1.0;
    const double value = dmb_response_output_value(&w->stiffness, output, &none, zeros, force).re;
    force.re[row] = 0.0;
    return value;
}

static void take_shares(dmb_space_work *w, const dmb_response_output *output, double *shares)
{
    const dmb_scene *scene = &w->linear->scene;
    const size_t rows = w->linear->rows;
    const dmb_complex_array zeros = {w->work, w->work + rows};
    const dmb_complex_array force = {w->work + 2 * rows, w->work + 3 * rows};
    memset(w->work, 0, 4 * rows * sizeof(double));
    for (uint32_t k = 0; k < output->guide_count; k++) {
        const uint32_t row = dmb_held_row(scene, output->guide[k]);
        shares[row] = share_of_row(w, output, zeros, force, row);
    }
    if (output->cluster == DMB_NONE) return;
    const dmb_cluster *cluster = scene->clusters + output->cluster;
    for (uint32_t i = cluster->column; i < cluster->column + cluster->columns; i++) {
        const uint32_t row = scene->cluster_columns[i];
        shares[row] = share_of_row(w, output, zeros, force, row);
    }
}

/* The functional and its rates: at most twice, of what goes by pose alone. */
static void take_functional(const dmb_response_output *output, dmb_output_rows *out)
{
    double *rates[5] = {out->pose, out->speed, out->acceleration, NULL, NULL};
    const dmb_functional *f = &output->functional;
    for (uint32_t i = 0; i < f->count; i++) {
        rates[output->rate][f->row[i]] += f->pose[i];
        if (output->rate < 2) rates[output->rate + 1][f->row[i]] += f->speed[i];
        if (output->rate < 1) rates[2][f->row[i]] += f->acceleration[i];
    }
}

static void take_output(dmb_space_work *w, const dmb_response_output *output, dmb_output_rows *out)
{
    const dmb_sparse_rows *whole = &w->space->whole;
    const uint32_t rows = w->linear->rows;
    double *shares = w->work + 4 * (size_t)rows;
    out->drive = output->drive;
    out->bit = output->bit;
    out->direct = output->direct;
    out->integral = output->integral;
    take_functional(output, out);
    if (output->guide_count > 0 || output->cluster != DMB_NONE) {
        memset(shares, 0, rows * sizeof(double));
        take_shares(w, output, shares);
        dmb_sparse_add_transposed(whole, DMB_WHOLE_STIFFNESS, shares, out->pose);
        dmb_sparse_add_transposed(whole, DMB_WHOLE_DAMPING, shares, out->speed);
        dmb_sparse_add_transposed(whole, DMB_WHOLE_MASS, shares, out->acceleration);
        for (uint32_t r = 0; r < rows; r++) out->force[r] = -shares[r];
    }
    for (uint32_t r = 0; r < rows; r++) out->accelerates |= out->acceleration[r] != 0.0;
}

int32_t dmb_space_take_outputs(dmb_space_work *w, const dmb_output *outputs)
{
    dmb_response_options options = dmb_response_options_default();
    options.contact = w->options.contact;
    options.friction = w->options.friction;
    options.contact_gap = w->options.contact_gap;
    for (uint32_t i = 0; i < w->output_count; i++) {
        dmb_response_output taken;
        dmb_output output;
        int32_t status = dmb_output_take(outputs, i, &w->sim->message, &output);
        if (status >= 0) status = dmb_response_output_of(w->linear, &options, &output, i, &w->sim->message, &taken);
        if (status < 0) return status;
        take_output(w, &taken, w->outputs + i);
    }
    return DMB_OK;
}
