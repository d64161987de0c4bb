/* Interface between the source files of this folder: recorders, windows, cycle counting and files for ParaView. */
#ifndef DMB_OUTPUT_OUTPUT_H
#define DMB_OUTPUT_OUTPUT_H

#include <stdint.h>

#include "drillmbd/ask.h"
#include "output/text_file.h"
#include "sim/sim.h"

/* Ends a public call that writes a file: a failure is one of the sim (NULL: of the thread alone), `why` its message
 * unless that is empty (NULL: empty). Returns status. */
int32_t dmb_file_failed(const dmb_sim *sim, const char *call, const char *path, int32_t status, dmb_message *why);

/* ---- Recorders --------------------------------------------------------------------------------------------------- */

/* Copies and checks the caller's struct. Errors: DMB_ERR_NULL, _STRUCT_SIZE, _NOT_FINITE, _VALUE. */
int32_t dmb_recorder_read_struct(dmb_recorder *out, const dmb_recorder *given, dmb_message *why);

/* 1 if the next sample is due. Sample times are whole multiples of the interval [s] after the first sample, so that
 * they do not drift with the steps; with an interval of 0 every sample is due. */
int dmb_sample_is_due(double interval, double first, double last, double time);

/* 1 if a table with rows of `width` doubles and space for `capacity` rows has an addressable size and its row count is
 * valid. */
int dmb_table_fits(uint64_t row_count, uint64_t capacity, uint64_t width);

/* ---- Windows ----------------------------------------------------------------------------------------------------- */

/* Value of an output DMB_OUTPUT_WINDOW_MINIMUM .. _WINDOW_LOW_SHARE, as recorders use it. Errors: those of
 * dmb_window_get. */
int32_t dmb_window_value(const dmb_window *window, const dmb_output *output, double *value);

/* ---- Cycles of fatigue ------------------------------------------------------------------------------------------- */

/* A turning point: the level by which ranges are compared, and the extreme value within that level. */
typedef struct dmb_turn {
    double value;
    uint32_t level, reserved;
} dmb_turn;

typedef struct dmb_rainflow {
    dmb_turn *turns; /* not counted yet, shape (levels + 2) */
    uint32_t count;
    uint32_t reserved;
} dmb_rainflow;

/* Receives a cycle or half cycle (weight 1 or 0.5) between two turning points, low->level < high->level. */
typedef void (*dmb_rainflow_fn)(void *context, const dmb_turn *low, const dmb_turn *high, double weight);

void dmb_rainflow_add(dmb_rainflow *flow, uint32_t level, double value, dmb_rainflow_fn count, void *context);
/* Reports the turning points that are not counted yet as half cycles; they remain in the list. */
void dmb_rainflow_rest(const dmb_rainflow *flow, dmb_rainflow_fn count, void *context);

/* ---- Files for ParaView ------------------------------------------------------------------------------------------ */

typedef struct dmb_vtk_counts {
    uint64_t points, lines, polygons;
} dmb_vtk_counts;

/* Writes the file up to the first array of the piece; time [s] becomes the TimeValue of the file unless it is NaN. */
void dmb_vtk_begin(dmb_text_file *file, const dmb_vtk_counts *counts, double time);
/* Closes the piece and the file's elements. */
void dmb_vtk_end(dmb_text_file *file);
/* <tag>, </tag> */
void dmb_vtk_open_tag(dmb_text_file *file, const char *tag);
void dmb_vtk_close_tag(dmb_text_file *file, const char *tag);
/* A data array of Float64 or Int64 with the given number of components; its numbers are written between begin and end.
 */
void dmb_vtk_begin_numbers(dmb_text_file *file, const char *name, uint32_t components);
void dmb_vtk_begin_indices(dmb_text_file *file, const char *name);
void dmb_vtk_end_array(dmb_text_file *file);
/* Numbers that may not be finite. Readers of text stop at "nan", therefore such an array is written in base 64,
 * preceded by its number of bytes. After dmb_vtk_look, numbers are only inspected until dmb_vtk_begin_looked. */
void dmb_vtk_look(dmb_text_file *file);
void dmb_vtk_begin_looked(dmb_text_file *file, const char *name, uint32_t components, uint64_t tuples);
void dmb_vtk_end_looked(dmb_text_file *file);
/* One tuple and the end of its line. */
void dmb_vtk_put_tuple(dmb_text_file *file, const double *values, uint32_t count);

/* The strings of a scene as poly-lines with point data, for ParaView: common part of all pictures of strings. */

/* A point of the picture. */
typedef struct dmb_vtk_station {
    uint32_t string;
    dmb_place place;
} dmb_vtk_station;

/* Writes one tuple; context is dmb_vtk_picture.context. */
typedef void dmb_vtk_station_fn(dmb_text_file *file, const void *context, const dmb_vtk_station *at);

typedef struct dmb_vtk_array {
    const char *name;
    uint32_t components;
    dmb_vtk_station_fn *put;
} dmb_vtk_array;

typedef struct dmb_vtk_picture {
    const void *context;
    const char *data;            /* "PointData ..." with the fields to be shown first */
    const dmb_vtk_array *arrays; /* shape (array_count) */
    size_t array_count;
    dmb_vtk_array points; /* positions, three components */
    uint32_t per_element; /* points per element, 1 .. 64 */
    uint32_t reserved;
} dmb_vtk_picture;

/* Writes the file of a picture of the strings of a sim. Errors: DMB_ERR_VALUE (per_element), _NULL (path), _IO. */
int32_t dmb_vtk_write_lines(const dmb_sim *sim, const dmb_vtk_picture *picture, const char *path);

#endif
