/* Seen from outside, in axes that do not turn. The string slides on the wall, a little up its side, with the friction
 * that this takes; eccentric masses, which would be out of balance, are left out. */
#include "campbell.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"
#include "tables.h"

/* Residual over the forces that balance: the rest slips around the hole's axis, the string turns about its own. */
#define TILT 1e-3

const char *const kind_names[KINDS] = {"axial", "torsional", "lateral"};

int kind_of(const dmb_mode *mode)
{
    int most = 0;
    for (int k = 1; k < KINDS; k++)
        if (mode->share[k] > mode->share[most]) most = k;
    return most;
}

void campbell_prepare(campbell *c, uint32_t pipes, int number, double highest)
{
    memset(c, 0, sizeof *c);
    c->pipes = pipes;
    c->rpm = LOW_RPM + (HIGH_RPM - LOW_RPM) * number / (CAMPBELL_SPEEDS - 1);
    c->highest = highest;
}

static int32_t find_modes(campbell *c, dmb_sim *sim)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes_info info = dmb_modes_info_default();
    dmb_modes *modes = NULL;
    options.kind = DMB_MODES_DAMPED;
    options.select = DMB_MODES_BAND;
    options.band[1] = c->highest;
    options.axes = DMB_MODES_AXES_AT_REST;
    options.spin = c->rpm / RPM;
    options.equilibrium_tolerance = TILT;
    int32_t status = dmb_analysis_modes(sim, &options, &modes);
    if (status >= 0) status = dmb_modes_get_info(modes, &info);
    if (status >= 0) c->modes = calloc((size_t)info.count + 1, sizeof *c->modes);
    if (status >= 0 && c->modes == NULL) status = DMB_ERR_NO_MEMORY;
    for (uint32_t i = 0; i < info.count && status >= 0; i++) {
        dmb_mode *mode = c->modes + c->count;
        *mode = dmb_mode_default();
        status = dmb_modes_get(modes, i, mode);
        c->count += !mode->rigid && mode->eigenvalue[1] > 0.0; /* what swings */
    }
    dmb_modes_destroy(&modes);
    return status;
}

void campbell_find(campbell *c)
{
    speeds_scene scene;
    memset(&scene, 0, sizeof scene);
    c->status = speeds_scene_make(c->pipes, 0.0, c->rpm / RPM, &scene);
    if (c->status >= 0) c->status = find_modes(c, scene.sim);
    if (c->status < 0) (void)snprintf(c->message, sizeof c->message, "%s", speeds_scene_message(&scene));
    speeds_scene_free(&scene);
}

/* ---- Report ------------------------------------------------------------------------------------------------------ */

static const dmb_mode *first_of_kind(const campbell *c, int kind)
{
    for (uint32_t i = 0; i < c->count; i++)
        if (kind_of(c->modes + i) == kind) return c->modes + i;
    return NULL;
}

static void print_speed(const campbell *c)
{
    printf("    %5.1f", c->rpm);
    for (int kind = KINDS - 1; kind >= 0; kind--) {
        const dmb_mode *mode = first_of_kind(c, kind);
        if (mode != NULL)
            printf("   %10.4f", mode->frequency);
        else
            printf("            -");
    }
    printf("\n");
}

void campbell_print(const campbell *all)
{
    printf("Natural frequencies at %u m while the string turns, up to %g Hz\n", (unsigned)all->pipes, all->highest);
    printf("      rpm      lateral    torsional        axial, the lowest of each [Hz]\n");
    for (int i = 0; i < CAMPBELL_SPEEDS; i++) {
        if (all[i].status < 0)
            printf("    %5.1f   %s: %s\n", all[i].rpm, dmb_status_name(all[i].status), all[i].message);
        else
            print_speed(all + i);
    }
}

int campbell_write(const char *folder, const campbell *all)
{
    FILE *file = open_table(folder, "campbell.csv", "depth [m],speed [rpm],frequency [Hz],damping,whirl,kind");
    if (file == NULL) return 1;
    for (int i = 0; i < CAMPBELL_SPEEDS; i++)
        for (uint32_t k = 0; k < all[i].count; k++) {
            const dmb_mode *mode = all[i].modes + k;
            fprintf(file, "%u,%.3f,%.6g,%.4g,%.4g,%s\n", (unsigned)all[i].pipes, all[i].rpm, mode->frequency,
                    mode->damping, mode->whirl, kind_names[kind_of(mode)]);
        }
    return fclose(file) != 0;
}
