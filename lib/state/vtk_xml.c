#include "state/vtk_xml.h"

#include <math.h>
#include <string.h>

void dmb_vtk_open_tag(dmb_text_file *file, const char *tag)
{
    dmb_text_put(file, "<");
    dmb_text_put(file, tag);
    dmb_text_put(file, ">\n");
}

void dmb_vtk_close_tag(dmb_text_file *file, const char *tag)
{
    dmb_text_put(file, "</");
    dmb_text_put(file, tag);
    dmb_text_put(file, ">\n");
}

static void put_attribute(dmb_text_file *file, const char *name, uint64_t value)
{
    dmb_text_put(file, " ");
    dmb_text_put(file, name);
    dmb_text_put(file, "=\"");
    dmb_text_put_count(file, value);
    dmb_text_put(file, "\"");
}

static void put_time(dmb_text_file *file, double time)
{
    dmb_text_put(file, "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
                       "format=\"ascii\">\n");
    dmb_vtk_put_tuple(file, &time, 1);
    dmb_vtk_end_array(file);
    dmb_vtk_close_tag(file, "FieldData");
}

void dmb_vtk_begin(dmb_text_file *file, const dmb_vtk_counts *counts, double time)
{
    dmb_text_put(file, "<?xml version=\"1.0\"?>\n"
                       "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
                       "header_type=\"UInt64\">\n<PolyData>\n");
    if (!isnan(time)) put_time(file, time);
    dmb_text_put(file, "<Piece");
    put_attribute(file, "NumberOfPoints", counts->points);
    put_attribute(file, "NumberOfVerts", 0);
    put_attribute(file, "NumberOfLines", counts->lines);
    put_attribute(file, "NumberOfStrips", 0);
    put_attribute(file, "NumberOfPolys", counts->polygons);
    dmb_text_put(file, ">\n");
}

void dmb_vtk_end(dmb_text_file *file)
{
    dmb_text_put(file, "</Piece>\n</PolyData>\n</VTKFile>\n");
}

static void begin_array(dmb_text_file *file, const char *type, const char *name, uint32_t components,
                        const char *format)
{
    dmb_text_put(file, "<DataArray type=\"");
    dmb_text_put(file, type);
    dmb_text_put(file, "\" Name=\"");
    dmb_text_put(file, name);
    dmb_text_put(file, "\"");
    put_attribute(file, "NumberOfComponents", components);
    dmb_text_put(file, " format=\"");
    dmb_text_put(file, format);
    dmb_text_put(file, "\">\n");
}

void dmb_vtk_begin_numbers(dmb_text_file *file, const char *name, uint32_t components)
{
    begin_array(file, "Float64", name, components, "ascii");
}

void dmb_vtk_begin_indices(dmb_text_file *file, const char *name)
{
    begin_array(file, "Int64", name, 1, "ascii");
}

void dmb_vtk_end_array(dmb_text_file *file)
{
    dmb_vtk_close_tag(file, "DataArray");
}

void dmb_vtk_look(dmb_text_file *file)
{
    file->looking = 1;
    file->strange = 0;
}

void dmb_vtk_begin_looked(dmb_text_file *file, const char *name, uint32_t components, uint64_t tuples)
{
    file->looking = 0;
    begin_array(file, "Float64", name, components, file->strange ? "binary" : "ascii");
    if (!file->strange) return;
    dmb_text_begin_base64(file);
    dmb_text_put_word(file, tuples * components * sizeof(double)); /* in header_type, one stream with the numbers */
}

void dmb_vtk_end_looked(dmb_text_file *file)
{
    if (file->base64) {
        dmb_text_end_base64(file);
        dmb_text_put(file, "\n");
    }
    dmb_vtk_end_array(file);
}

static void put_word(dmb_text_file *file, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    dmb_text_put_word(file, bits);
}

void dmb_vtk_put_tuple(dmb_text_file *file, const double *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (file->looking) {
            file->strange |= !isfinite(values[i]);
        } else if (file->base64) {
            put_word(file, values[i]);
        } else {
            if (i > 0) dmb_text_put(file, " ");
            dmb_text_put_number(file, values[i]);
        }
    }
    if (!file->looking && !file->base64) dmb_text_put(file, "\n");
}
