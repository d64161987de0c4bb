#include "constraint/joint_names.h"

#include <stddef.h>

#define PX "position x"
#define PY "position y"
#define PZ "position z"
/* R_yx = 0: the x axis of b has no part along y of a, which a turn about z would give; R_zx and R_yz likewise. */
#define R_YX "rotation about z"
#define R_ZX "rotation about y"
#define R_YZ "rotation about x"

typedef struct kind_names {
    const char *kind;
    const char *row[DMB_ROWS_MAX];
} kind_names;

/* Rows in the order of constraint/joint.h. */
static const kind_names names[DMB_ROWS_KINDS] = {
    [DMB_ROWS_FIXED] = {"fixed", {PX, PY, PZ, R_YX, R_ZX, R_YZ}},
    [DMB_ROWS_REVOLUTE] = {"revolute", {PX, PY, PZ, R_YX, R_ZX}},
    [DMB_ROWS_PRISMATIC] = {"prismatic", {PY, PZ, R_YX, R_ZX, R_YZ}},
    [DMB_ROWS_CYLINDRICAL] = {"cylindrical", {PY, PZ, R_YX, R_ZX}},
    [DMB_ROWS_UNIVERSAL] = {"universal", {PX, PY, PZ, R_YZ}},
    [DMB_ROWS_SPHERICAL] = {"spherical", {PX, PY, PZ}},
    [DMB_ROWS_PLANAR] = {"planar", {PX, R_YX, R_ZX}},
    [DMB_ROWS_POINT_ON_LINE] = {"point-on-line", {PY, PZ}},
    [DMB_ROWS_POINT_ON_HOLE] = {"point-on-hole", {"position across the hole, y", "position across the hole, z"}},
    [DMB_ROWS_DISTANCE] = {"distance", {"distance"}},
    [DMB_ROWS_FREE] = {"free", {NULL}},
    [DMB_ROWS_KNIFE_EDGE] = {"knife-edge", {"sideways speed"}},
    [DMB_ROWS_ROLLING] = {"rolling", {"height of the rim", "slip along the way", "slip across the way"}},
};

const char *dmb_joint_kind_name(int32_t kind)
{
    return kind >= 0 && kind < DMB_ROWS_KINDS ? names[kind].kind : "joint";
}

const char *dmb_joint_row_name(int32_t kind, uint32_t row)
{
    if (kind < 0 || kind >= DMB_ROWS_KINDS || row >= DMB_ROWS_MAX || names[kind].row[row] == NULL) return "row";
    return names[kind].row[row];
}
