/* A scene seen from elsewhere: turned, moved, mirrored, in other units. Plain data in, plain data out. */
#ifndef DMB_RELATIONS_SCENE_TRANSFORM_H
#define DMB_RELATIONS_SCENE_TRANSFORM_H

#include "matrix3.h"
#include "scene_draw.h"

/* x' = length (P x + shift). Lengths come out in units of 1/length metres, masses in units of 1/mass kilograms; seconds
 * and radians stay. P is a rotation, or one times a mirror: handed is its determinant, 1 or -1. */
typedef struct scene_view {
    double matrix[9]; /* [-] P, row by row */
    double shift[3];  /* [m] */
    double length, mass;
    double handed;
    int32_t halved;      /* pipes of two elements become two pipes of one each */
    int32_t doubled;     /* each joint is held a second time, by the joint as many numbers later */
    int32_t motion_only; /* sections, contacts and supports are not compared */
} scene_view;

scene_view view_identity(void);
scene_view view_turned(const double rotation[3]);

/* [rad] angle about its axis between the frame that the library gives string k of the transformed scene and that of the
 * original one, transformed: strings in a hole start with a y axis that is horizontal in the world. */
double view_roll(const scene *original, const scene *transformed, const scene_view *view, uint32_t k);
void scene_transform(const scene *original, const scene_view *view, scene *out);

/* Vectors of the transformed scene back in the original one. polar: 1 of forces and velocities, 0 of moments and spins.
 */
void view_back(const scene_view *view, int polar, const double in[3], double out[3]);
void view_position_back(const scene_view *view, const double in[3], double out[3]);
/* R = P^T R' Rx(roll) Q, Q = diag(1, 1, handed). */
void view_rotation_back(const scene_view *view, double roll, const double in[9], double out[9]);

#endif
