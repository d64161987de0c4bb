#include "model/field_check.h"

#include <string.h>

#include "model/section.h"

/* ---- Numbers ----------------------------------------------------------------------------------------------------- */

static bool is_within(double value, double low, double high)
{
    return value >= low && value <= high;
}

static bool is_zero(double value)
{
    return !(value < 0.0) && !(value > 0.0) && dmb_is_finite(value);
}

static bool holds(const dmb_def_field *field, double value)
{
    switch (field->bound) {
    case DMB_BOUND_FINITE: return dmb_is_finite(value);
    case DMB_BOUND_BETWEEN: return value > field->low && value < field->high;
    case DMB_BOUND_ABOVE: return value > field->low && dmb_is_finite(value);
    case DMB_BOUND_BITS: return ((uint32_t)(int32_t)value & ~(uint32_t)field->high) == 0;
    case DMB_BOUND_ZERO_OR: return is_zero(value) || is_within(value, field->low, field->high);
    case DMB_BOUND_NOT_GIVEN_OR: return value == DMB_NOT_GIVEN || is_within(value, field->low, field->high);
    default: return is_within(value, field->low, field->high);
    }
}

/* The bound in words, and as a range where it is one. */
static dmb_check_bound bound_of(const dmb_def_field *field, dmb_message *text)
{
    const char * or = field->bound == DMB_BOUND_ZERO_OR        ? "0 or "
                      : field->bound == DMB_BOUND_NOT_GIVEN_OR ? "-1 or "
                                                               : "";
    dmb_check_bound bound = {text->text, field->low, field->high};
    if (field->bound == DMB_BOUND_FINITE) {
        dmb_message_set(text, "finite");
        bound = (dmb_check_bound){text->text, -(double)INFINITY, (double)INFINITY};
    } else if (field->bound == DMB_BOUND_BITS) {
        dmb_message_set(text, "made of the bits of %g", field->high);
        bound.low = bound.high = (double)NAN;
    } else if (field->bound == DMB_BOUND_ABOVE) {
        dmb_message_set(text, "finite and > %g", field->low);
    } else if (field->bound == DMB_BOUND_BETWEEN) {
        dmb_message_set(text, "finite, > %g and < %g", field->low, field->high);
    } else if (field->type == DMB_TYPE_REAL || field->type == DMB_TYPE_REALS) {
        dmb_message_set(text, "finite, %s>= %g and <= %g", or, field->low, field->high);
    } else {
        dmb_message_set(text, "%s%g .. %g", or, field->low, field->high);
    }
    return bound;
}

static bool is_array(const dmb_def_field *field)
{
    return field->type == DMB_TYPE_REALS || field->size > dmb_field_element_size(field);
}

static void check_numbers(dmb_check *check, const dmb_def_field *field, const void *def)
{
    const size_t count = dmb_field_elements(field, def);
    if (count > 0) dmb_check_pointer(check, field->name, dmb_field_at(field, def));
    for (size_t i = 0; i < count && check->status >= 0; ++i) {
        const dmb_field_value is = {field->name, is_array(field) ? (uint32_t)i : DMB_NONE,
                                    dmb_field_number(field, def, i)};
        dmb_message text;
        if (holds(field, is.value)) continue;
        const dmb_check_bound must = bound_of(field, &text);
        dmb_check_fail_value(check, dmb_is_finite(is.value) ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE, &is, &must);
    }
}

void dmb_check_zero_or_within(dmb_check *check, const char *field, double value, double low, double high)
{
    if (!is_zero(value)) dmb_check_within(check, field, value, low, high);
}

void dmb_check_each_within(dmb_check *check, const char *field, const double *values, size_t count, double low,
                           double high)
{
    dmb_message text;
    dmb_message_set(&text, "finite, >= %g and <= %g", low, high);
    const dmb_check_bound must = {text.text, low, high};
    for (size_t i = 0; i < count && check->status >= 0; ++i) {
        const dmb_field_value is = {field, (uint32_t)i, values[i]};
        if (!is_within(is.value, low, high))
            dmb_check_fail_value(check, dmb_is_finite(is.value) ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE, &is, &must);
    }
}

