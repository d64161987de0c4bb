"""A string from end to end as arrays."""
from __future__ import annotations

from collections.abc import Iterable
from ctypes import POINTER, byref, c_char_p, c_double, c_int32, cast
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from ._keep import station
from ._library import lib
from ._optional import need
from ._structs import Id, PipeDef, ProfileStruct
from ._values import whole
from .enums import ProfileQuantity
from .errors import Error

if TYPE_CHECKING:
    from .sim import Sim

QUANTITIES = list(ProfileQuantity)
INSIDE = 1e-6  #: of a pipe, a station behind its beginning
SECTION = ("length", "elements", "outer_diameter", "inner_diameter", "joint_length", "joint_outer_diameter",
           "joint_inner_diameter")


def unit_of(quantity: int) -> str:
    """Unit of a quantity of a profile, as "N m"."""
    unit = c_char_p()
    lib.dmb_profile_name(quantity, byref(unit))
    return (unit.value or b"").decode()


@dataclass
class Profile:
    """Values along a string, numpy arrays: n stations from the rig end on. profile["von_mises"] or
    profile[PROFILE_VON_MISES] is one quantity, shape (n); the names are those of PROFILE_... in small letters."""
    values: dict[str, Any]  #: every quantity by its name, each shape (n)
    contact_depth: Any  #: [m] measured depth of the contact points of this string, shape (m)
    contact_force: Any  #: [N] normal force there on the wall, shape (m)
    contact_gap: Any   #: [m] there to the wall, < 0 when penetrating, shape (m)

    def __getitem__(self, quantity: str | int) -> Any:
        if isinstance(quantity, int):
            quantity = ProfileQuantity(quantity).name.lower()
        if quantity not in self.values:
            raise KeyError(f"{quantity!r} is no quantity of a profile; there are {', '.join(self.values)}")
        return self.values[quantity]

    def keys(self) -> list[str]:
        """The names of the quantities."""
        return list(self.values)

    def _asdict(self) -> dict[str, Any]:
        """The quantities by name, each shape (n)."""
        return dict(self.values)

    def _columns(self, *names: str) -> Any:
        return need("numpy").stack([self.values[name] for name in names], axis=1)

    @property
    def along(self) -> Any:
        """[m] distance from the rig end, shape (n)"""
        return self.values["distance"]

    @property
    def depth(self) -> Any:
        """[m] measured depth in the hole, 0 without a hole, shape (n)"""
        return self.values["depth"]

    @property
    def position(self) -> Any:
        """[m] world frame, shape (n, 3)"""
        return self._columns("x", "y", "z")

    @property
    def displacement(self) -> Any:
        """[m] since time 0 as described, world frame, shape (n, 3)"""
        return self._columns("displacement_x", "displacement_y", "displacement_z")

    @property
    def rotation(self) -> Any:
        """[rad] about the pipe's own axis since time 0, shape (n)"""
        return self.values["rotation"]

    @property
    def force(self) -> Any:
        """[N, N m] axial (effective, tension > 0), shear y, z, torque, bending moment y, z; NaN on rigid pipes, (n,
        6)"""
        return self._columns("effective_force", "shear_y", "shear_z", "torque", "moment_y", "moment_z")

    @property
    def axial_force(self) -> Any:
        """[N] effective axial force, tension > 0, shape (n); ["axial_force"] is the true one, mud pressure counted"""
        return self.values["effective_force"]

    @property
    def torque(self) -> Any:
        """[N m], shape (n)"""
        return self.values["torque"]

    @property
    def bending_moment(self) -> Any:
        """[N m] magnitude, shape (n)"""
        return self.values["bending_moment"]

    def frame(self) -> Any:
        """The stations as a pandas frame with units in the names of its columns; contact points are not in it."""
        return need("pandas").DataFrame({f"{one.name.lower().replace('_', ' ')} [{unit_of(one)}]":
                                         self.values[one.name.lower()] for one in QUANTITIES})


def span(values: Any) -> tuple[float, float]:
    """Least and largest of values along a string where they are defined; NaN if nowhere, as forces of rigid pipes."""
    numpy = need("numpy")
    return float(numpy.fmin.reduce(values)), float(numpy.fmax.reduce(values))


class Extremes(NamedTuple):
    """Least and largest value of a quantity over the stations of a string, and their distances [m] from the rig end;
    NaN where no station has a value."""
    minimum: float
    minimum_at: float
    maximum: float
    maximum_at: float


