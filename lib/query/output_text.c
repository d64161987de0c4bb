/* The text of an output, for messages and for the heads of tables: quantity, part by its name, place, unit. */
#include <string.h>

#include "base/failure.h"
#include "drillmbd/ask.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/model.h"
#include "query/query.h"
#include "sim/access.h"
#include "sim/sim.h"

static const dmb_drive_def *drive_of(const dmb_model *model, dmb_id part)
{
    const uint32_t i = model != NULL ? dmb_model_part_index(model, part, DMB_PART_DRIVE) : DMB_NONE;
    return i != DMB_NONE ? DMB_LIST_AT(const dmb_drive_def, model->drives, i) : NULL;
}

/* Of "N or N m" and "m/s or rad/s". */
static const char *choose(const char *unit, int about)
{
    static const char *const pairs[][3] = {
        {"N or N m", "N", "N m"}, {"m or rad", "m", "rad"}, {"m/s or rad/s", "m/s", "rad/s"}};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++)
        if (strcmp(unit, pairs[i][0]) == 0) return pairs[i][about ? 2 : 1];
    return unit;
}

/* The unit over a second, of the units of inputs. */
static const char *per_second(const char *unit)
{
    static const char *const pairs[][2] = {{"-", "1/s"},       {"m/s", "m/s2"},    {"rad/s", "rad/s2"},
                                           {"N", "N/s"},       {"N m", "N m/s"},   {"N s/m", "N/m"},
                                           {"N m s", "N m"},   {"N/m", "N/(m s)"}, {"kg/m3", "kg/(m3 s)"},
                                           {"N s/m2", "N/m2"}, {"N s", "N"},       {"m3/s", "m3/s2"}};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++)
        if (strcmp(unit, pairs[i][0]) == 0) return pairs[i][1];
    return "unit of the input/s";
}

/* The unit of an output of an input of the model, else NULL. */
static const char *unit_at_input(const dmb_model *model, const dmb_output *output)
{
    const uint32_t i = model != NULL ? dmb_model_part_index(model, output->place.part, DMB_PART_INPUT) : DMB_NONE;
    if (i == DMB_NONE) return NULL;
    const char *unit = dmb_input_unit(model, DMB_LIST_AT(const dmb_input_def, model->inputs, i));
    return output->quantity == DMB_OUTPUT_INPUT_RATE ? per_second(unit) : unit;
}

const char *dmb_output_unit(const dmb_model *model, const dmb_output *output)
{
    const dmb_output_entry *entry = dmb_output_name_of(output->quantity);
    const dmb_drive_def *drive =
        entry != NULL && entry->place == DMB_AT_DRIVE ? drive_of(model, output->place.part) : NULL;
    if (entry == NULL) return "-";
    const char *set = entry->place == DMB_AT_INPUT ? unit_at_input(model, output) : NULL;
    if (set != NULL) return set;
    if (drive == NULL) return entry->unit;
    if (output->quantity == DMB_OUTPUT_DRIVE_TARGET)
        return choose(drive->kind == DMB_DRIVE_LOAD ? "N or N m" : "m/s or rad/s", drive->component >= DMB_RX);
    return choose(entry->unit, drive->component >= DMB_RX);
}

/* " of string main", " of drive 0"; " of part 7" of an id that names no kind. */
static void put_part(const dmb_model *model, dmb_id part, dmb_message *text)
{
    const uint32_t kind = part.index >> DMB_KIND_SHIFT, number = part.index & (uint32_t)DMB_CHUNKS_MAX;
    const char *const word = dmb_part_word(kind), *name = "";
    if (word != NULL && model != NULL && dmb_model_part_index(model, part, kind) != DMB_NONE)
        name = dmb_part_name(model, kind, number);
    if (part.index == 0)
        dmb_message_set(text, " of no part");
    else if (name[0] != '\0')
        dmb_message_set(text, " of %s %s", word, name);
    else
        dmb_message_set(text, " of %s %u", word != NULL ? word : "part", number);
}

/* For an unknown quantity the whole place is written. */
static void put_place(const dmb_model *model, int32_t kind, const dmb_place *place, dmb_message *text)
{
    dmb_message part;
    dmb_message_clear(text);
    if (kind == DMB_AT_SCENE || (kind == DMB_AT_STRING && place->part.index == 0)) return;
    if (kind == DMB_AT_CONTACT || kind == DMB_AT_WINDOW) {
        dmb_message_set(text, kind == DMB_AT_CONTACT ? " of contact point %u" : " of output %u", place->pipe);
        return;
    }
    put_part(model, place->part, &part);
    const int along = kind <= DMB_AT_PART || kind == DMB_AT_VIBRATION;
    if (!along ||
        (place->part.index >> DMB_KIND_SHIFT != DMB_PART_STRING && place->pipe == 0 && place->fraction == 0.0))
        *text = part;
    else
        dmb_message_set(text, "%s pipe %u at %g", part.text, place->pipe, place->fraction);
}

