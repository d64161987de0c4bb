/* Weight and torque on a bit by the depth of cut (eq:bit.forces), with exact derivatives by U, V, Phi and Omega.
 *
 *     law            depth of cut d per revolution                        rock surface
 *     ------------   --------------------------------------------------   ---------------------------------------------
 *     rate           2 pi V/Omega g (eq:bit.rate)                         one number, the bottom
 *     regenerative   n times the cut of one blade (eq:bit.regenerative)   function of the angle, kept in a ring buffer
 *
 * Both fade below DMB_BIT_SPIN_FLOOR, so that forces and derivatives are continuous through rest (bit.md, "Spin near
 * zero"). */
#include "force/bit_rock.h"

#include <math.h>
#include <stddef.h>

#include "math/real.h"

enum { CAPACITY_MIN = 16, SPARE_SAMPLES = 8 };
#define DMB_LEDGE_STEPS 4.0 /* [-] angle_steps over which the step in the rock surface behind the blade is smoothed */

/* S(x) = x^2 (3 - 2x) on 0 .. 1, 0 before, 1 after */
static double ramp(double x, double *slope)
{
    *slope = 0.0;
    if (x <= 0.0) return 0.0;
    if (x >= 1.0) return 1.0;
    *slope = 6.0 * x * (1.0 - x);
    return x * x * (3.0 - 2.0 * x);
}

/* sign(Omega), replaced by x (3 - x^2)/2 within the spin floor, x = Omega/floor */
static double spin_sign(double omega, double *slope)
{
    const double x = omega / DMB_BIT_SPIN_FLOOR;

    *slope = 0.0;
    if (fabs(x) >= 1.0) return x > 0.0 ? 1.0 : -1.0;
    *slope = 1.5 * (1.0 - x * x) / DMB_BIT_SPIN_FLOOR;
    return 0.5 * x * (3.0 - x * x);
}

/* 1/Omega for forward rotation, faded to 0 within the spin floor */
static double inverse_spin(double omega, double *slope)
{
    const double x = omega / DMB_BIT_SPIN_FLOOR;

    *slope = 0.0;
    if (x <= 0.0) return 0.0;
    if (x >= 1.0) {
        *slope = -1.0 / (omega * omega);
        return 1.0 / omega;
    }
    *slope = x * (8.0 - 9.0 * x) / (DMB_BIT_SPIN_FLOOR * DMB_BIT_SPIN_FLOOR);
    return x * x * (4.0 - 3.0 * x) / DMB_BIT_SPIN_FLOOR;
}

/* ---- History ----------------------------------------------------------------------------------------------------- */

void dmb_bit_history_pace(dmb_bit_history *history, uint32_t blades)
{
    const uint32_t capacity = history->capacity;
    history->spacing = DMB_TWO_PI / (double)blades;
    history->angle_step =
        capacity > SPARE_SAMPLES ? history->spacing / (double)(capacity - SPARE_SAMPLES) : history->spacing;
}

int32_t dmb_bit_history_init(dmb_bit_history *history, const dmb_bit_rock_law *law, double phi, double bottom)
{
    if (history->angle == NULL || history->surface == NULL) return DMB_ERR_NULL;
    if (history->capacity < CAPACITY_MIN || law->blades == 0) return DMB_ERR_VALUE;
    dmb_bit_history_pace(history, law->blades);
    history->head = 0;
    history->count = 1;
    history->reserved = 0;
    history->offset = 0.0;
    history->angle[0] = phi;
    history->surface[0] = bottom;
    return DMB_OK;
}

/* Index in the ring buffer of sample i; sample 0 is the oldest. */
static uint32_t place(const dmb_bit_history *history, uint32_t i)
{
    const uint32_t at = history->head + 1 + i;

    return at >= history->count ? at - history->count : at + history->capacity - history->count;
}

/* Surface at a recorded angle: linear between samples, constant beyond the first and the last one. */
static double surface_at(const dmb_bit_history *history, double angle, double *slope)
{
    uint32_t low = 0;
    uint32_t high = history->count;

    while (low < high) { /* number of samples at or before angle */
        const uint32_t middle = low + (high - low) / 2;
        if (history->angle[place(history, middle)] <= angle)
            low = middle + 1;
        else
            high = middle;
    }
    *slope = 0.0;
    if (low == 0) return history->surface[place(history, 0)];
    if (low == history->count) return history->surface[history->head];
    const uint32_t a = place(history, low - 1);
    const uint32_t b = place(history, low);
    *slope = (history->surface[b] - history->surface[a]) / (history->angle[b] - history->angle[a]);
    return history->surface[a] + *slope * (angle - history->angle[a]);
}

