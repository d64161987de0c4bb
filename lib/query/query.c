/* Public queries: the result, and the message of a query that fails. */
#include "query/query.h"
#include "sim/access.h"

/* ---- Messages ---------------------------------------------------------------------------------------------------- */

/* The name of a query in messages, and the arguments that can be wrong by themselves. */
typedef struct query {
    const char *word;
    const dmb_place *place;  /* NULL: none */
    const char *unsupported; /* the reason of DMB_ERR_UNSUPPORTED; NULL: never returned */
    int32_t frame, has_frame;
} query;

static void explain_id(const dmb_model *model, const char *word, dmb_id id, dmb_message *why)
{
    const uint32_t kind = id.index >> DMB_KIND_SHIFT, index = dmb_model_part_index(model, id, kind);
    dmb_message text;
    if (id.generation == 0)
        dmb_message_set(why, "%s: the id names nothing; give the id of a part", word);
    else if (id.generation != model->stamp)
        dmb_message_set(why, "%s: the id belongs to another model; give one of the model of this sim", word);
    else if (index == DMB_NONE)
        dmb_message_set(why, "%s: the id names no part of this model", word);
    else
        dmb_message_set(why, "%s: the id names %s, which has no such result; give a part of another kind", word,
                        dmb_model_part_text(model, kind, index, &text));
}

/* A pipe or fraction beyond the part. */
static void explain_place(const dmb_sim *sim, const char *word, dmb_place place, dmb_message *why)
{
    dmb_check check = dmb_check_of(why, word, DMB_NONE);
    const uint32_t string = dmb_model_part_index(sim->model, place.part, DMB_PART_STRING);
    if (string < sim->scene->string_count) {
        const uint32_t count = sim->scene->strings[string].pipe_count;
        dmb_check_count(&check, "pipe", place.pipe, 0, count - 1);
        dmb_check_within(&check, "fraction", place.fraction, 0.0, 1.0);
    } else if (dmb_body_index(sim, place.part) != DMB_NONE) {
        dmb_check_count(&check, "pipe of a place on a body", place.pipe, 0, 0);
        dmb_check_within(&check, "fraction of a place on a body", place.fraction, 0.0, 0.0);
    }
}

static int32_t refuse(const dmb_sim *sim, const query *asked, int32_t status)
{
    dmb_message why;
    dmb_message_clear(&why);
    if (dmb_sim_check(sim) == DMB_OK) {
        dmb_check check = dmb_check_of(&why, asked->word, DMB_NONE);
        if (status == DMB_ERR_VALUE && asked->has_frame)
            dmb_check_choice(&check, "frame", asked->frame, DMB_FRAME_WORLD, DMB_FRAME_BODY);
        if (status == DMB_ERR_ID && asked->place != NULL)
            explain_id(sim->model, asked->word, asked->place->part, &why);
        else if (asked->place != NULL && check.status == DMB_OK)
            explain_place(sim, asked->word, *asked->place, &why);
        if (status == DMB_ERR_UNSUPPORTED && asked->unsupported != NULL)
            dmb_message_set(&why, "%s: %s", asked->word, asked->unsupported);
    }
    return dmb_sim_fail(sim, status, asked->word, why.text);
}

/* Returns the status; a failing one has its message. */
static int32_t result(const dmb_sim *sim, int32_t status, query asked)
{
    return status >= 0 ? status : refuse(sim, &asked, status);
}

/* ---- Queries ----------------------------------------------------------------------------------------------------- */

int32_t dmb_query_bit(const dmb_sim *sim, dmb_id bit, dmb_bit_state *state)
{
    const dmb_place place = dmb_station(bit, 0, 0.0);
    return result(sim, dmb_answer_bit(sim, bit, state), (query){"bit", &place, NULL, 0, 0});
}

int32_t dmb_query_constraint_rows(const dmb_sim *sim, dmb_id part, uint32_t *first, uint32_t *count)
{
    const dmb_place place = dmb_station(part, 0, 0.0);
    return result(sim, dmb_answer_constraint_rows(sim, part, first, count),
                  (query){"constraint rows", &place, NULL, 0, 0});
}

int32_t dmb_query_contact(const dmb_sim *sim, uint32_t number, dmb_contact *contact)
{
    return result(sim, dmb_answer_contact(sim, number, contact), (query){"contact point", NULL, NULL, 0, 0});
}

int32_t dmb_query_contact_total(const dmb_sim *sim, dmb_contact_total *sum)
{
    return result(sim, dmb_answer_contact_total(sim, sum), (query){"contact", NULL, NULL, 0, 0});
}

int32_t dmb_query_drive(const dmb_sim *sim, dmb_id drive, dmb_drive_state *state)
{
    const dmb_place place = dmb_station(drive, 0, 0.0);
    return result(sim, dmb_answer_drive(sim, drive, state), (query){"drive", &place, NULL, 0, 0});
}

int32_t dmb_query_energy(const dmb_sim *sim, dmb_energy *energy)
{
    return result(sim, dmb_answer_energy(sim, energy),
                  (query){"energy", NULL, "the sim keeps no energy ledger; create it with energy_ledger = 1", 0, 0});
}

int32_t dmb_query_flow(const dmb_sim *sim, dmb_flow_state *flow)
{
    return result(sim, dmb_answer_flow(sim, flow), (query){"flow", NULL, NULL, 0, 0});
}

