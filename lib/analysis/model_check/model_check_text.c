/* Model check as text: a column of names, a column of numbers, and their composition. */
#include <string.h>

#include "analysis/model_check/model_check.h"
#include "base/number.h"
#include "base/sized_struct.h"
#include "constraint/joint.h"
#include "sim/access.h"

enum { NAME_WIDTH = 22, NUMBER_WIDTH = 10 };

/* Text buffer; `used` also counts characters beyond it, so that the caller obtains the required size. */
typedef struct sheet {
    char *text;
    size_t size, used;
} sheet;

static void put(sheet *s, const char *text)
{
    for (; *text != '\0'; ++text, ++s->used)
        if (s->used + 1 < s->size) s->text[s->used] = *text;
}

static void pad(sheet *s, size_t used, size_t width)
{
    for (; used < width; used++) put(s, " ");
}

/* "  name           123": the caller adds the rest of the line. */
static void begin_line(sheet *s, const char *name, const char *number)
{
    put(s, "  ");
    put(s, name);
    pad(s, strlen(name), NAME_WIDTH);
    pad(s, strlen(number), NUMBER_WIDTH);
    put(s, number);
}

static void put_count(sheet *s, uint32_t count)
{
    char number[DMB_NUMBER_SIZE];
    (void)dmb_number_from_u64(number, count);
    put(s, number);
}

static void begin_count(sheet *s, const char *name, int64_t count)
{
    char number[DMB_NUMBER_SIZE];
    (void)dmb_number_from_i64(number, count);
    begin_line(s, name, number);
}

static void begin_number(sheet *s, const char *name, double value)
{
    char number[DMB_NUMBER_SIZE];
    (void)dmb_number_from_double(number, value, 3);
    begin_line(s, name, number);
}

static void end_line(sheet *s, const dmb_message *note)
{
    if (note != NULL) {
        put(s, "   ");
        put(s, note->text);
    }
    put(s, "\n");
}

/* ---- Counts ------------------------------------------------------------------------------------------------------ */

static void put_parts(sheet *s, const dmb_check_report *r)
{
    dmb_message note;
    begin_count(s, "rigid parts", r->rigid_parts);
    end_line(s, NULL);
    begin_count(s, "flexible parts", r->flexible_parts);
    dmb_message_set(&note, "%u elements", r->elements);
    end_line(s, &note);
    begin_count(s, "structural joints", r->structural_joints);
    dmb_message_set(&note, "fixed, inside strings");
    end_line(s, &note);
}

/* "3   fixed 1, revolute 2, open 1" */
static void put_joints(sheet *s, const dmb_check_report *r)
{
    const char *between = "   ";
    uint32_t count = 0;
    for (int k = 0; k < DMB_JOINT_KINDS; k++) count += r->joints[k];
    begin_count(s, "joints", count);
    for (int32_t k = 0; k <= DMB_JOINT_KINDS; k++) {
        const uint32_t here = k < DMB_JOINT_KINDS ? r->joints[k] : r->open_joints;
        if (here == 0) continue;
        put(s, between);
        put(s, k < DMB_JOINT_KINDS ? dmb_joint_kind_name(k) : "and open");
        put(s, " ");
        put_count(s, here);
        between = ", ";
    }
    if (r->locked_joints > 0) {
        put(s, "; locked ");
        put_count(s, r->locked_joints);
    }
    end_line(s, NULL);
}

static void put_actions(sheet *s, const dmb_check_report *r)
{
    dmb_message note;
    begin_count(s, "couplings", r->couplings);
    end_line(s, NULL);
    begin_count(s, "constraints", r->constraints);
    end_line(s, NULL);
    begin_count(s, "drives", (int64_t)r->motion_drives + r->other_drives);
    dmb_message_set(&note, "motion %u, load or control %u", r->motion_drives, r->other_drives);
    end_line(s, &note);
    begin_count(s, "loads", r->loads);
    end_line(s, NULL);
}

static void put_degrees_of_freedom(sheet *s, const dmb_check_report *r)
{
    dmb_message note;
    begin_count(s, "coordinates", r->coordinates);
    end_line(s, NULL);
    begin_count(s, "Gruebler count", r->gruebler);
    dmb_message_set(&note, "%u - supports %u - prescribed %u - equations %u", r->coordinates, r->held, r->prescribed,
                    r->constraint_rows);
    end_line(s, &note);
    begin_count(s, "degrees of freedom", r->degrees_of_freedom);
    dmb_message_set(&note, "%u - supports %u - prescribed %u - rank %u", r->coordinates, r->held, r->prescribed,
                    r->rank);
    end_line(s, &note);
    begin_count(s, "redundant equations", r->redundant);
    end_line(s, NULL);
}

