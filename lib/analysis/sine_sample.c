#include "analysis/sine_sample.h"

#include <math.h>
#include <string.h>

#include "analysis/answer.h"
#include "math/so3.h"

static void part_along(const double axes[9], int32_t frame, const double world[3], double out[3])
{
    if (frame == DMB_FRAME_BODY)
        dmb_mat3_tvec(axes, world, out);
    else
        dmb_vec3_copy(world, out);
}

/* Rotation vector, in world axes, from the start to now. */
static void rotation_since(const double start[9], const double now[9], double out[3])
{
    double turned[9], q[4], own[3];
    dmb_mat3_mul_tn(start, now, turned);
    dmb_quat_from_matrix(turned, q);
    dmb_quat_log(q, own);
    dmb_mat3_vec(start, own, out);
}

static double displacement(const dmb_sim *sim, const dmb_sine_output *o, int32_t *status)
{
    const int32_t c = o->output.component;
    dmb_pose pose = dmb_pose_default();
    double angle = 0.0, world[3], out[3];
    if (c == DMB_RX) {
        *status = dmb_query_rotation(sim, o->output.place, &angle);
        return angle;
    }
    *status = dmb_query_pose(sim, o->output.place, &pose);
    if (*status < 0) return 0.0;
    if (c < DMB_RX)
        dmb_vec3_copy(pose.displacement, world);
    else
        rotation_since(o->start, pose.rotation, world);
    part_along(o->start, o->output.frame, world, out);
    return out[c % 3];
}

static double value_of(const dmb_sim *sim, const dmb_sine_output *o, int32_t *status)
{
    return o->output.kind == DMB_OUTPUT_DISPLACEMENT ? displacement(sim, o, status)
                                                     : dmb_answer_of(sim, &o->output, status);
}

int32_t dmb_sine_output_begin(const dmb_sim *sim, dmb_sine_output *output)
{
    dmb_pose pose = dmb_pose_default();
    int32_t status = DMB_OK;
    if (output->output.kind == DMB_OUTPUT_DISPLACEMENT) status = dmb_query_pose(sim, output->output.place, &pose);
    memcpy(output->start, pose.rotation, sizeof output->start);
    if (status >= 0) (void)value_of(sim, output, &status);
    return status;
}

double dmb_sine_sample(const dmb_sim *sim, const dmb_sine_output *output)
{
    int32_t status;
    return value_of(sim, output, &status);
}
