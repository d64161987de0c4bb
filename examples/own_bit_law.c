/* From which rotary speed on do swings of a string die out whose bit has a torque that falls with its speed, and does
 * it stick and slip after a start? Where it may do both, the start decides.
 *
 * The torque is a function of this program, T = 900 N m (0.6 + 0.4 exp(-|w|/3)) w/sqrt(w^2 + 0.1^2), of the speed w at
 * the string's end. A string of 1000 m turned at its head swings by it; mud damps it. The swings' frequency and damping
 * are those of the linearised string; the speeds of sticking and slipping itself are chaotic and not printed. */
#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>

#include "command_line.h"

static int32_t bit_torque(void *context, double time, uint32_t count, const double (*poses)[12],
                          const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                          const dmb_law_memory *memory)
{
    const double w = velocities[0][3], n = sqrt(w * w + 0.01), s = w / n, fall = 0.4 * exp(-n / 3.0);
    (void)context, (void)time, (void)count, (void)poses, (void)potential, (void)memory; /* it has no state */
    forces[0][3] = -900.0 * (0.6 + fall) * s;
    if (tangent == NULL) return 0;
    tangent[36 + 6 * 3 + 3] = -900.0 * ((0.6 + fall) * 0.01 / (n * n * n) - fall / 3.0 * s * s); /* by the speed */
    return 0;
}

static int32_t describe(double speed, dmb_model **model, dmb_place *end)
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_segment turn = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_force_def torque = dmb_force_def_default();
    int32_t status = dmb_model_create(NULL, model);
    environment.torsional_damping = 0.02;
    string.start_free = DMB_FREE_RX;
    string.velocity[3] = speed;
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.length = 50.0;
    turn.h0 = speed;
    drive.component = DMB_RX;
    torque.frame = DMB_FRAME_BODY; /* velocity and torque about the string's own axis */
    torque.callback = bit_torque;
    torque.provides = DMB_PROVIDES_TANGENT; /* compared with differences when the sim is made */
    if (status >= 0) status = dmb_model_set_environment(*model, &environment);
    if (status >= 0) status = dmb_model_add_string(*model, &string, &pipe.string);
    if (status >= 0) status = dmb_model_add_pipes(*model, &pipe, 20, NULL);
    if (status >= 0) status = dmb_model_add_time_function(*model, &turn, 1, &drive.time_function);
    if (status >= 0) status = dmb_model_add_drive(*model, &drive, NULL);
    *end = torque.place[0] = dmb_station(pipe.string, 19, 1.0);
    if (status >= 0) status = dmb_model_add_force(*model, &torque, NULL);
    return status < 0 ? status : dmb_model_compile(*model, NULL);
}

/* The slowest torsional swing about turning at the speed of the start, where the torque alone is out of balance. */
static int32_t ask_swing(dmb_sim *sim, dmb_mode *swing)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    options.kind = DMB_MODES_DAMPED;
    options.count = 3;
    options.equilibrium_tolerance = 1e6;
    const int32_t status = dmb_analysis_modes(sim, &options, &modes);
    for (uint32_t i = 0; i < options.count && !(swing->share[1] > 0.5); i++)
        if (dmb_modes_get(modes, i, swing) < 0) break;
    dmb_modes_destroy(&modes);
    return status;
}

/* Least speed of the bit from 45 s to 60 s after a start without twist, over that of the rig. */
static int32_t run(dmb_sim *sim, dmb_place end, double speed, double *least)
{
    dmb_motion motion = dmb_motion_default();
    int32_t status = 0;
    motion.frame = DMB_FRAME_BODY;
    for (int i = 0; i < 3000 && status >= 0; i++) {
        status = dmb_sim_step(sim, 0.02, NULL);
        if (i >= 2250 && status >= 0) status = dmb_query_motion(sim, end, &motion);
        if (i >= 2250) *least = fmin(*least, motion.velocity[3] / speed);
    }
    return status;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "From which rotary speed on do swings of a string die out, and does it stick and slip?",
                            NULL, 0);
    int32_t status = 0;
    for (int rpm = 40; rpm <= 160 && status >= 0; rpm += 40) {
        const double speed = rpm * 3.14159265358979323846 / 30.0;
        double least = 1.0;
        dmb_model *model = NULL;
        dmb_sim *sim = NULL;
        dmb_mode swing = dmb_mode_default();
        dmb_place end;
        status = describe(speed, &model, &end);
        if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
        if (status >= 0) status = ask_swing(sim, &swing);
        if (status >= 0) status = run(sim, end, speed, &least);
        printf("%3d 1/min: a swing of %.5f Hz %s by %.5f 1/s; after a start without twist the bit %s\n", rpm,
               swing.frequency, swing.eigenvalue[0] > 0.0 ? "grows" : "dies out", fabs(swing.eigenvalue[0]),
               least < 0.1 ? "sticks and slips" : "comes to turn steadily");
        if (status < 0) fprintf(stderr, "%s%s\n", dmb_model_message(model), dmb_sim_message(sim));
        dmb_sim_destroy(&sim);
        dmb_model_destroy(&model);
    }
    return status < 0;
}
