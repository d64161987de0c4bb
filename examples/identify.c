/* Friction factor and energy of the rock from a recorded torque and thrust: Gauss-Newton with the derivatives of the
 * run, and the confidence that they give. The record is a run with values that are then forgotten, and noise. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <drillmbd/drillmbd.h>

#include "command_line.h"

enum { SAMPLES = 40, STEPS = 10, VALUES = 2 * SAMPLES };
static dmb_output outputs[2];

static void done(int32_t status)
{
    if (status < 0) {
        fprintf(stderr, "%s\n", dmb_status_text(status));
        exit(1);
    }
}

/* A string that turns at 120 rpm and is fed at 10 mm/s into rock. The sim holds the model. */
static dmb_sim *rig(double friction, double energy)
{
    const double speed[2] = {0.01, 12.566};
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string;
    done(dmb_model_create(NULL, &model));
    dmb_wall_def wall = dmb_wall_def_default();
    wall.mu_static = wall.mu_dynamic = friction;
    wall.smoothing_speed = 0.02;
    done(dmb_model_add_wall(model, &wall, NULL));
    dmb_environment_def mud = dmb_environment_def_default();
    mud.lateral_damping = mud.axial_damping = 200.0;
    mud.torsional_damping = 1.0;
    done(dmb_model_set_environment(model, &mud));
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.damping_time = 2e-3;
    done(dmb_model_add_pipes(model, &pipe, 10, &string));
    dmb_bit_def bit = dmb_bit_def_default();
    bit.rock_law = DMB_ROCK_RATE;
    bit.intrinsic_energy = energy;
    bit.bottom = 0.001; /* the string turns before it cuts */
    done(dmb_model_add_bit(model, &bit, NULL));
    for (int i = 0; i < 2; i++) {
        dmb_segment ramp = dmb_segment_default();
        dmb_drive_def drive = dmb_drive_def_default();
        ramp.kind = DMB_SEGMENT_STEP5;
        ramp.x1 = 0.5;
        ramp.h1 = speed[i];
        drive.component = i == 0 ? DMB_X : DMB_RX;
        done(dmb_model_add_time_function(model, &ramp, 1, &drive.time_function));
        done(dmb_model_add_drive(model, &drive, &outputs[i].place.part));
        outputs[i].quantity = DMB_OUTPUT_DRIVE_FORCE;
    }
    done(dmb_model_compile(model, NULL));
    done(dmb_sim_create(model, NULL, &sim));
    dmb_model_destroy(&model);
    return sim;
}

/* Thrust and torque, and their derivatives by both parameters. */
static void run(const double at[2], double values[VALUES], double derivatives[VALUES][2])
{
    const double step[2] = {1e-5, 3e3};
    dmb_sensitivity *sensitivity;
    dmb_parameter parameters[2];
    dmb_sim *sides[4];
    for (int i = 0; i < 2; i++) {
        parameters[i] = dmb_parameter_default();
        parameters[i].step = step[i];
        parameters[i].low = sides[2 * i] = rig(at[0] - (i == 0) * step[0], at[1] - (i == 1) * step[1]);
        parameters[i].high = sides[2 * i + 1] = rig(at[0] + (i == 0) * step[0], at[1] + (i == 1) * step[1]);
    }
    dmb_sim *sim = rig(at[0], at[1]);
    done(dmb_sensitivity_create(sim, parameters, 2, &sensitivity));
    for (int i = 0; i < 4; i++) dmb_sim_destroy(&sides[i]);
    for (int i = 0; i < SAMPLES; i++) {
        for (int k = 0; k < STEPS; k++) done(dmb_sensitivity_step(sensitivity, 2e-3, NULL));
        done(dmb_sensitivity_outputs(sensitivity, outputs, 2, values + 2 * i, derivatives[2 * i]));
    }
    dmb_sensitivity_destroy(&sensitivity);
    dmb_sim_destroy(&sim);
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "Friction factor and energy of the rock from a recorded torque and thrust: Gauss-Newton "
                            "with the derivatives of the run, and the confidence that they give.",
                            NULL, 0);
    const double truth[2] = {0.25, 3e7}, noise[2] = {20.0, 2.0}; /* [N], [N m] */
    double at[2] = {0.4, 4e7}, record[VALUES], values[VALUES], by[VALUES][2], deviation[2] = {0.0, 0.0};
    uint32_t seed = 1;
    run(truth, record, by);
    for (int i = 0; i < VALUES; i++)
        for (int k = 0; k < 12; k++) /* nearly normal */
            record[i] += noise[i % 2] * ((seed = 1664525u * seed + 1013904223u) / 4294967296.0 - 0.5);
    for (int iteration = 1; iteration <= 10; iteration++) {
        double A = 0.0, B = 0.0, C = 0.0, p = 0.0, q = 0.0, misfit = 0.0;
        run(at, values, by);
        for (int i = 0; i < VALUES; i++) {
            const double w = 1.0 / noise[i % 2], rest = w * (record[i] - values[i]), f = w * by[i][0], g = w * by[i][1];
            A += f * f, B += f * g, C += g * g, p += f * rest, q += g * rest, misfit += rest * rest;
        }
        const double determinant = A * C - B * B;
        printf("%2d: friction %.5f, energy %.4f MPa, rms misfit %.3f\n", iteration, at[0], 1e-6 * at[1],
               sqrt(misfit / VALUES));
        at[0] += (C * p - B * q) / determinant;
        at[1] += (A * q - B * p) / determinant;
        deviation[0] = sqrt(C / determinant);
        deviation[1] = sqrt(A / determinant);
    }
    printf("friction %.4f +- %.4f (was %.4f), energy %.3f +- %.3f MPa (was %.3f), 95 %%\n", at[0], 1.96 * deviation[0],
           truth[0], 1e-6 * at[1], 1.96e-6 * deviation[1], 1e-6 * truth[1]);
    return 0;
}
