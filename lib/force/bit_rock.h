/* Bit-rock interaction: weight and torque on the bit from cutting and from the wear flat.
 * eq:bit.rate (rate law) and eq:bit.regenerative (regenerative law). U [m] is the advance of
 * the bit along the hole's axis from its starting point, V = dU/dt, Phi [rad] its unwrapped spin angle, Omega =
 * dPhi/dt, positive in the drilling sense. Pure functions, except those that write the history. */
#ifndef DMB_FORCE_BIT_ROCK_H
#define DMB_FORCE_BIT_ROCK_H

#include <math.h>
#include <stdint.h>

#include "drillmbd/scene.h"

/* [rad/s] Below this spin the laws are reduced smoothly towards rest: cutting ends at Omega = 0 and the torque of the
 * wear flat changes sign smoothly. Above it they are exact. 0.5 rpm. */
#define DMB_BIT_SPIN_FLOOR 0.05
/* [m/s] Largest speed at which wear flats and blades can push a bit back without rotation. */
#define DMB_BIT_REBOUND 1e-3

typedef struct dmb_bit_rock_law {
    int32_t kind;            /* DMB_ROCK_... */
    uint32_t blades;         /* [-] n >= 1 */
    double radius;           /* [m] a */
    double intrinsic_energy; /* [Pa] eps */
    double cutting_ratio;    /* [-] zeta */
    double contact_strength; /* [Pa] sigma */
    double wear_length;      /* [m] l, summed over the blades */
    double contact_friction; /* [-] mu gamma */
    double intrusion_depth;  /* [m] > 0, depth over which the contact force builds up */
    double inner_radius;     /* [m] b */
} dmb_bit_rock_law;

/* Rock surface left by the last blade, over the bit angle at which it was cut. The arrays belong to the caller (ring
 * buffers of `capacity`). head, count and offset change in dmb_bit_history_record only, so that a snapshot consists of
 * this struct and the two arrays. */
typedef struct dmb_bit_history {
    double *angle;     /* [rad] strictly increasing from oldest to newest, shape (capacity) */
    double *surface;   /* [m] advance of the rock surface, shape (capacity) */
    uint32_t capacity; /* [-] >= 16 */
    uint32_t head;     /* [-] index of the newest sample */
    uint32_t count;    /* [-] samples stored, 1 .. capacity */
    uint32_t reserved;
    double angle_step; /* [rad] smallest distance of samples, (2 pi/n)/(capacity - 8) */
    double spacing;    /* [rad] angle between blades 2 pi/n */
    double offset;     /* [rad] whole blade spacings added to Phi after reverse rotation */
} dmb_bit_history;

typedef struct dmb_bit_rock_result {
    double weight_on_bit;                    /* [N] force on the bit against its advance, >= 0 */
    double torque_on_bit;                    /* [N m] torque on the bit against positive spin */
    double depth_of_cut;                     /* [m] per revolution, all blades; as it enters the forces */
    double dW_dU, dW_dV, dW_dPhi, dW_dOmega; /* [N/m, N s/m, N/rad, N s/rad] */
    double dT_dU, dT_dV, dT_dPhi, dT_dOmega; /* [N, N s, N m/rad, N m s/rad] */
    int32_t on_bottom;                       /* [-] 1 while the bit touches rock */
    int32_t reserved;
} dmb_bit_rock_result;

/* [m] Advance at which rock begins after a step accepted at U: max(bottom, U - intrusion_depth). Rate law only. */
double dmb_bit_rock_bottom(const dmb_bit_rock_law *law, double bottom, double U);