int32_t dmb_query_hole_now(const dmb_sim *sim, double depth, dmb_hole_point *point)
{
    return result(sim, dmb_answer_hole_now(sim, depth, point),
                  (query){"hole", NULL, "the model has no wall; add one before it is compiled", 0, 0});
}

int32_t dmb_query_joint(const dmb_sim *sim, dmb_id joint, dmb_joint_state *state)
{
    const dmb_place place = dmb_station(joint, 0, 0.0);
    return result(sim, dmb_answer_joint(sim, joint, state),
                  (query){"joint", &place, NULL, state == NULL ? 0 : state->frame, state != NULL});
}

int32_t dmb_query_kinetic_energy(const dmb_sim *sim, dmb_id part, uint32_t pipe, double *energy)
{
    const dmb_place place = dmb_station(part, pipe, 0.0);
    return result(sim, dmb_answer_kinetic_energy(sim, part, pipe, energy),
                  (query){"kinetic energy", &place, NULL, 0, 0});
}

int32_t dmb_query_momentum(const dmb_sim *sim, dmb_momentum *momentum)
{
    return result(sim, dmb_answer_momentum(sim, momentum), (query){"momentum", NULL, NULL, 0, 0});
}

int32_t dmb_query_motion(const dmb_sim *sim, dmb_place place, dmb_motion *motion)
{
    return result(sim, dmb_answer_motion(sim, place, motion),
                  (query){"motion", &place, NULL, motion == NULL ? 0 : motion->frame, motion != NULL});
}

int32_t dmb_query_motion_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_motion *motion)
{
    return result(sim, dmb_answer_motion_at(sim, place, offset, motion),
                  (query){"motion", &place, NULL, motion == NULL ? 0 : motion->frame, motion != NULL});
}

int32_t dmb_query_multipliers(const dmb_sim *sim, dmb_id part, double multipliers[6], uint32_t *count)
{
    const dmb_place place = dmb_station(part, 0, 0.0);
    return result(sim, dmb_answer_multipliers(sim, part, multipliers, count),
                  (query){"multipliers", &place, NULL, 0, 0});
}

int32_t dmb_query_pose(const dmb_sim *sim, dmb_place place, dmb_pose *pose)
{
    return result(sim, dmb_answer_pose(sim, place, pose), (query){"pose", &place, NULL, 0, 0});
}

int32_t dmb_query_pose_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_pose *pose)
{
    return result(sim, dmb_answer_pose_at(sim, place, offset, pose), (query){"pose", &place, NULL, 0, 0});
}

int32_t dmb_query_profile(const dmb_sim *sim, const dmb_profile *profile)
{
    const int32_t status = dmb_answer_profile(sim, profile);
    if (status == DMB_ERR_NULL)
        return dmb_sim_fail(sim, status, "profile",
                            "profile: sim, profile, its quantities and its values must not be NULL; give them");
    return result(sim, status, (query){"profile", NULL, NULL, 0, 0});
}

int32_t dmb_query_profile_extremes(const dmb_sim *sim, const dmb_profile *profile, double *extremes)
{
    const int32_t status = dmb_answer_profile_extremes(sim, profile, extremes);
    if (status == DMB_ERR_NULL)
        return dmb_sim_fail(sim, status, "profile",
                            "profile: sim, profile, its quantities and the extremes must not be NULL; give them");
    return result(sim, status, (query){"profile", NULL, NULL, 0, 0});
}

int32_t dmb_query_reaction(const dmb_sim *sim, dmb_id part, double reaction[6])
{
    const dmb_place place = dmb_station(part, 0, 0.0);
    return result(sim, dmb_answer_reaction(sim, part, reaction), (query){"reaction", &place, NULL, 0, 0});
}

int32_t dmb_query_rotation(const dmb_sim *sim, dmb_place place, double *angle)
{
    return result(sim, dmb_answer_rotation(sim, place, angle), (query){"rotation", &place, NULL, 0, 0});
}

int32_t dmb_query_row(const dmb_sim *sim, uint32_t row, dmb_row *answer)
{
    return result(sim, dmb_answer_row(sim, row, answer), (query){"row", NULL, NULL, 0, 0});
}

int32_t dmb_query_section(const dmb_sim *sim, dmb_place place, dmb_section *section)
{
    return result(
        sim, dmb_answer_section(sim, place, section),
        (query){"section", &place,
                "the place is on a rigid pipe or body, whose section forces are not known; ask for a flexible pipe", 0,
                0});
}

int32_t dmb_query_spring(const dmb_sim *sim, dmb_id spring, dmb_spring_state *state)
{
    const dmb_place place = dmb_station(spring, 0, 0.0);
    return result(sim, dmb_answer_spring(sim, spring, state), (query){"spring", &place, NULL, 0, 0});
}

int32_t dmb_query_statistics(const dmb_sim *sim, dmb_statistics *statistics)
{
    return result(sim, dmb_answer_statistics(sim, statistics), (query){"statistics", NULL, NULL, 0, 0});
}

int32_t dmb_query_stuck(const dmb_sim *sim, dmb_id stuck, dmb_stuck_state *state)
{
    const dmb_place place = dmb_station(stuck, 0, 0.0);
    return result(sim, dmb_answer_stuck(sim, stuck, state), (query){"stuck", &place, NULL, 0, 0});
}
