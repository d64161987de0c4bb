/* Where does it happen? A run that stops at events: the bit meets the rock, the rotation head reaches its torque, the
 * bit stands still. The driller eases the feed when it stalls, and the string turns on. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

static dmb_id drive(dmb_model *model, int32_t kind, int32_t component, double speed)
{
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment rise = dmb_segment_default();
    dmb_id id = {0, 0};
    rise.kind = DMB_SEGMENT_STEP;
    rise.h1 = speed;
    (void)dmb_model_add_time_function(model, &rise, 1, &drive.time_function);
    drive.kind = kind;
    drive.component = component;
    drive.gain = 200.0;
    drive.limit_high = 700.0;
    (void)dmb_model_add_drive(model, &drive, &id);
    return id;
}

static void event(dmb_model *model, const char *name, int32_t quantity, int32_t direction, double level, double hold)
{
    dmb_event_def event = dmb_event_def_default();
    (void)snprintf(event.name, sizeof event.name, "%s", name);
    event.output.quantity = quantity;
    event.direction = direction;
    event.level = level;
    event.hold = hold;
    (void)dmb_model_add_event(model, &event, NULL);
}

/* Parts that are refused make the compile step fail with their message. */
static int32_t describe(dmb_model *model)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_input_def feed = dmb_input_def_default();
    bit.rock_law = DMB_ROCK_RATE;
    bit.bottom = 0.02;
    bit.intrinsic_energy = 1e8;
    pipe.damping_time = 1e-3;
    (void)dmb_model_add_pipes(model, &pipe, 10, NULL);
    (void)dmb_model_add_bit(model, &bit, NULL);
    (void)drive(model, DMB_DRIVE_CONTROL, DMB_RX, 12.0);
    feed.part = drive(model, DMB_DRIVE_MOTION, DMB_X, 0.02);
    feed.name[0] = 'f';
    feed.rate_limit = 0.1;
    (void)dmb_model_add_input(model, &feed, NULL);
    event(model, "the bit is on bottom", DMB_OUTPUT_WEIGHT_ON_BIT, DMB_EVENT_RISING, 1.0, 0.0);
    event(model, "torque above 690 N m", DMB_OUTPUT_ROTATION_TORQUE, DMB_EVENT_RISING, 690.0, 0.1);
    event(model, "the bit stands still", DMB_OUTPUT_BIT_SPEED, DMB_EVENT_FALLING, 0.5, 0.05);
    event(model, "the bit turns again", DMB_OUTPUT_BIT_SPEED, DMB_EVENT_RISING, 5.0, 0.3);
    return dmb_model_compile(model, NULL);
}

int main(int count, char **words)
{
    if (count > 1) return command_line(count, words, "Where does it happen?", NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id feed;
    dmb_event_report event = dmb_event_report_default();
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    while (status >= 0 && dmb_sim_time(sim) < 6.0) {
        status = dmb_sim_advance_to_event(sim, 6.0, &event, NULL);
        if (status == DMB_NOTE_EVENT) (void)printf("%s\n", dmb_sim_message(sim));
        if (status < 0 || (event.events & 4) == 0) continue;
        status = dmb_model_find_input(model, "f", &feed);
        if (status >= 0) status = dmb_sim_set_input(sim, feed, -0.005);
    }
    if (status < 0) (void)fprintf(stderr, "%s %s\n", dmb_model_message(model), dmb_sim_message(sim));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
