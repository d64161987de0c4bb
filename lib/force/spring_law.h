/* Force of a spring and damper along the line between two points. e = elongation beyond the free length [m], s = its
 * rate [m/s], tension > 0:
 *
 *     elastic p + k e + T(e), p preload, T a table, straight lines or a monotone cubic through its points;
 *     damper  c s
 *
 * TENSION: the elastic force acts where it pulls, from the elongation `slack` on, and the damper there too, as long as
 * the sum pulls; COMPRESSION: likewise where they push. A one-sided characteristic never falls, so there is one slack.
 * Beyond its ends a table goes on along its last slope. The cubic is that of Fritsch and Butland 1984 (harmonic means
 * of the neighbouring slopes, 0 at extrema): monotone data stay monotone, and T' is continuous. */
#ifndef DMB_FORCE_SPRING_LAW_H
#define DMB_FORCE_SPRING_LAW_H

#include <stdint.h>

typedef struct dmb_spring_point {
    double elongation; /* [m] */
    double force;      /* [N] */
    double slope[2];   /* [N/m] of the piece behind it, at its begin and at its end */
    double energy;     /* [J] integral of T from the first point */
} dmb_spring_point;

typedef struct dmb_spring_law {
    double stiffness, damping, preload;
    double slack;          /* [m] elongation at which a one-sided force begins */
    double zero;           /* [J] integral of the table at elongation 0, or at slack */
    uint32_t first, count; /* its points */
    int32_t acts;          /* DMB_SPRING_... */
    int32_t reserved;
} dmb_spring_law;

typedef struct dmb_spring_force {
    double elastic, damper;         /* [N] tension > 0 */
    double by_elongation, by_speed; /* [N/m, N s/m] of their sum */
} dmb_spring_force;

/* Slopes and energies of count >= 2 points with elongations that increase; cubic 0: straight lines. */
void dmb_spring_table_prepare(dmb_spring_point *points, uint32_t count, int cubic);
/* slack and zero of a law; points: its own. 0: a one-sided force that begins nowhere or everywhere. */
int dmb_spring_law_prepare(dmb_spring_law *law, const dmb_spring_point *points);
/* points: its own, may be NULL where count is 0 */
void dmb_spring_force_at(const dmb_spring_law *law, const dmb_spring_point *points, double elongation, double speed,
                         dmb_spring_force *force);
/* [J] integral of the elastic force from elongation 0, of a one-sided one from slack */
double dmb_spring_energy_at(const dmb_spring_law *law, const dmb_spring_point *points, double elongation);

#endif
