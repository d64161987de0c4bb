/* Matrices of three rows, row by row, and rotation vectors. Results may be the arguments. */
#ifndef DMB_RELATIONS_MATRIX3_H
#define DMB_RELATIONS_MATRIX3_H

void rotation_of_vector(const double vector[3], double matrix[9]);
void vector_of_rotation(const double matrix[9], double vector[3]);
void matrix_transpose(const double a[9], double out[9]);
void matrix_times(const double a[9], const double b[9], double out[9]);
void matrix_apply(const double a[9], const double x[3], double out[3]);
void matrix_apply_transposed(const double a[9], const double x[3], double out[3]);

#endif
