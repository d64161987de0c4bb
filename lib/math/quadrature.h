/* Integration points on [0,1], of Gauss and of Lobatto. */
#ifndef DMB_MATH_QUADRATURE_H
#define DMB_MATH_QUADRATURE_H

#include <stdint.h>

/* Gauss-Legendre: n points integrate polynomials up to degree 2n-1 exactly. */

typedef struct dmb_gauss_rule {
    int count;
    double node[5];
    double weight[5];
} dmb_gauss_rule;

/* The rule with n = 2..5 points, NULL for any other n. */
static inline const dmb_gauss_rule *dmb_gauss(int n)
{
    static const dmb_gauss_rule rule[4] = {
        {2, {0.21132486540518711, 0.78867513459481287}, {0.5, 0.5}},
        {3,
         {0.11270166537925831, 0.5, 0.88729833462074170},
         {0.27777777777777778, 0.44444444444444444, 0.27777777777777778}},
        {4,
         {0.069431844202973714, 0.33000947820757187, 0.66999052179242813, 0.93056815579702634},
         {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693}},
        {5,
         {0.046910077030668004, 0.23076534494715845, 0.5, 0.76923465505284150, 0.95308992296933204},
         {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324, 0.11846344252809454}},
    };
    return (n >= 2 && n <= 5) ? &rule[n - 2] : (const dmb_gauss_rule *)0;
}

/* Gauss-Lobatto rules on [0,1]: n points, including both ends, integrate polynomials up to degree 2n-3 exactly. */

enum { DMB_LOBATTO_MOST = 5 };

typedef struct dmb_lobatto_rule {
    int count;
    double node[DMB_LOBATTO_MOST];
    double weight[DMB_LOBATTO_MOST];
} dmb_lobatto_rule;

/* The rule with n = 3..5 points (Abramowitz, Stegun, 25.4.32), NULL for any other n. */
static inline const dmb_lobatto_rule *dmb_lobatto(uint32_t n)
{
    static const dmb_lobatto_rule rule[3] = {
        {3, {0.0, 0.5, 1.0}, {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0}},
        {4, {0.0, 0.27639320225002103, 0.72360679774997897, 1.0}, {1.0 / 12.0, 5.0 / 12.0, 5.0 / 12.0, 1.0 / 12.0}},
        {5,
         {0.0, 0.17267316464601142, 0.5, 0.82732683535398858, 1.0},
         {1.0 / 20.0, 49.0 / 180.0, 16.0 / 45.0, 49.0 / 180.0, 1.0 / 20.0}},
    };
    return n >= 3 && n <= DMB_LOBATTO_MOST ? &rule[n - 3] : (const dmb_lobatto_rule *)0;
}

#endif
