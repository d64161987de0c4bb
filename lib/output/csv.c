/* The recorder's table as comma-separated values: one header line, '.' as decimal mark in every locale, and enough
 * digits to reproduce every number exactly. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "analysis/response/response.h"
#include "base/sized_struct.h"
#include "model/model.h"
#include "output/output.h"
#include "output/text_file.h"
#include "query/query.h"
#include "sim/access.h"
#include "sim/sim.h"

static const dmb_model *model_of(const dmb_sim *sim)
{
    return sim != NULL ? sim->model : NULL;
}

/* A field of a head; in quotes where a name has a comma or a quote. */
static void put_field(dmb_text_file *file, const char *text, const char *unit)
{
    const int quoted = strpbrk(text, ",\"") != NULL;
    if (quoted) dmb_text_put(file, "\"");
    for (const char *c = text; *c != '\0'; c++) {
        const char one[2] = {*c, '\0'};
        if (*c == '"') dmb_text_put(file, "\"");
        dmb_text_put(file, one);
    }
    dmb_text_put(file, " [");
    dmb_text_put(file, unit);
    dmb_text_put(file, quoted ? "]\"" : "]");
}

static void put_header(dmb_text_file *file, const dmb_recorder *r, const dmb_sim *sim)
{
    dmb_text_put(file, "time [s]");
    for (uint32_t i = 0; i < r->output_count; ++i) {
        dmb_message words;
        dmb_text_put(file, ",");
        put_field(file, dmb_output_words(model_of(sim), r->outputs + i, &words),
                  dmb_output_unit(model_of(sim), r->outputs + i));
    }
    dmb_text_put(file, "\n");
}

static void put_rows(dmb_text_file *file, const dmb_recorder *r)
{
    const double *value = r->table;
    for (uint64_t row = 0; row < r->row_count; ++row) {
        for (uint32_t i = 0; i <= r->output_count; ++i) {
            if (i > 0) dmb_text_put(file, ",");
            dmb_text_put_number(file, *value++);
        }
        dmb_text_put(file, "\n");
    }
}

static int32_t write_recorder(const dmb_recorder *recorder, const dmb_sim *sim, const char *path, dmb_message *why)
{
    dmb_recorder r;
    dmb_text_file file;
    int32_t status = dmb_recorder_read_struct(&r, recorder, why);
    if (status < 0) return status;
    if (path == NULL) return DMB_ERR_NULL;
    if (sim != NULL && dmb_sim_check(sim) < 0) return DMB_ERR_HANDLE;
    status = dmb_text_open(&file, path);
    if (status < 0) return status;
    put_header(&file, &r, sim);
    put_rows(&file, &r);
    return dmb_text_close(&file);
}

int32_t dmb_recorder_write_csv(const dmb_recorder *recorder, const dmb_sim *sim, const char *path)
{
    dmb_message why;
    dmb_message_clear(&why);
    const int32_t status = write_recorder(recorder, sim, path, &why);
    return dmb_file_failed(sim, "recorder", path, status, &why);
}

/* A frequency response as comma-separated values: frequency, then amplitude and phase of each transfer function and of
 * each combined output. */

static void put_name(dmb_text_file *file, const char *what, const char *unit, const char *output, uint32_t input)
{
    dmb_message text;
    if (input == DMB_COMBINED)
        dmb_message_set(&text, "%s of %s for all excitations", what, output);
    else
        dmb_message_set(&text, "%s of %s for excitation %u", what, output, input);
    put_field(file, text.text, unit);
}

/* An amplitude for one excitation is by the unit of that. */
static void put_response_header(dmb_text_file *file, const dmb_response *response, const dmb_sim *sim)
{
    dmb_text_put(file, "frequency [Hz]");
    for (uint32_t i = 0; i <= response->excitations; i++)
        for (uint32_t k = 0; k < response->outputs; k++) {
            const uint32_t input = i < response->excitations ? i : DMB_COMBINED;
            const char *unit = dmb_output_unit(model_of(sim), response->output + k);
            dmb_message words, per;
            (void)dmb_output_words(model_of(sim), response->output + k, &words);
            dmb_message_set(&per, input == DMB_COMBINED ? "%s" : "%s per unit", unit);
            dmb_text_put(file, ",");
            put_name(file, "amplitude", per.text, words.text, input);
            dmb_text_put(file, ",");
            put_name(file, "phase", "rad", words.text, input);
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
    for (uint32_t i = 0; i < response->excitations; i++)
        for (uint32_t k = 0; k < response->outputs; k++)
            put_value(file, dmb_response_value(response, point, i) + 2 * (size_t)k);
    for (uint32_t k = 0; k < response->outputs; k++) {
        double value[2];
        dmb_response_combined(response, point, k, value);
        put_value(file, value);
    }
    dmb_text_put(file, "\n");
}

static int32_t write_response(const dmb_response *response, const dmb_sim *sim, const char *path)
{
    dmb_text_file file;
    if (response == NULL || path == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(response, DMB_HANDLE_RESPONSE)) return DMB_ERR_HANDLE;
    if (sim != NULL && dmb_sim_check(sim) < 0) return DMB_ERR_HANDLE;
    const int32_t status = dmb_text_open(&file, path);
    if (status < 0) return status;
    put_response_header(&file, response, sim);
    for (uint32_t point = 0; point < response->points; point++) put_row(&file, response, point);
    return dmb_text_close(&file);
}

int32_t dmb_response_write_csv(const dmb_response *response, const dmb_sim *sim, const char *path)
{
    return dmb_file_failed(sim, "response", path, write_response(response, sim, path), NULL);
}