/* ---- Ids and places ---------------------------------------------------------------------------------------------- */

void dmb_check_id(dmb_check *check, const dmb_model *model, const char *field, dmb_id id, uint32_t kind,
                  const char *what)
{
    if (check->status < 0 || dmb_model_part_index(model, id, kind) != DMB_NONE) return;
    const int foreign = !dmb_id_is_none(id) && id.generation != model->stamp;
    check->status = DMB_ERR_ID;
    dmb_message_set(check->message, "%s: %s = {%u, %u}, must name a %s of this model%s", check->part, field, id.index,
                    id.generation, what, foreign ? "; another model gave out this id: take one of this model" : "");
}

void dmb_check_id_or_none(dmb_check *check, const dmb_model *model, const char *field, dmb_id id, uint32_t kind,
                          const char *what)
{
    if (!dmb_id_is_none(id)) dmb_check_id(check, model, field, id, kind, what);
}

void dmb_check_place(dmb_check *check, const dmb_model *model, const char *field, const dmb_place *place)
{
    const bool on_body = dmb_model_part_index(model, place->part, DMB_PART_BODY) != DMB_NONE ||
                         dmb_model_part_index(model, place->part, DMB_PART_BIT) != DMB_NONE ||
                         dmb_model_part_index(model, place->part, DMB_PART_STABILISER) != DMB_NONE;
    dmb_message part, pipe, fraction;
    dmb_message_set(&part, "%s.part", field);
    dmb_message_set(&pipe, "%s.pipe", field);
    dmb_message_set(&fraction, "%s.fraction", field);
    dmb_check_finite(check, fraction.text, place->fraction);
    if (!on_body)
        dmb_check_id(check, model, part.text, place->part, DMB_PART_STRING, "string, a body, a bit or a ring");
    dmb_check_within(check, fraction.text, place->fraction, 0.0, on_body ? 0.0 : 1.0);
    if (on_body) dmb_check_count(check, pipe.text, place->pipe, 0, 0);
}

void dmb_check_free_set(dmb_check *check, const char *field, int32_t mask)
{
    if (mask > 0 && (mask & ~(DMB_FREE_ALL | DMB_FREE_NONE)) == 0) return;
    dmb_check_fail(check, DMB_ERR_VALUE, field, mask,
                   "a set of DMB_FREE_..., e.g. DMB_FREE_X | DMB_FREE_RX, or DMB_FREE_NONE; DMB_X .. DMB_RZ are "
                   "indices of components, not sets");
}

void dmb_check_motion_mask(dmb_check *check, const char *field, int32_t mask)
{
    dmb_check_free_set(check, field, mask);
    if (dmb_set_is_closed(dmb_free_set(mask))) return;
    dmb_check_fail(check, DMB_ERR_UNSUPPORTED, field, mask,
                   "a closed set, DMB_FREE_NONE, _ALL, _X, _Y, _Z, _XY, _XZ, _YZ, _TRANSLATIONS, _RX, _RY, _RZ, "
                   "_SPHERICAL, or _CYLINDRICAL, _PLANAR, _SCHOENFLIES (of x, y, z); hold others by a joint");
}

/* ---- All fields -------------------------------------------------------------------------------------------------- */

