/* A frequency response as comma-separated values: frequency, then amplitude and phase of each transfer function and of
 * each combined output. */
#include <math.h>

#include "analysis/response_object.h"
#include "base/handle.h"
#include "state/text_file.h"

static void put_name(dmb_text_file *file, const char *what, const char *unit, uint32_t input, uint32_t output)
{
    dmb_text_put(file, what);
    dmb_text_put(file, " of output ");
    dmb_text_put_count(file, output);
    dmb_text_put(file, input == DMB_COMBINED ? " for all inputs" : " for input ");
    if (input != DMB_COMBINED) dmb_text_put_count(file, input);
    dmb_text_put(file, unit);
}

static void put_header(dmb_text_file *file, const dmb_response *response)
{
    dmb_text_put(file, "frequency [Hz]");
    for (uint32_t i = 0; i <= response->inputs; i++)
        for (uint32_t k = 0; k < response->outputs; k++) {
            const uint32_t input = i < response->inputs ? i : DMB_COMBINED;
            dmb_text_put(file, ",");
            put_name(file, "amplitude", "", input, k);
            dmb_text_put(file, ",");
            put_name(file, "phase", " [rad]", input, k);
        }
    dmb_text_put(file, "\n");
}

static void put_value(dmb_text_file *file, const double value[2])
{
    dmb_text_put(file, ",");
    dmb_text_put_number(file, hypot(value[0], value[1]));
    dmb_text_put(file, ",");
    dmb_text_put_number(file, atan2(value[1], value[0]));
}

static void put_row(dmb_text_file *file, const dmb_response *response, uint32_t point)
{
    dmb_text_put_number(file, response->frequency[point]);
    for (uint32_t i = 0; i < response->inputs; i++)
        for (uint32_t k = 0; k < response->outputs; k++)
            put_value(file, dmb_response_value(response, point, i) + 2 * (size_t)k);
    for (uint32_t k = 0; k < response->outputs; k++) {
        double value[2];
        dmb_response_combined(response, point, k, value);
        put_value(file, value);
    }
    dmb_text_put(file, "\n");
}

int32_t dmb_response_write_csv(const dmb_response *response, const char *path)
{
    dmb_text_file file;
    if (response == NULL || path == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(response, DMB_HANDLE_RESPONSE)) return DMB_ERR_HANDLE;
    if (dmb_text_open(&file, path) < 0) return DMB_ERR_IO;
    put_header(&file, response);
    for (uint32_t point = 0; point < response->points; point++) put_row(&file, response, point);
    return dmb_text_close(&file);
}
