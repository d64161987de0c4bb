#include "constraint/joint_names.h"

#include <stddef.h>

#define DMB_NAME_PX "position x"
#define DMB_NAME_PY "position y"
#define DMB_NAME_PZ "position z"
/* R_yx = 0: the x axis of b has no part along y of a, which a turn about z would give; R_zx and R_yz likewise. */
#define DMB_NAME_R_YX "rotation about z"
#define DMB_NAME_R_ZX "rotation about y"
#define DMB_NAME_R_YZ "rotation about x"

typedef struct kind_names {
    const char *kind;
    const char *row[DMB_ROWS_MAX];
} kind_names;

/* Rows in the order of constraint/joint.h. */
static const kind_names names[DMB_ROWS_KINDS] = {
    [DMB_ROWS_FIXED] = {"fixed", {DMB_NAME_PX, DMB_NAME_PY, DMB_NAME_PZ, DMB_NAME_R_YX, DMB_NAME_R_ZX, DMB_NAME_R_YZ}},
    [DMB_ROWS_REVOLUTE] = {"revolute", {DMB_NAME_PX, DMB_NAME_PY, DMB_NAME_PZ, DMB_NAME_R_YX, DMB_NAME_R_ZX}},
    [DMB_ROWS_PRISMATIC] = {"prismatic", {DMB_NAME_PY, DMB_NAME_PZ, DMB_NAME_R_YX, DMB_NAME_R_ZX, DMB_NAME_R_YZ}},
    [DMB_ROWS_CYLINDRICAL] = {"cylindrical", {DMB_NAME_PY, DMB_NAME_PZ, DMB_NAME_R_YX, DMB_NAME_R_ZX}},
    [DMB_ROWS_UNIVERSAL] = {"universal", {DMB_NAME_PX, DMB_NAME_PY, DMB_NAME_PZ, DMB_NAME_R_YZ}},
    [DMB_ROWS_SPHERICAL] = {"spherical", {DMB_NAME_PX, DMB_NAME_PY, DMB_NAME_PZ}},
    [DMB_ROWS_PLANAR] = {"planar", {DMB_NAME_PX, DMB_NAME_R_YX, DMB_NAME_R_ZX}},
    [DMB_ROWS_POINT_ON_LINE] = {"point-on-line", {DMB_NAME_PY, DMB_NAME_PZ}},
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
