/* VTK XML poly-data files of one piece, numbers as text (VTK file formats, "PolyData"), and the strings of a scene in
 * them. */
#include "output/output.h"

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

/* Arrays are visited twice: a first time to look for values that are not finite, which ascii arrays of VTK cannot have.
 * Such an array is then written in base 64. */
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
    dmb_text_put_word(file, tuples * components * sizeof(double)); /* in header_type, in one stream with the numbers */
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

enum { DMB_POINTS_MAX = 64 };

/* A rigid pipe counts as one element. */
static uint32_t elements_of(const dmb_pipe_map *pipe)
{
    return pipe->elements > 0 ? pipe->elements : 1;
}

static uint32_t points_of_pipe(const dmb_pipe_map *pipe, uint32_t per_element)
{
    return elements_of(pipe) * per_element;
}

static uint64_t points_of_string(const dmb_scene *scene, uint32_t string, uint32_t per_element)
{
    const dmb_string_map *map = &scene->strings[string];
    uint64_t points = 1;
    for (uint32_t i = 0; i < map->pipe_count; i++) {
        points += points_of_pipe(&scene->pipes[map->first_pipe + i], per_element);
    }
    return points;
}

static dmb_id string_id(const dmb_sim *sim, uint32_t string)
{
    dmb_id id;
    id.index = (uint32_t)DMB_PART_STRING << 24 | string;
    id.generation = sim->model->stamp;
    return id;
}

/* Calls `put` for every point in order: each pipe without its last point, then the end of the string. */
static void put_each_string(dmb_text_file *file, const dmb_sim *sim, uint32_t string, const dmb_vtk_picture *picture,
                            dmb_vtk_station_fn *put)
{
    const dmb_string_map *map = &sim->scene->strings[string];
    dmb_vtk_station at = {string, {string_id(sim, string), 0, 0, 0.0}};
    for (uint32_t i = 0; i < map->pipe_count; i++) {
        const uint32_t count = points_of_pipe(&sim->scene->pipes[map->first_pipe + i], picture->per_element);
        at.place.pipe = i;
        for (uint32_t k = 0; k < count; k++) {
            at.place.fraction = (double)k / count;
            put(file, picture->context, &at);
        }
    }
    at.place.fraction = 1.0;
    put(file, picture->context, &at);
}

static uint64_t points_of(const dmb_sim *sim, uint32_t per_element)
{
    uint64_t points = 0;
    for (uint32_t i = 0; i < sim->scene->string_count; i++) points += points_of_string(sim->scene, i, per_element);
    return points;
}

static void put_array(dmb_text_file *file, const dmb_sim *sim, const dmb_vtk_picture *picture,
                      const dmb_vtk_array *array)
{
    dmb_vtk_look(file);
    for (uint32_t i = 0; i < sim->scene->string_count; i++) put_each_string(file, sim, i, picture, array->put);
    dmb_vtk_begin_looked(file, array->name, array->components, points_of(sim, picture->per_element));
    for (uint32_t i = 0; i < sim->scene->string_count; i++) put_each_string(file, sim, i, picture, array->put);
    dmb_vtk_end_looked(file);
}

static void put_points(dmb_text_file *file, const dmb_sim *sim, const dmb_vtk_picture *picture)
{
    dmb_vtk_open_tag(file, picture->data);
    for (size_t i = 0; i < picture->array_count; i++) put_array(file, sim, picture, &picture->arrays[i]);
    dmb_vtk_close_tag(file, "PointData");
    dmb_vtk_open_tag(file, "Points");
    put_array(file, sim, picture, &picture->points);
    dmb_vtk_close_tag(file, "Points");
}

static void put_index(dmb_text_file *file, uint64_t index)
{
    dmb_text_put_count(file, index);
    dmb_text_put(file, "\n");
}

/* One poly-line per string, through its points in order. */
static void put_lines(dmb_text_file *file, const dmb_sim *sim, uint32_t per_element, uint64_t points)
{
    uint64_t end = 0;
    dmb_vtk_open_tag(file, "Lines");
    dmb_vtk_begin_indices(file, "connectivity");
    for (uint64_t i = 0; i < points; i++) put_index(file, i);
    dmb_vtk_end_array(file);
    dmb_vtk_begin_indices(file, "offsets");
    for (uint32_t i = 0; i < sim->scene->string_count; i++) {
        end += points_of_string(sim->scene, i, per_element);
        put_index(file, end);
    }
    dmb_vtk_end_array(file);
    dmb_vtk_close_tag(file, "Lines");
}

int32_t dmb_vtk_write_lines(const dmb_sim *sim, const dmb_vtk_picture *picture, const char *path)
{
    dmb_vtk_counts counts = {0, 0, 0};
    dmb_text_file file;
    if (path == NULL) return DMB_ERR_NULL;
    if (picture->per_element < 1 || picture->per_element > DMB_POINTS_MAX) return DMB_ERR_VALUE;
    counts.lines = sim->scene->string_count;
    counts.points = points_of(sim, picture->per_element);
    const int32_t status = dmb_text_open(&file, path);
    if (status < 0) return status;
    dmb_vtk_begin(&file, &counts, sim->clock->time);
    put_points(&file, sim, picture);
    put_lines(&file, sim, picture->per_element, counts.points);
    dmb_vtk_end(&file);
    return dmb_text_close(&file);
}