/* Ahead of the newest sample the blade meets the surface one blade spacing before. Behind it, after reverse rotation,
 * the surface is that of the blade's own last pass; over DMB_LEDGE_STEPS samples it is blended with the former, because
 * the step between both would be a jump of the force. */
double dmb_bit_history_surface(const dmb_bit_history *history, double Phi, double *slope)
{
    const double newest = history->angle[history->head];
    const double width = DMB_LEDGE_STEPS * history->angle_step;
    double angle = Phi + history->offset;

    if (angle < newest - history->spacing) /* turned back by more than a blade since the last accepted step */
        angle += history->spacing * floor((newest - angle) / history->spacing);
    const double before = surface_at(history, angle - history->spacing, slope);
    if (!(angle < newest)) return before;
    const double slope_before = *slope;
    double slope_last, blend_slope;
    const double last = surface_at(history, angle, &slope_last);
    const double blend = ramp((newest - angle) / width, &blend_slope);
    *slope = slope_before + blend * (slope_last - slope_before) - blend_slope / width * (last - before);
    return before + blend * (last - before);
}

/* A pass that stays above the rock leaves the surface as it was: fmax(U, before). After reverse rotation by more than a
 * blade spacing another blade is in the place of this one: `offset` counts it. */
void dmb_bit_history_record(dmb_bit_history *history, double Phi, double U)
{
    const double newest = history->angle[history->head];
    const double angle = Phi + history->offset;

    if (angle < newest - history->spacing) {
        history->offset += history->spacing * floor((newest - angle) / history->spacing);
        return;
    }
    if (!(angle - newest >= history->angle_step)) return;
    double slope;
    const double before = surface_at(history, angle - history->spacing, &slope);
    history->head = (history->head + 1) % history->capacity;
    if (history->count < history->capacity) history->count += 1;
    history->angle[history->head] = angle;
    history->surface[history->head] = fmax(U, before);
}

/* ---- Forces ------------------------------------------------------------------------------------------------------ */

double dmb_bit_rock_bottom(const dmb_bit_rock_law *law, double bottom, double U)
{
    return fmax(bottom, U - law->intrusion_depth);
}

/* A scalar with its derivatives with respect to U, V, Phi, Omega. */
struct jet {
    double value, d[4];
};

/* Rock must not do positive work (eq:bit.no-work). On a bit that is pulled back, the regenerative law would push like a
 * spring over the remaining depth of cut of its blades, and return more energy than the rotation supplies. Therefore W
 * is limited so that W V + T Omega >= - v W, v = DMB_BIT_REBOUND. W is that of the law up to a speed of v + T Omega/W,
 * which without wear flats is v + (a + b) Omega/(2 zeta), and falls as 1/|V| beyond. The term with v permits a bit that
 * does not rotate to rest on the rock. */
static void give_no_work(double V, double omega, dmb_bit_rock_result *out)
{
    const double power = out->torque_on_bit * omega + out->weight_on_bit * DMB_BIT_REBOUND;
    if (!(V < 0.0) || !(out->weight_on_bit * -V > power)) return;
    out->dW_dU = -(out->dT_dU * omega + out->dW_dU * DMB_BIT_REBOUND) / V;
    out->dW_dV = -(out->dT_dV * omega + out->dW_dV * DMB_BIT_REBOUND) / V + power / (V * V);
    out->dW_dPhi = -(out->dT_dPhi * omega + out->dW_dPhi * DMB_BIT_REBOUND) / V;
    out->dW_dOmega = -(out->torque_on_bit + out->dT_dOmega * omega + out->dW_dOmega * DMB_BIT_REBOUND) / V;
    out->weight_on_bit = -power / V;
}