/* Forces (eq:bit.forces) and exact derivatives at one instant: W = zeta eps a d + sigma a l g [N] and T = eps a^2 d/2 +
 * mu gamma sigma a^2 l g/2 [N m], with a - b instead of a and a^2 - b^2 instead of a^2 if the face is annular, at depth
 * of cut d [m] and engagement g. RATE (also REGENERATIVE without history): g = S((U - bottom)/intrusion_depth) with
 * S(x) = x^2 (3 - 2x) on 0 .. 1, and d = g 2 pi max(V, 0)/Omega; bottom is updated by dmb_bit_rock_bottom, so g = 1 in
 * steady drilling. On touching, the full force builds up within intrusion_depth; after lifting beyond it the force is
 * 0.
 *   Below the spin floor O, 1/Omega is replaced by x^2 (4 - 3x)/O, x = Omega/O (value and slope continuous).
 * REGENERATIVE: per blade d_n = max(0, U - surface under the blade), g = S(d_n/intrusion_depth), d = n d_n times
 *   S(Omega/O). `bottom` is not used. For a bit that is pulled back (V < 0), W is limited so that the rock does no
 *   positive work: W V + T Omega >= - W DMB_BIT_REBOUND.
 * Both: no cutting for Omega <= 0 or d < 0; the wear flat's torque is against the spin, times x (3 - x^2)/2 below the
 *   floor. The force on a bit without rotation is at most sigma a l g. Off bottom everything is 0. */
void dmb_bit_rock_force(const dmb_bit_rock_law *law, const dmb_bit_history *history, double bottom, double U, double V,
                        double Phi, double Omega, dmb_bit_rock_result *out);

/* Sets spacing and angle_step from the number of blades and the capacity. */
void dmb_bit_history_pace(dmb_bit_history *history, uint32_t blades);
/* Starts a history over flat rock at advance `bottom` [m], with the bit at angle phi. angle, surface and capacity must
 * be set. Uses blades of the law. Errors: DMB_ERR_NULL, DMB_ERR_VALUE (capacity below 16, no blades). */
int32_t dmb_bit_history_init(dmb_bit_history *history, const dmb_bit_rock_law *law, double phi, double bottom);

/* After an accepted step: stores max(U, surface before) if Phi has advanced by at least angle_step since the newest
 * sample. Angles passed in reverse rotation are not stored. The blades are equal, so the rock surface repeats every 2
 * pi/n: if Phi has decreased by more than that, whole spacings are added to it (offset). Forward rotation then
 * continues the history within one blade spacing, however many turns were unwound. */
void dmb_bit_history_record(dmb_bit_history *history, double Phi, double U);

/* [m] Rock surface under the blades at bit angle Phi, and its slope [m/rad]. Ahead of the newest sample it is S(Phi - 2
 * pi/n), linear between samples. Behind it (reverse rotation) it is S(Phi), the last pass over that angle, blended in
 * over four angle_steps. Beyond either end of the samples it is the surface of that end, initially the initial bottom.
 */
double dmb_bit_history_surface(const dmb_bit_history *history, double Phi, double *slope);

/* ---- Side cutting ------------------------------------------------------------------------------------------------ */

/* Side cutting of a bit (eq:bit.side). Per revolution a bit cuts W/(zeta eps a) deep along its axis under a force W.
 * Under the same lateral force it cuts `steerability` times as deep sideways, in a direction rotated by the walk angle
 * psi about the axis:
 *
 *     v = steerability w/(2 pi zeta eps a) Rot(psi) F,   w = sqrt(Omega^2 + O^2)
 *
 * O is the spin below which the laws are reduced (DMB_BIT_SPIN_FLOOR): a bit without rotation creeps as at O. The
 * inverse is the force of the rock on the bit, -D/w Rot(-psi) v, D = 2 pi zeta eps a/steerability, which dissipates D/w
 * cos psi |v|^2. */
typedef struct dmb_side_law {
    double resistance; /* [N rad/m] D; 0: no side cutting and no side force */
    double cosine, sine;
} dmb_side_law;

typedef struct dmb_side_force {
    double force[2];   /* [N] on the bit, y and z */
    double eta;        /* [N s/m] D/w */
    double by_spin[2]; /* [N s/rad] derivative of force by Omega */
} dmb_side_force;

static inline void dmb_side_force_at(const dmb_side_law *law, const double v[2], double spin, dmb_side_force *out)
{
    const double squared = spin * spin + DMB_BIT_SPIN_FLOOR * DMB_BIT_SPIN_FLOOR;
    out->eta = law->resistance / sqrt(squared);
    out->force[0] = -out->eta * (law->cosine * v[0] + law->sine * v[1]);
    out->force[1] = -out->eta * (law->cosine * v[1] - law->sine * v[0]);
    out->by_spin[0] = -out->force[0] * spin / squared;
    out->by_spin[1] = -out->force[1] * spin / squared;
}

#endif