const char *dmb_output_words(const dmb_model *model, const dmb_output *output, dmb_message *text)
{
    const dmb_output_entry *entry = dmb_output_name_of(output->quantity);
    dmb_message place;
    put_place(model, entry != NULL ? entry->place : DMB_AT_PLACE, &output->place, &place);
    dmb_message_set(text, "%s%s", entry != NULL ? entry->name : "unknown", place.text);
    return text->text;
}

int32_t dmb_output_text(const dmb_sim *sim, const dmb_output *output, char *text, uint32_t size)
{
    dmb_message words, all;
    if (output == NULL || (text == NULL && size > 0)) return dmb_failed("output text", DMB_ERR_NULL);
    if (sim != NULL && dmb_sim_check(sim) < 0) return dmb_failed("output text", DMB_ERR_HANDLE);
    if (dmb_output_name_of(output->quantity) == NULL) return dmb_failed("output text", DMB_ERR_VALUE);
    const dmb_model *model = sim != NULL ? sim->model : NULL;
    dmb_message_set(&all, "%s [%s]", dmb_output_words(model, output, &words), dmb_output_unit(model, output));
    const size_t length = strlen(all.text) + 1;
    if (length > size) return dmb_failed("output text", DMB_ERR_TOO_LARGE);
    memcpy(text, all.text, length);
    return DMB_OK;
}

/* ---- Error messages ---------------------------------------------------------------------------------------------- */

static const char *wanted(int32_t place, int32_t status)
{
    switch (place == DMB_AT_VIBRATION && status != DMB_ERR_UNSUPPORTED ? DMB_AT_PLACE : place) {
    case DMB_AT_PLACE: return "place must be on a string, body or bit of this model";
    case DMB_AT_SECTION: return "place must be on a flexible or axial-torsional pipe of a string";
    case DMB_AT_PIPE: return "place must be on a pipe of a string";
    case DMB_AT_PART: return "place must name a pipe of a string, a body or a bit";
    case DMB_AT_STRING:
        return "place.part must be a string, or {0, 0} for the first string, with a bit (for off_bottom with a rock "
               "law) "
               "or a flexible first pipe";
    case DMB_AT_BIT: return "place.part must be a bit";
    case DMB_AT_STUCK: return "place.part must be a stuck place";
    case DMB_AT_SPRING: return "place.part must be a spring";
    case DMB_AT_INPUT: return "place.part must be an input";
    case DMB_AT_DRIVE: return "place.part must be a drive";
    case DMB_AT_JOINT: return "place.part must be a joint";
    case DMB_AT_CONSTRAINT: return "place.part must be a joint, coupling, constraint or joint drive with that row";
    case DMB_AT_CONTACT: return "place.pipe must be a contact point, below info.contact_points";
    case DMB_AT_SCENE: return "it requires the energy ledger: set energy_ledger = 1 in the options of the sim";
    case DMB_AT_VIBRATION:
        return "it is a small motion about the state of a response, stepped sine or state space; in a run take "
               "displacement, world_velocity or body_velocity";
    default: return "it is a number of a window: record it by a recorder with a window, or ask dmb_window_get";
    }
}

int32_t dmb_output_known(const dmb_output *output, uint32_t i, dmb_message *message)
{
    if (dmb_output_name_of(output->quantity) != NULL) return DMB_OK;
    dmb_message_set(message, "output %u: quantity = %d, must be a DMB_OUTPUT_ number", i, (int)output->quantity);
    return DMB_ERR_VALUE;
}

void dmb_output_refuse(const dmb_model *model, const dmb_output *output, uint32_t i, const char *why,
                       dmb_message *message)
{
    dmb_message words;
    dmb_message_set(message, "output %u, %s: %s", i, dmb_output_words(model, output, &words), why);
}

void dmb_output_explain(const dmb_model *model, const dmb_output *output, uint32_t i, int32_t status,
                        dmb_message *message)
{
    dmb_message why;
    if (dmb_output_known(output, i, message) < 0) return;
    dmb_message_set(&why, "%s; %s", dmb_status_text(status),
                    wanted(dmb_output_name_of(output->quantity)->place, status));
    dmb_output_refuse(model, output, i, why.text, message);
}
