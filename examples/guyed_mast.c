/* How much do the guy ropes of a mast pull, and how far does its crown move in the wind, with a load beside its middle?
 *
 * A tubular mast of 20 m stands on a fixed foot. Four ropes, which pull only, lead from 18 m height to the ground, with
 * a preload. A load of 60 kN hangs at 11.3 m height, 0.4 m beside the axis. The rope to leeward gets slack. */
#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>

#include "command_line.h"

typedef struct mast {
    dmb_model *model;
    dmb_id mast, rope[4];
} mast;
static int32_t add_load(const mast *m, double height, double beside, int axis, double force)
{
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(m->mast, 0, height / 20.0); /* anywhere on the pipe, not on nodes alone */
    load.offset[1] = beside;
    load.force[axis] = force;
    return dmb_model_add_load(m->model, &load, NULL);
}

static int32_t add_rope(const mast *m, double x, double y, dmb_id *rope)
{
    dmb_spring_def def = dmb_spring_def_default();
    def.acts = DMB_SPRING_TENSION;
    def.offset_a[0] = x; /* place_a is the ground */
    def.offset_a[1] = y;
    def.place_b = dmb_station(m->mast, 0, 0.9);
    def.stiffness = 4e5;
    def.preload = 5e3; /* [N] at the length as described */
    return dmb_model_add_spring(m->model, &def, rope);
}

static int32_t describe(double wind, mast *m)
{
    static const double foot[4][2] = {{12.0, 0.0}, {0.0, 12.0}, {-12.0, 0.0}, {0.0, -12.0}};
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    int32_t status = dmb_model_create(NULL, &m->model);
    string.follows_hole = 0;
    string.rotation[1] = -1.5707963267948966; /* upright */
    string.start_free = DMB_FREE_NONE;
    pipe.length = 20.0;
    pipe.elements = 8;
    pipe.outer_diameter = 0.32;
    pipe.inner_diameter = 0.30;
    if (status >= 0) status = dmb_model_add_string(m->model, &string, &m->mast);
    pipe.string = m->mast;
    if (status >= 0) status = dmb_model_add_pipes(m->model, &pipe, 1, NULL);
    for (int i = 0; i < 4 && status >= 0; i++) status = add_rope(m, foot[i][0], foot[i][1], &m->rope[i]);
    if (status >= 0) status = add_load(m, 11.3, 0.4, 2, -60e3);
    if (status >= 0) status = add_load(m, 20.0, 0.0, 0, wind);
    return status < 0 ? status : dmb_model_compile(m->model, NULL);
}
int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "How much do the guy ropes of a mast pull, and how far does its crown move in the wind, "
                            "with a load beside its middle?",
                            NULL, 0);
    int32_t status = 0;
    printf("%8s %10s %10s %10s %10s %12s\n", "wind kN", "rope +x N", "+y", "-x", "-y", "crown mm");
    for (int i = 0; i < 3 && status >= 0; i++) {
        mast m = {0};
        dmb_sim *sim = NULL;
        dmb_pose crown = dmb_pose_default();
        dmb_spring_state rope = dmb_spring_state_default();
        status = describe(3.0e3 * i, &m);
        if (status >= 0) status = dmb_sim_create(m.model, NULL, &sim);
        if (status >= 0) status = dmb_analysis_static(sim, NULL, NULL);
        printf("%8.1f", 3.0 * i);
        for (int k = 0; k < 4 && status >= 0; k++) {
            status = dmb_query_spring(sim, m.rope[k], &rope);
            printf(" %10.2f", rope.force);
        }
        if (status >= 0) status = dmb_query_pose(sim, dmb_station(m.mast, 0, 1.0), &crown);
        printf(" %12.5f\n", 1e3 * hypot(crown.displacement[0], crown.displacement[1]));
        if (status < 0) fprintf(stderr, "%s%s\n", dmb_model_message(m.model), dmb_sim_message(sim));
        dmb_sim_destroy(&sim);
        dmb_model_destroy(&m.model);
    }
    return status < 0;
}