/* Ids and places, whose messages name the element of an array as part of the field. */
static void check_reference(dmb_check *check, const dmb_model *model, const dmb_def_field *field, const void *def)
{
    const uint32_t kind = (uint32_t)field->low;
    for (size_t i = 0; i < dmb_field_elements(field, def) && check->status >= 0; ++i) {
        const void *at = (const char *)dmb_field_at(field, def) + i * dmb_field_element_size(field);
        const dmb_id id = *(const dmb_id *)at; /* a place begins with one */
        const bool may_be_none = field->bound == DMB_BOUND_PART_OR_NONE || field->bound == DMB_BOUND_GROUND_OR_PLACE;
        dmb_message name;
        if (is_array(field))
            dmb_message_set(&name, "%s[%zu]", field->name, i);
        else
            dmb_message_set(&name, "%s", field->name);
        if (may_be_none && dmb_id_is_none(id)) continue;
        if (field->type == DMB_TYPE_ID)
            dmb_check_id(check, model, name.text, id, kind, dmb_part_word(kind));
        else
            dmb_check_place(check, model, name.text, at);
    }
}

/* The bytes of a pointer of any kind: a function's need not be an object's. */
static void check_is_there(dmb_check *check, const dmb_def_field *field, const void *def)
{
    static const unsigned char null[sizeof(void (*)(void))];
    const void *at = (const char *)def + field->offset;
    dmb_check_pointer(check, field->name, memcmp(at, null, field->size) != 0 ? at : NULL);
}

static void check_field(dmb_check *check, const dmb_model *model, const dmb_def_field *field, const void *def)
{
    switch (field->bound) {
    case DMB_BOUND_ANY:
    case DMB_BOUND_TEXT: break;
    case DMB_BOUND_SET: dmb_check_free_set(check, field->name, (int32_t)dmb_field_number(field, def, 0)); break;
    case DMB_BOUND_MOTION: dmb_check_motion_mask(check, field->name, (int32_t)dmb_field_number(field, def, 0)); break;
    case DMB_BOUND_PART:
    case DMB_BOUND_PART_OR_NONE:
    case DMB_BOUND_PLACE:
    case DMB_BOUND_GROUND_OR_PLACE: check_reference(check, model, field, def); break;
    case DMB_BOUND_POINTER: check_is_there(check, field, def); break;
    default: check_numbers(check, field, def);
    }
}

void dmb_check_fields(dmb_check *check, const dmb_model *model, const dmb_field_list *list, const void *def)
{
    const dmb_def_field *name = dmb_field_name(list); /* first, since messages about the others state it */
    if (name != NULL) dmb_check_part_name(check, model, list->kind, dmb_field_at(name, def));
    for (uint32_t i = 0; i < list->count && check->status >= 0; ++i) check_field(check, model, &list->fields[i], def);
}

void dmb_options_get(dmb_check *check, const dmb_field_list *list, const void *given, void *out)
{
    memcpy(out, list->defaults, list->size);
    memcpy(out, &list->size, sizeof list->size);
    if (given != NULL && dmb_struct_read(out, list->size, list->oldest, given) < 0)
        dmb_check_fail(check, DMB_ERR_STRUCT_SIZE, "struct_size", *(const uint32_t *)given,
                       "that of this library's header or an older one; fill the struct by its _default first");
    for (uint32_t i = 0; i < list->count; ++i) /* numbers, or not checked by themselves */
        if (list->fields[i].bound != DMB_BOUND_ANY) check_numbers(check, &list->fields[i], out);
}

/* ---- Inertias ---------------------------------------------------------------------------------------------------- */

/* Principal moments of inertia, and the bound that every distribution of mass keeps. With E the second moments of the
 * mass, J = (tr E) I - E; the principal moments are J1 = E2 + E3, J2 = E1 + E3, J3 = E1 + E2 with E1, E2, E3 >= 0, so
 * that none exceeds the sum of the two others: J1 <= J2 + J3 and so on. */

/* [-] of the largest moment: how far rounded values may miss the bound, on which thin rods and discs lie. Values in
 * single precision pass. */
static const double rounding = 1e-6;

