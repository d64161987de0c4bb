/* Gauss-Lobatto rules on [0,1]: n points, both ends among them, integrate polynomials up to degree 2n-3 exactly. */
#ifndef DMB_MATH_LOBATTO_H
#define DMB_MATH_LOBATTO_H

#include <stdint.h>

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