static void put_quality(sheet *s, const dmb_check_report *r)
{
    dmb_message note;
    if (r->clusters == 0) return;
    begin_number(s, "largest violation", r->largest_violation);
    dmb_message_set(&note, "m, -");
    end_line(s, &note);
    begin_number(s, "conditioning", r->condition);
    dmb_message_set(&note, "of %u cluster(s), the largest with %u coordinates", r->clusters, r->largest_cluster);
    end_line(s, &note);
}

static void put_solver(sheet *s, const dmb_check_report *r)
{
    dmb_message line;
    if (r->sparse_nodes == 0)
        dmb_message_set(&line, "  solver: block-tridiagonal, %u nodes\n", r->tridiagonal_nodes);
    else
        dmb_message_set(&line, "  solver: block-tridiagonal %u nodes, sparse %u nodes in %u blocks (fill %u)\n",
                        r->tridiagonal_nodes, r->sparse_nodes, r->blocks, r->fill);
    put(s, line.text);
}

/* Writes the bound of the momentum error of elements with the mass of straight ones. */
static void put_inertia(sheet *s, const dmb_model_check *findings)
{
    const dmb_bent_elements bent = dmb_find_bent(findings->sim);
    dmb_message line;
    if (bent.following + bent.constant == 0) return;
    dmb_message_set(&line,
                    "  mass matrix: curved for %u elements, straight for %u, which turn by at most %g rad: error of "
                    "momentum at most "
                    "%g %%\n",
                    bent.following, bent.constant, bent.bend, 100.0 * bent.error);
    put(s, line.text);
}

/* ---- Names and warnings ------------------------------------------------------------------------------------------ */

static void put_redundant(sheet *s, const dmb_model_check *findings)
{
    if (findings->report.redundant == 0) return;
    put(s, "  redundant equations:\n");
    for (uint32_t r = 0; r < findings->sim->scene->constraint_row_count; r++) {
        dmb_message name;
        if (!findings->rank.redundant[r]) continue;
        dmb_constraint_row_text(findings->sim, r, &name);
        put(s, "    ");
        put(s, name.text);
        put(s, "\n");
    }
}

static void put_warning(void *context, const char *text)
{
    sheet *s = context;
    put(s, "    ");
    put(s, text);
    put(s, "\n");
}

static void put_warnings(sheet *s, const dmb_model_check *findings)
{
    put(s, findings->report.warnings == 0 ? "  warnings: none\n" : "  warnings:\n");
    dmb_model_check_warnings(findings, put_warning, s);
}

static void put_all(sheet *s, const dmb_model_check *findings)
{
    const dmb_check_report *report = &findings->report;
    dmb_message head;
    dmb_message_set(&head, "model check at time %g s\n", findings->sim->clock->time);
    put(s, head.text);
    put_parts(s, report);
    put_joints(s, report);
    put_actions(s, report);
    put_degrees_of_freedom(s, report);
    put_quality(s, report);
    put_solver(s, report);
    put_inertia(s, findings);
    put_redundant(s, findings);
    put_warnings(s, findings);
}

int32_t dmb_analysis_check_text(const dmb_sim *sim, char *text, size_t size, size_t *needed)
{
    dmb_model_check findings;
    sheet s = {text, size, 0};
    if (sim == NULL) return dmb_sim_failed(sim, "model check", DMB_ERR_NULL);
    if (!dmb_handle_is(sim, DMB_HANDLE_SIM)) return dmb_sim_failed(sim, "model check", DMB_ERR_HANDLE);
    if (text == NULL && (size > 0 || needed == NULL)) return dmb_sim_failed(sim, "model check", DMB_ERR_NULL);
    const int32_t status = dmb_model_check_open(sim, &findings);
    if (status < 0) return status;
    put_all(&s, &findings);
    dmb_model_check_close(&findings);
    if (size > 0) text[s.used < size ? s.used : size - 1] = '\0';
    if (needed != NULL) *needed = s.used + 1;
    return dmb_sim_failed(sim, "model check", s.used < size ? DMB_OK : DMB_NOTE_FULL);
}
