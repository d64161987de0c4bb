/* Load patterns: the loads at the factor f of a path or a buckling analysis, beside those present at f = 0.
 *
 *     scale              gravity    loads, bit loads   drives of a force   one part
 *     DMB_SCALE_ALL      1 + f      1 + f              1 + f               -
 *     DMB_SCALE_LOADS    1          1 + f              1 + f               -
 *     DMB_SCALE_PART     1          1                  1                   load: its factor + f; drive: its force + f;
 *                                                                          motion drive: its row moves by f
 *
 * q = dr/df of eq:buckling.arc is the difference of two residuals, exact since loads enter linearly, or the column of K
 * that belongs to a moved row. */
#include "analysis/buckling/buckling.h"

#include <string.h>

#include "drillmbd/analyse.h"
#include "sim/node.h"

size_t dmb_load_pattern_size(const dmb_scene *scene)
{
    return (size_t)scene->load_count + scene->bit_count + scene->drive_count;
}

/* A speed controller has no given force. Motion is prescribed in a row of the residual: a joint has none, and in a
 * reduced system of joints the row is not a coordinate of its own. */
static int32_t read_drive(dmb_sim *sim, const char *who, dmb_load_pattern *pattern)
{
    const dmb_scene_drive *drive = sim->scene->drives + pattern->drive;
    if (drive->kind == DMB_DRIVE_CONTROL) {
        dmb_message_set(&sim->message, "%s: %s is a speed controller, whose force is not given", who,
                        dmb_drive_text(sim->scene, pattern->drive, &(dmb_message){""}));
        return DMB_ERR_VALUE;
    }
    if (drive->kind != DMB_DRIVE_MOTION) return DMB_OK;
    if (drive->joint != DMB_NONE) {
        dmb_message_set(&sim->message, "%s: %s moves a joint, use one of a string or body", who,
                        dmb_drive_text(sim->scene, pattern->drive, &(dmb_message){""}));
        return DMB_ERR_UNSUPPORTED;
    }
    if (sim->scene->cluster_count > 0 && sim->scene->node_cluster[drive->node] != DMB_NONE) {
        dmb_message_set(
            &sim->message,
            "%s: %s moves a place that joints, springs or forces connect to other parts; let a load push it", who,
            dmb_drive_text(sim->scene, pattern->drive, &(dmb_message){""}));
        return DMB_ERR_UNSUPPORTED;
    }
    pattern->row = drive->row;
    return DMB_OK;
}

int32_t dmb_load_pattern_allocate(dmb_sim *sim, const char *who, int32_t scale, dmb_id part, dmb_load_pattern *pattern)
{
    const dmb_scene *scene = sim->scene;
    pattern->scale = scale;
    pattern->load = pattern->drive = pattern->row = DMB_NONE;
    pattern->base = NULL;
    if (scale != DMB_SCALE_PART) return DMB_OK;
    const uint32_t load = dmb_model_part_index(sim->model, part, DMB_PART_LOAD);
    if (load < scene->load_count) {
        pattern->load = load;
        return DMB_OK;
    }
    pattern->drive = dmb_model_part_index(sim->model, part, DMB_PART_DRIVE);
    if (pattern->drive < scene->drive_count) return read_drive(sim, who, pattern);
    dmb_message_set(&sim->message, "%s: part names no load and no drive of this model", who);
    return DMB_ERR_ID;
}

void dmb_load_pattern_begin(const dmb_load_pattern *pattern, const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    double *base = pattern->base;
    for (uint32_t i = 0; i < scene->load_count; i++) *base++ = sim->trial.load_factor[i];
    for (uint32_t i = 0; i < scene->bit_count; i++) *base++ = sim->trial.bit_load[i];
    for (uint32_t i = 0; i < scene->drive_count; i++) *base++ = sim->trial.drives[i].target;
}

/* Sets the loads. Gravity, loads and bit loads scale in the evaluation if all of them do; else individually. */
void dmb_load_pattern_set(const dmb_load_pattern *pattern, dmb_evaluation *evaluation, double factor)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const double *base = pattern->base, all = 1.0 + factor;
    const double loads = pattern->scale == DMB_SCALE_LOADS ? all : 1.0;
    const double drives = pattern->scale == DMB_SCALE_PART ? 1.0 : all;
    evaluation->load_factor = pattern->scale == DMB_SCALE_ALL ? all : 1.0;
    for (uint32_t i = 0; i < scene->load_count; i++)
        sim->trial.load_factor[i] = loads * *base++ + (i == pattern->load ? factor : 0.0);
    for (uint32_t i = 0; i < scene->bit_count; i++) sim->trial.bit_load[i] = loads * *base++;
    for (uint32_t i = 0; i < scene->drive_count; i++, base++) {
        if (scene->drives[i].kind != DMB_DRIVE_LOAD) continue;
        sim->trial.drives[i].target = i == pattern->drive ? *base + factor : drives * *base;
    }
}

/* Column of the tangent of the moved row, which is in the first node of its chain: the rig end of a string, or a
 * body. */
static void moved_column(const dmb_sim *sim, uint32_t row, double *out)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    uint32_t node = 0;
    while (layout->row[node + 1] <= row) node++;
    const uint32_t c = row - layout->row[node], size = layout->size[node];
    memset(out, 0, scene->row_count * sizeof(double));
    for (uint32_t i = 0; i < size; i++) out[layout->row[node] + i] = dmb_stiffness_of(sim, node)[size * i + c];
    if (scene->node_element[node] != DMB_NONE)
        for (uint32_t i = 0; i < layout->size[node + 1]; i++)
            out[layout->row[node + 1] + i] = sim->stiffness_lower[layout->link[node] + size * i + c];
}

/* Loads enter the residual linearly: its change over a unit of the factor is the derivative. The second evaluation, at
 * the factor itself, restores the trial. */
int32_t dmb_load_pattern_derivative(const dmb_load_pattern *pattern, dmb_evaluation *evaluation, double factor,
                                    double *derivative)
{
    dmb_sim *sim = evaluation->sim;
    const uint32_t rows = sim->scene->row_count;
    const int32_t tangent = evaluation->tangent;
    if (pattern->row != DMB_NONE) {
        moved_column(sim, pattern->row, derivative);
        return DMB_OK;
    }
    evaluation->tangent = 0;
    dmb_load_pattern_set(pattern, evaluation, factor + 1.0);
    int32_t status = dmb_system_evaluate(evaluation);
    memcpy(derivative, sim->residual, rows * sizeof(double));
    dmb_load_pattern_set(pattern, evaluation, factor);
    if (status >= 0) status = dmb_system_evaluate(evaluation);
    evaluation->tangent = tangent;
    for (uint32_t i = 0; i < rows; i++) derivative[i] -= sim->residual[i];
    return status;
}