/* Forces from depth of cut and engagement; by the chain rule the same formula applies to each derivative. */
static void assemble(const dmb_bit_rock_law *law, const struct jet *depth, const struct jet *grip, double omega,
                     dmb_bit_rock_result *out)
{
    double *const weight_d[4] = {&out->dW_dU, &out->dW_dV, &out->dW_dPhi, &out->dW_dOmega};
    double *const torque_d[4] = {&out->dT_dU, &out->dT_dV, &out->dT_dPhi, &out->dT_dOmega};
    const double width = law->radius - law->inner_radius, mean = law->radius + law->inner_radius; /* a - b, a + b */
    const double flat = width * law->contact_strength * law->wear_length;                         /* sigma (a - b) l */
    const double flat_torque = 0.5 * mean * law->contact_friction * flat;  /* mu gamma sigma (a^2 - b^2) l/2 */
    const double cut = law->cutting_ratio * law->intrinsic_energy * width; /* zeta eps (a - b) */
    const double cut_torque = 0.5 * law->intrinsic_energy * width * mean;  /* eps (a^2 - b^2)/2 */
    double sign_slope;
    const double sign = spin_sign(omega, &sign_slope);

    out->weight_on_bit = cut * depth->value + flat * grip->value;
    out->torque_on_bit = cut_torque * depth->value + flat_torque * grip->value * sign;
    for (int i = 0; i < 4; ++i) {
        *weight_d[i] = cut * depth->d[i] + flat * grip->d[i];
        *torque_d[i] = cut_torque * depth->d[i] + flat_torque * grip->d[i] * sign;
    }
    out->dT_dOmega += flat_torque * grip->value * sign_slope;
    out->depth_of_cut = depth->value;
}

/* g and d of eq:bit.rate as functions with derivatives: U enters by the engagement alone. The torque grows as 1/Omega,
 * so that near rest a step longer than eq:bit.rate-limit has no solution. */
static void rate_law(const dmb_bit_rock_law *law, double intrusion, double V, double omega, dmb_bit_rock_result *out)
{
    double grip_slope, inverse_slope;
    const double grip = ramp(intrusion / law->intrusion_depth, &grip_slope);
    const double inverse = inverse_spin(omega, &inverse_slope);
    const double advance = V <= 0.0 ? 0.0 : DMB_TWO_PI * V;
    const struct jet g = {grip, {grip_slope / law->intrusion_depth, 0.0, 0.0, 0.0}};
    const struct jet d = {grip * advance * inverse,
                          {g.d[0] * advance * inverse, V <= 0.0 ? 0.0 : grip * DMB_TWO_PI * inverse, 0.0,
                           grip * advance * inverse_slope}};

    assemble(law, &d, &g, omega, out);
}

/* d_n of eq:bit.regenerative is the intrusion below the surface; Phi enters by the slope of the surface. */
static void regenerative_law(const dmb_bit_rock_law *law, double intrusion, double surface_slope, double omega,
                             dmb_bit_rock_result *out)
{
    const double n = (double)law->blades;
    double grip_slope, fade_slope;
    const double grip = ramp(intrusion / law->intrusion_depth, &grip_slope);
    const double fade = ramp(omega / DMB_BIT_SPIN_FLOOR, &fade_slope);
    const double per_depth = grip_slope / law->intrusion_depth;
    const struct jet g = {grip, {per_depth, 0.0, -per_depth * surface_slope, 0.0}};
    const struct jet d = {n * intrusion * fade,
                          {n * fade, 0.0, -n * surface_slope * fade, n * intrusion * fade_slope / DMB_BIT_SPIN_FLOOR}};

    assemble(law, &d, &g, omega, out);
}

/* Off the rock all forces are 0. The limit of eq:bit.no-work is applied to the regenerative law alone; the rate law has
 * no depth of cut for V < 0. */
void dmb_bit_rock_force(const dmb_bit_rock_law *law, const dmb_bit_history *history, double bottom, double U, double V,
                        double Phi, double Omega, dmb_bit_rock_result *out)
{
    static const dmb_bit_rock_result nothing = {0};
    const int regenerative = law->kind == DMB_ROCK_REGENERATIVE && history != NULL;
    double slope = 0.0;

    *out = nothing;
    if (law->kind == DMB_ROCK_NONE) return;
    const double surface = regenerative ? dmb_bit_history_surface(history, Phi, &slope) : bottom;
    const double intrusion = U - surface;
    if (intrusion <= 0.0) return;
    out->on_bottom = 1;
    if (!regenerative) {
        rate_law(law, intrusion, V, Omega, out);
        return;
    }
    regenerative_law(law, intrusion, slope, Omega, out);
    give_no_work(V, Omega, out);
}
