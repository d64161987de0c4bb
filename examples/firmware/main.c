/* How does a controller without operating system run the model, with memory that is fixed when it is linked?
 *
 * The scene record (rig.h, made by `drillmbd save rig.toml rig.h`) lies in read-only memory, the model and its sim in a
 * pool, and each step of 1 ms has bounded work. pkgconfig/amalgamate makes the library two files for such a target:
 *
 *     pkgconfig/amalgamate two
 *     arm-none-eabi-gcc -mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard -std=c11 -Os -ffp-contract=off \
 *         -DFIRMWARE -Itwo -c examples/firmware/main.c two/drillmbd.c
 *
 * There, print_state writes to a serial line, and main waits for the timer before each step. */
#ifdef FIRMWARE
#include "drillmbd.h"
#else
#include <drillmbd/drillmbd.h>

#include "../command_line.h"
#endif
#include <stdio.h>

#include "rig.h"

static unsigned char memory[256 * 1024]; /* dmb_pool_peak prints how much of it is used */

typedef struct machine {
    dmb_allocator pool;
    dmb_model *model;
    dmb_sim *sim;
    dmb_id speed, table;
} machine;

static int32_t open_machine(machine *m)
{
    dmb_model_options options = dmb_model_options_default();
    dmb_sim_options settings = dmb_sim_options_default();
    int32_t status = dmb_pool_allocator(memory, sizeof memory, &m->pool);
    options.allocator = &m->pool;
    settings.bounded_work = 1;
    settings.max_iterations = 4;
    if (status >= 0) status = dmb_model_read(rig, sizeof rig, &options, &m->model);
    if (status >= 0) status = dmb_model_find(m->model, DMB_PART_INPUT, "speed", &m->speed);
    if (status >= 0) status = dmb_model_find(m->model, DMB_PART_DRIVE, "table", &m->table);
    if (status >= 0) status = dmb_model_compile(m->model, NULL);
    if (status >= 0) status = dmb_sim_create(m->model, &settings, &m->sim);
    return status;
}

static void print_state(const machine *m)
{
    const dmb_place at = {m->table, 0, 0, 0.0};
    printf("%4.1f s: %6.2f rad/s, %7.1f N m\n", dmb_sim_time(m->sim), dmb_sim_value(m->sim, DMB_OUTPUT_DRIVE_SPEED, at),
           dmb_sim_value(m->sim, DMB_OUTPUT_DRIVE_FORCE, at));
}

int main(int count, char **words)
{
#ifndef FIRMWARE
    if (count > 1)
        return command_line(count, words, "A scene record in read-only memory, run with fixed memory and bounded work.",
                            NULL, 0);
#else
    (void)count, (void)words;
#endif
    machine m = {{0}, NULL, NULL, {0, 0}, {0, 0}};
    int32_t status = open_machine(&m);
    for (int i = 0; i < 1000 && status >= 0; ++i) {
        if (i == 0) status = dmb_sim_set_input(m.sim, m.speed, 12.0);
        if (i == 700) status = dmb_sim_set_input(m.sim, m.speed, 0.0);
        if (status >= 0) status = dmb_sim_step(m.sim, 1e-3, NULL);
        if (status >= 0 && i % 100 == 99) print_state(&m);
    }
    if (status < 0) {
        dmb_error error = dmb_error_default();
        (void)dmb_last_error(&error);
        printf("%s\n", error.message);
    } else {
        printf("pool: %zu bytes\n", dmb_pool_peak(&m.pool));
    }
    dmb_sim_destroy(&m.sim);
    dmb_model_destroy(&m.model);
    return status < 0;
}
