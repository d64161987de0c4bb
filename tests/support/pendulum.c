#include "pendulum.h"

#include "check.h"
#include "ode.h"

const pendulum_place pendulum_from_the_side[3] = {
    {1.0, 0.9862917511, -0.1650108531}, {5.0, -0.9423054350, -0.3347543384}, {10.0, -0.2750874626, -0.9614192051}};

static void rate_of(void *context, double t, const double *y, double *rate)
{
    (void)t;
    rate[0] = y[1];
    rate[1] = -*(const double *)context * sin(y[0]);
}

void pendulum_solve(double g, double t, double state[2])
{
    ode_solve(rate_of, &g, 0.0, t, 400, 2, state);
}

double pendulum_pattern_step(uint32_t steps, uint32_t i)
{
    static const double pattern[4] = {1.0, 3.0, 0.5, 2.0};
    return 8.0 / steps * pattern[i % 4] / 1.625;
}

void check_pendulum_pattern(double (*error_of)(uint32_t steps))
{
    static const double want[4] = {3.85e-4, 9.63e-5, 2.41e-5, 6.02e-6};
    double error[4];
    for (uint32_t k = 0; k < 4; k++) {
        error[k] = error_of(400u << k);
        check_relative("steps 1:3:.5:2, error over that of the reference", error[k], want[k], 0.01);
        if (k > 0) check_order("    order", error[k - 1], error[k], 2.0, 0.01);
    }
}
