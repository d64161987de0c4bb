"""Positions along a surveyed well against the published formulas of the minimum curvature method."""
import math

import numpy as np

from case import Case, Row, case, picture
from wells import HERE, numbers, volve_sim


def minimum_curvature(survey):
    """[m] north, east, depth of the stations: half the distance times (t0 + t1) times the ratio factor
    tan(b/2)/(b/2)."""
    depth, inclination, azimuth = survey[:, 0], np.radians(survey[:, 1]), np.radians(survey[:, 2])
    places = [np.zeros(3)]
    for k in range(1, len(survey)):
        tangents = [np.array([math.sin(inclination[j]) * math.cos(azimuth[j]),
                              math.sin(inclination[j]) * math.sin(azimuth[j]),
                              math.cos(inclination[j])]) for j in (k - 1, k)]
        bend = 2.0 * math.asin(min(1.0, 0.5 * float(np.linalg.norm(tangents[1] - tangents[0]))))
        factor = math.tan(0.5 * bend) / (0.5 * bend) if bend > 0.0 else 1.0
        places.append(places[-1] + 0.5 * (depth[k] - depth[k - 1]) * factor * (tangents[0] + tangents[1]))
    return np.array(places)


@case("well_path")
def well_path(pictures):
    _, survey = numbers(HERE / "volve" / "survey.csv")
    want, sim = minimum_curvature(survey), volve_sim()
    axes_of_world = np.array([list(sim.hole(depth).position) for depth in survey[:, 0]])
    got = axes_of_world * (1.0, -1.0, -1.0)  # the world is north, west, up
    rows = []
    for k in (100, 300, len(survey) - 1):
        rows += [Row(f"{name} at {survey[k, 0]:.1f} m", "m", want[k, axis], got[k, axis],
                     f"station {k + 1} of {len(survey)}", 1e-6, 1.0)
                 for axis, name in enumerate(("north", "east", "true vertical depth"))]
    rows.append(Row("largest distance of all stations", "m", 0.0, float(np.linalg.norm(got - want, axis=1).max()),
                    f"{len(survey)} stations", 1e-6, 1.0))
    def draw(axes):
        axes[0].plot(got[:, 1], got[:, 0], color="C0", label="library")
        axes[0].plot(want[::25, 1], want[::25, 0], "o", color="C3", markersize=3, label="formulas")
        axes[0].set(xlabel="east [m]", ylabel="north [m]", aspect="equal")
        axes[0].legend()
        away = np.hypot(got[:, 0], got[:, 1])
        axes[1].plot(away, got[:, 2], color="C0")
        axes[1].plot(np.hypot(want[::25, 0], want[::25, 1]), want[::25, 2], "o", color="C3", markersize=3)
        axes[1].set(xlabel="horizontal distance [m]", ylabel="true vertical depth [m]")
        axes[1].invert_yaxis()
    return Case("well_path", "Positions along a surveyed well by minimum curvature", "published",
                "Sawaryn, Thorogood 2005, SPE Drilling and Completion 20, 24 (compendium of directional calculations)",
                "10.2118/84246-PA", "survey of the Volve well: measured depth, inclination, azimuth of 511 stations",
                "nothing", rows,
                "The positions of 94 stations that a test of the public program wellpathpy carries agree within 6e-6 "
                "m; that table "
                "is not part of this tree.",
                "Equinor Open Data Licence; holder: Equinor ASA and the former Volve licence partners",
                [picture(draw, 2, 9.5, 3.8)] if pictures else [])
