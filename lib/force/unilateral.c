/* Ends of unilateral laws in a step and their mean force (eq:unilateral.mean).
 *
 *     law                     x                       depth d                     closed
 *     ---------------------   ---------------------   -------------------------   -------------------------------
 *     stop                    joint coordinate        beyond the bound, signed    d is not 0
 *     spring of a joint       joint coordinate        0                           always
 *     spring between points   elongation              beyond slack; two-sided 0   elastic force or its slope is not 0
 *
 * V is the energy that the law stores, dV/dx the elastic force. Dampers of two-sided springs are no part of it. */
#include "force/unilateral.h"

#include <string.h>

#include "drillmbd/scene.h"

int dmb_stop_acts(const dmb_joint_law *law)
{
    return dmb_joint_stop_depth(law, 1e300) != 0.0 || dmb_joint_stop_depth(law, -1e300) != 0.0;
}

void dmb_stop_at(const dmb_joint_law *law, double place, dmb_unilateral_end *end)
{
    const double d = dmb_joint_stop_depth(law, place), k = law->stop_stiffness;
    memset(end, 0, sizeof *end);
    end->place = place;
    end->depth = d;
    end->closed = d != 0.0;
    if (!end->closed) return;
    end->energy = 0.5 * k * d * d;
    end->force = k * d;
    end->slope = k;
}

void dmb_joint_spring_end_at(const dmb_joint_law *law, double place, dmb_unilateral_end *end)
{
    const double x = place - law->rest, k = law->stiffness;
    const dmb_unilateral_end spring = {place, 0.0, 0.5 * k * x * x, k * x, k, 1, 0};
    *end = spring;
}

int dmb_spring_can_open(const dmb_spring_law *law)
{
    return law->acts != DMB_SPRING_BOTH || law->count > 0;
}

/* One-sided springs open at slack; a two-sided spring is open where its table and stiffness are 0. */
void dmb_spring_end_at(const dmb_spring_law *law, const dmb_spring_point *points, double elongation,
                       dmb_unilateral_end *end)
{
    dmb_spring_force f;
    memset(end, 0, sizeof *end);
    dmb_spring_force_at(law, points, elongation, 0.0, &f);
    end->place = elongation;
    end->energy = dmb_spring_energy_at(law, points, elongation);
    end->closed = f.elastic != 0.0 || f.by_elongation != 0.0;
    if (!end->closed) return;
    if (law->acts != DMB_SPRING_BOTH) end->depth = elongation - law->slack;
    end->force = f.elastic;
    end->slope = f.by_elongation;
}

/* Closed at the end but not at the start, or through from one bound to the other. */
int dmb_unilateral_touches(const dmb_unilateral_end *a, const dmb_unilateral_end *b)
{
    return b->closed && (!a->closed || a->depth * b->depth < 0.0);
}

/* 1 if a law that stays on one side would pull. The mean force is then 0, and the damper dissipates part of the stored
 * energy. */
static int pulls(const dmb_unilateral_end *a, const dmb_unilateral_end *b, double force)
{
    if (a->depth >= 0.0 && b->depth >= 0.0) return a->depth + b->depth > 0.0 && force < 0.0;
    return a->depth <= 0.0 && b->depth <= 0.0 && force > 0.0;
}

static dmb_mean_end mean_end_of(const dmb_unilateral_end *end)
{
    const dmb_mean_end to = {end->place, end->energy, end->force, end->slope};
    return to;
}

/* G = (V1 - V0)/(x1 - x0) + c (d1 - d0)/h; by_place is its derivative by x1. G (x1 - x0) is the energy that the bodies
 * lose (eq:unilateral.energy), so that what the law does not store of it is dissipated. */
void dmb_unilateral_mean_of(const dmb_unilateral_end *a, const dmb_unilateral_end *b, double damping, double step,
                            dmb_unilateral_mean *mean)
{
    const dmb_mean_end from = mean_end_of(a), to = mean_end_of(b);
    dmb_mean_elastic(&from, &to, &mean->force, &mean->by_place);
    mean->force += damping * (b->depth - a->depth) / step;
    if (b->closed) mean->by_place += damping / step;
    if (pulls(a, b, mean->force)) mean->force = mean->by_place = 0.0;
    mean->dissipated = mean->force * (b->place - a->place) - (b->energy - a->energy);
}
