#include "system/assemble/point_load.h"

#include "math/mat6.h"

/* By displacements of the nodes, the body turning under a dead wrench, d(R^T f) = (R^T f) x theta, and the map
 * changing: -map^T (w_f x theta; w_m x theta) - d(map^T) w. */
static void add_tangent(dmb_evaluation *evaluation, const dmb_scene_load *load, const dmb_point_motion *m,
                        const double w[6])
{
    const dmb_scene *scene = evaluation->sim->scene;
    dmb_force_tangent t;
    double A[144];
    dmb_force_tangent_begin(&t);
    dmb_force_tangent_touch(scene, m, &t);
    dmb_force_tangent_clear(&t);
    dmb_point_map_tangent(scene, m, w, A);
    dmb_force_tangent_block(scene, &t, m, -1.0, A);
    for (int i = 0; i < 6 && load->frame != DMB_FRAME_BODY; i++) {
        double e[3] = {0.0}, unit[6] = {0.0}, turn[6] = {0.0};
        double move[DMB_CONSTRAINT_COLUMNS] = {0.0}, change[DMB_CONSTRAINT_COLUMNS] = {0.0};
        e[i % 3] = unit[i] = 1.0;
        dmb_vec3_cross(e, i < 3 ? w : w + 3, turn + 3); /* e . (w x theta) = (e x w) . theta */
        dmb_force_tangent_row(scene, &t, m, unit, move);
        dmb_force_tangent_row(scene, &t, m, turn, change);
        for (uint32_t r = 0; r < t.columns; r++)
            for (uint32_t c = 0; c < t.columns; c++) t.K[(size_t)r * t.columns + c] -= move[r] * change[c];
    }
    dmb_force_tangent_add(evaluation, DMB_NONE, DMB_BY_DISPLACEMENT, &t);
}

void dmb_gather_point_load(dmb_evaluation *evaluation, const dmb_scene_load *load, double factor, const double frame[9])
{
    dmb_sim *sim = evaluation->sim;
    dmb_point_motion m;
    double w[6], f[3];
    dmb_point_motion_of(sim->scene, &sim->trial, sim->scene->load_points + load->point, &m);
    dmb_vec3_scale(factor, load->force, w);
    dmb_vec3_scale(factor, load->moment, w + 3);
    for (int k = 0; k < 6 && load->frame != DMB_FRAME_BODY; k += 3) {
        dmb_mat3_vec(frame, w + k, f);
        dmb_mat3_tvec(m.R, f, w + k);
    }
    dmb_point_apply(sim, &m, w);
    if (evaluation->tangent) add_tangent(evaluation, load, &m, w);
    if (evaluation->dynamic) evaluation->power[DMB_POWER_LOADS] += dmb_vec6_dot(w, m.V);
}