class _Stations:
    """Quantities PROFILE_... at distances [m] from the rig end, or at `count` stations spread evenly."""

    def __init__(self, string: Id, quantities: Iterable[int], distance: Any, count: int) -> None:
        numpy = need("numpy")
        self.wanted = numpy.array(list(quantities), dtype=numpy.int32)
        self.places = None if distance is None else numpy.ascontiguousarray(distance, dtype=float).reshape(-1)
        self.count = count if self.places is None else len(self.places)
        self.request = ProfileStruct(string=string, station_count=self.count, quantity_count=len(self.wanted),
                                     quantities=cast(self.wanted.ctypes.data, POINTER(c_int32)))
        if self.places is not None:
            self.request.distance = cast(self.places.ctypes.data, POINTER(c_double))


def values_of(sim: Sim, string: Id, quantities: Iterable[int], distance: Any = None, count: int = 0) -> Any:
    """Quantities PROFILE_... at distances [m] from the rig end, or at `count` stations spread evenly; numpy array of
    shape (stations, quantities)."""
    requested = _Stations(string, quantities, distance, count)
    values = need("numpy").empty((requested.count, len(requested.wanted)))
    requested.request.values = cast(values.ctypes.data, POINTER(c_double))
    sim._told(lib.dmb_query_profile(sim._handle, byref(requested.request)), lib.dmb_query_profile, string)
    return values


def extremes_of(sim: Sim, string: Id, quantities: Iterable[int], distance: Any = None,
                count: int = 0) -> list[Extremes]:
    """Extremes of each quantity over these stations, in one call."""
    requested = _Stations(string, quantities, distance, count)
    found = (c_double * (4 * len(requested.wanted)))()
    sim._told(lib.dmb_query_profile_extremes(sim._handle, byref(requested.request), found),
              lib.dmb_query_profile_extremes, string)
    return [Extremes(*found[4 * i:4 * i + 4]) for i in range(len(requested.wanted))]


def ends_of_elements(calls: Iterable[tuple[str, Any]], string: Id) -> Any:
    """[m] Distances from the rig end at which each section of a string is seen, by its description: the ends of all
    elements, the beginning of each kind of pipes, and tool joints that are weaker than their pipe. Stations spread
    evenly miss pipes that are shorter than their spacing."""
    numpy, start = need("numpy"), 0.0
    found = [numpy.zeros(1)]
    for name, arguments in calls:
        if name != "add_pipes" or arguments[1].get("string") != string:
            continue
        pipe: Any = PipeDef(**{key: value for key, value in arguments[1].items() if key in SECTION})
        count = int(arguments[0])
        found += [[start + INSIDE * pipe.length],
                  (start + pipe.length * numpy.arange(count)[:, None] + _ends(pipe)).reshape(-1)]
        start += pipe.length * count
    return numpy.minimum(numpy.concatenate(found), start)


def _ends(pipe: Any) -> list[float]:
    """[m] Places in a pipe that its section forces are taken at. The end of a pipe without tool joint is the beginning
    of the next one."""
    body = float(pipe.length - pipe.joint_length)
    ends = [body * (i + 1) / pipe.elements for i in range(pipe.elements)]
    if not pipe.joint_length > 0.0:
        return ends
    weak = 0.0 < pipe.joint_outer_diameter < pipe.outer_diameter or pipe.joint_inner_diameter > pipe.inner_diameter
    return [INSIDE * pipe.length, *ends, *([float(pipe.length)] if weak else [])]


def profile(sim: Sim, string: Id, pipes: int, per_pipe: int = 2) -> Profile:
    """The profile of a string of `pipes` pipes at its rig end and `per_pipe` stations a pipe, spread evenly."""
    numpy = need("numpy")
    pipes, per_pipe = whole(pipes, "profile", "pipes", 1), whole(per_pipe, "profile", "per_pipe", 1, 10 ** 6)
    table = values_of(sim, string, QUANTITIES, count=pipes * per_pipe + 1)
    contacts = _contacts(sim, string)
    return Profile({one.name.lower(): table[:, i] for i, one in enumerate(QUANTITIES)},
                   *(numpy.array([one[i] for one in contacts]) for i in range(3)))


def _contacts(sim: Sim, string: Id) -> list[tuple[float, float, float]]:
    """(depth, normal force, gap) of the contact points of a string."""
    found: list[tuple[float, float, float]] = []
    number = 0
    while True:
        try:
            contact = sim.contact(number)
        except Error:
            return found  # there are no more
        number += 1
        if contact.part == string:
            end = contact.pipe == 0xFFFFFFFF
            pose = sim.pose(station(string, 0 if end else contact.pipe, 0.0 if end else 1.0))
            found.append((pose.depth, contact.normal_force, contact.gap))
