/* Natural frequencies of the string while it turns, at one depth and several speeds. */
#ifndef SAFE_SPEEDS_CAMPBELL_H
#define SAFE_SPEEDS_CAMPBELL_H

#include <drillmbd/drillmbd.h>

enum { CAMPBELL_SPEEDS = 10, KINDS = 3 };
extern const char *const kind_names[KINDS];

typedef struct campbell {
    uint32_t pipes, count;
    double rpm, highest; /* [Hz] looked for up to here */
    int32_t status;
    char message[256];
    dmb_mode *modes; /* shape (count), the caller's to free */
} campbell;

/* Axial, torsional or lateral: what most of its kinetic energy is. */
int kind_of(const dmb_mode *mode);

/* `pipes` sets the depth, `number` the speed (0 .. CAMPBELL_SPEEDS - 1), `highest` the end of the band [Hz]. */
void campbell_prepare(campbell *c, uint32_t pipes, int number, double highest);
void campbell_find(campbell *c);
void campbell_print(const campbell *all);
int campbell_write(const char *folder, const campbell *all);

#endif
