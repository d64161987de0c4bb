/* The frame of a VTK XML poly-data file with one piece, numbers as text (VTK file formats, "PolyData"). */
#ifndef DMB_STATE_VTK_XML_H
#define DMB_STATE_VTK_XML_H

#include "state/text_file.h"

typedef struct dmb_vtk_counts {
    uint64_t points, lines, polygons;
} dmb_vtk_counts;

/* Everything up to the piece's first array; time [s] becomes the file's TimeValue unless it is NaN. */
void dmb_vtk_begin(dmb_text_file *file, const dmb_vtk_counts *counts, double time);
/* Closes the piece and the file's elements. */
void dmb_vtk_end(dmb_text_file *file);
/* <tag>, </tag> */
void dmb_vtk_open_tag(dmb_text_file *file, const char *tag);
void dmb_vtk_close_tag(dmb_text_file *file, const char *tag);
/* A data array of Float64 or Int64 with that many components; its numbers go between the two. */
void dmb_vtk_begin_numbers(dmb_text_file *file, const char *name, uint32_t components);
void dmb_vtk_begin_indices(dmb_text_file *file, const char *name);
void dmb_vtk_end_array(dmb_text_file *file);
/* Numbers that may not be finite: readers stop at "nan" in text, so that such an array goes out in base 64, with the number
 * of its bytes first. look: what is put until dmb_vtk_begin_looked is only looked at. */
void dmb_vtk_look(dmb_text_file *file);
void dmb_vtk_begin_looked(dmb_text_file *file, const char *name, uint32_t components, uint64_t tuples);
void dmb_vtk_end_looked(dmb_text_file *file);
/* One tuple and the end of its line. */
void dmb_vtk_put_tuple(dmb_text_file *file, const double *values, uint32_t count);

#endif