/* Cholesky of the matrix scaled to a unit diagonal, so that neither large nor small inertias over- or underflow. */
static bool is_positive_definite(const double J[6])
{
    if (!(J[0] > 0.0 && J[1] > 0.0 && J[2] > 0.0)) return false;
    const double xy = J[3] / (sqrt(J[0]) * sqrt(J[1]));
    const double xz = J[4] / (sqrt(J[0]) * sqrt(J[2]));
    const double yz = J[5] / (sqrt(J[1]) * sqrt(J[2]));
    const double second = 1.0 - xy * xy;
    if (!(second > 0.0)) return false;
    return 1.0 - xz * xz - (yz - xy * xz) * (yz - xy * xz) / second > 0.0;
}

/* A <- R^T A R with the rotation by which a_pq becomes 0: Jacobi 1846; t = tan of the smaller angle. */
static void rotate_plane(double A[3][3], int p, int q)
{
    const int r = 3 - p - q;
    if (!(fabs(A[p][q]) > 0.0)) return;
    const double theta = (A[q][q] - A[p][p]) / (2.0 * A[p][q]);
    const double t = (theta < 0.0 ? -1.0 : 1.0) / (fabs(theta) + sqrt(1.0 + theta * theta));
    const double c = 1.0 / sqrt(1.0 + t * t), s = t * c;
    const double rp = A[r][p], rq = A[r][q];
    A[p][p] -= t * A[p][q];
    A[q][q] += t * A[p][q];
    A[p][q] = A[q][p] = 0.0;
    A[r][p] = A[p][r] = c * rp - s * rq;
    A[r][q] = A[q][r] = s * rp + c * rq;
}

/* The eigenvalues, largest first. Sweeps converge quadratically; six are enough for any 3x3 matrix. */
static void principal_moments(const double J[6], double moment[3])
{
    double A[3][3] = {{J[0], J[3], J[4]}, {J[3], J[1], J[5]}, {J[4], J[5], J[2]}};
    for (int sweep = 0; sweep < 6; ++sweep) {
        rotate_plane(A, 0, 1);
        rotate_plane(A, 0, 2);
        rotate_plane(A, 1, 2);
    }
    for (int i = 0; i < 3; ++i) moment[i] = A[i][i];
    for (int i = 0; i < 3; ++i) {
        const int next = i % 2;
        const double larger = fmax(moment[next], moment[next + 1]), smaller = fmin(moment[next], moment[next + 1]);
        moment[next] = larger;
        moment[next + 1] = smaller;
    }
}

static void check_moments(dmb_check *check, const char *field, const double moment[3])
{
    if (moment[0] <= moment[1] + moment[2] + rounding * moment[0]) return;
    check->status = DMB_ERR_VALUE;
    dmb_message_set(
        check->message,
        "%s: %s gives the principal moments %g, %g, %g kg m2; no body has a moment above the sum of the two "
        "others: lower the first or raise the others, defaults and those of free axes too",
        check->part, field, moment[0], moment[1], moment[2]);
}

void dmb_check_inertia_matrix(dmb_check *check, const char *field, const double J[6])
{
    double moment[3];
    if (check->status < 0) return;
    if (!is_positive_definite(J)) {
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message, "%s: %s = (%g, %g, %g, %g, %g, %g) kg m2, must be positive definite",
                        check->part, field, J[0], J[1], J[2], J[3], J[4], J[5]);
        return;
    }
    principal_moments(J, moment);
    check_moments(check, field, moment);
}

/* About the axis E2 + E3 = 2 E2, across E1 + E2: only the moment about the axis can be too large. */
void dmb_check_inertia_of_revolution(dmb_check *check, const char *field, const double J[2])
{
    const double about_first[3] = {J[0], J[1], J[1]};
    if (check->status >= 0) check_moments(check, field, about_first);
}

void dmb_check_rigid_pipe_inertia(dmb_check *check, const dmb_pipe_def *def)
{
    dmb_rigid_part pipe;
    if (check->status < 0) return;
    dmb_rigid_pipe_of(def, &pipe);
    dmb_check_inertia_of_revolution(check, "section_inertia of a rigid pipe", pipe.inertia);
}
