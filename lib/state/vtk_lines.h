/* The strings of a scene as poly-lines with point data, for ParaView: what is common to all pictures of strings. */
#ifndef DMB_STATE_VTK_LINES_H
#define DMB_STATE_VTK_LINES_H

#include "state.h"
#include "state/vtk_xml.h"

/* A point of the picture. */
typedef struct dmb_vtk_station {
    uint32_t string;
    dmb_place place;
} dmb_vtk_station;

/* Writes one tuple; context is that of the picture. */
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
    dmb_vtk_array points;        /* positions, three components */
    uint32_t per_element;        /* points an element, 1 .. 64 */
    uint32_t reserved;
} dmb_vtk_picture;

/* The file of a picture of the strings of a sim. DMB_ERR_VALUE (per_element), _NULL (path), _IO. */
int32_t dmb_vtk_write_lines(const dmb_sim *sim, const dmb_vtk_picture *picture, const char *path);

#endif
