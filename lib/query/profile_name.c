/* Names, units and needs of the quantities of a profile. */
#include "query/query.h"

static const struct quantity {
    const char *name, *unit;
    int32_t groups;
} quantities_of[DMB_PROFILE_COUNT] = {
    [DMB_PROFILE_DISTANCE] = {"distance", "m", DMB_TAKES_STATION},
    [DMB_PROFILE_DEPTH] = {"depth", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_X] = {"x", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_Y] = {"y", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_Z] = {"z", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_DEVIATION] = {"deviation", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_DEVIATION_SIDE] = {"deviation_side", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_DEVIATION_UP] = {"deviation_up", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_AXIAL_FORCE] = {"axial_force", "N", DMB_TAKES_POSE | DMB_TAKES_SECTION},
    [DMB_PROFILE_EFFECTIVE_FORCE] = {"effective_force", "N", DMB_TAKES_SECTION},
    [DMB_PROFILE_TORQUE] = {"torque", "N m", DMB_TAKES_SECTION},
    [DMB_PROFILE_BENDING_MOMENT] = {"bending_moment", "N m", DMB_TAKES_POSE | DMB_TAKES_SECTION},
    [DMB_PROFILE_SHEAR_FORCE] = {"shear_force", "N", DMB_TAKES_SECTION},
    [DMB_PROFILE_CURVATURE] = {"curvature", "rad/m", DMB_TAKES_POSE | DMB_TAKES_SECTION},
    [DMB_PROFILE_NORMAL_FORCE] = {"normal_force", "N/m", DMB_TAKES_CONTACT},
    [DMB_PROFILE_FRICTION_AXIAL] = {"friction_axial", "N/m", DMB_TAKES_CONTACT},
    [DMB_PROFILE_FRICTION_AROUND] = {"friction_around", "N/m", DMB_TAKES_CONTACT},
    [DMB_PROFILE_VON_MISES] = {"von_mises", "Pa", DMB_TAKES_POSE | DMB_TAKES_SECTION | DMB_TAKES_LIMITS},
    [DMB_PROFILE_YIELD_SHARE] = {"yield_share", "-", DMB_TAKES_POSE | DMB_TAKES_SECTION | DMB_TAKES_LIMITS},
    [DMB_PROFILE_SINUSOIDAL_SHARE] = {"sinusoidal_share", "-", DMB_TAKES_POSE | DMB_TAKES_SECTION | DMB_TAKES_LIMITS},
    [DMB_PROFILE_HELICAL_SHARE] = {"helical_share", "-", DMB_TAKES_POSE | DMB_TAKES_SECTION | DMB_TAKES_LIMITS},
    [DMB_PROFILE_VELOCITY_AXIAL] = {"velocity_axial", "m/s", DMB_TAKES_MOTION},
    [DMB_PROFILE_VELOCITY_LATERAL] = {"velocity_lateral", "m/s", DMB_TAKES_MOTION},
    [DMB_PROFILE_SPIN] = {"spin", "rad/s", DMB_TAKES_MOTION},
    [DMB_PROFILE_ACCELERATION_AXIAL] = {"acceleration_axial", "m/s2", DMB_TAKES_MOTION},
    [DMB_PROFILE_ACCELERATION_LATERAL] = {"acceleration_lateral", "m/s2", DMB_TAKES_MOTION},
    [DMB_PROFILE_ROTATION] = {"rotation", "rad", DMB_TAKES_POSE},
    [DMB_PROFILE_DISPLACEMENT_X] = {"displacement_x", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_DISPLACEMENT_Y] = {"displacement_y", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_DISPLACEMENT_Z] = {"displacement_z", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_SHEAR_Y] = {"shear_y", "N", DMB_TAKES_SECTION},
    [DMB_PROFILE_SHEAR_Z] = {"shear_z", "N", DMB_TAKES_SECTION},
    [DMB_PROFILE_MOMENT_Y] = {"moment_y", "N m", DMB_TAKES_SECTION},
    [DMB_PROFILE_MOMENT_Z] = {"moment_z", "N m", DMB_TAKES_SECTION},
    [DMB_PROFILE_GAP] = {"gap", "m", DMB_TAKES_CONTACT},
};

static int is_quantity(int32_t quantity)
{
    return quantity >= 0 && quantity < DMB_PROFILE_COUNT;
}

int32_t dmb_profile_groups(int32_t quantity)
{
    return is_quantity(quantity) ? quantities_of[quantity].groups : -1;
}

const char *dmb_profile_name(int32_t quantity, const char **unit)
{
    if (unit != NULL) *unit = is_quantity(quantity) ? quantities_of[quantity].unit : NULL;
    return is_quantity(quantity) ? quantities_of[quantity].name : NULL;
}
