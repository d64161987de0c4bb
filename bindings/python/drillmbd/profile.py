"""A string from end to end as arrays."""
from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

from ._keep import station
from ._optional import need
from ._structs import Id
from .enums import ERR_UNSUPPORTED
from .errors import Error

if TYPE_CHECKING:
    from .sim import Sim

_NAN6 = (float("nan"),) * 6


@dataclass
class Profile:
    """Values along a string, numpy arrays: n stations from the rig end on."""
    along: Any         #: [m] arc length from the rig end, shape (n)
    depth: Any         #: [m] measured depth in the hole, 0 without a hole, shape (n)
    position: Any      #: [m] world frame, shape (n, 3)
    displacement: Any  #: [m] since time 0 as described, world frame, shape (n, 3)
    rotation: Any      #: [rad] about the pipe's own axis since time 0, shape (n)
    force: Any         #: [N, N m] axial (tension > 0), shear y, z, torque, bending moment y, z; NaN on rigid pipes, (n, 6)
    contact_depth: Any  #: [m] measured depth of the contact sites of this string, shape (m)
    contact_force: Any  #: [N] normal force there on the wall, shape (m)
    contact_gap: Any   #: [m] there to the wall, < 0 when penetrating, shape (m)

    @property
    def axial_force(self) -> Any:
        """[N] tension > 0, shape (n)"""
        return self.force[:, 0]

    @property
    def torque(self) -> Any:
        """[N m], shape (n)"""
        return self.force[:, 3]

    @property
    def bending_moment(self) -> Any:
        """[N m] magnitude, shape (n)"""
        return (self.force[:, 4] ** 2 + self.force[:, 5] ** 2) ** 0.5

    def frame(self) -> Any:
        """The stations as a pandas frame with units in the names of its columns; contact sites are not in it."""
        columns = {"along [m]": self.along, "depth [m]": self.depth}
        for i, axis in enumerate("xyz"):
            columns[f"position {axis} [m]"] = self.position[:, i]
            columns[f"displacement {axis} [m]"] = self.displacement[:, i]
        columns.update({"rotation [rad]": self.rotation, "axial force [N]": self.axial_force,
                        "shear y [N]": self.force[:, 1], "shear z [N]": self.force[:, 2], "torque [N m]": self.torque,
                        "bending moment [N m]": self.bending_moment})
        return need("pandas").DataFrame(columns)


def _section(sim: Sim, place: Any) -> Any:
    try:
        return list(sim.section(place).force)
    except Error as error:
        if error.status != ERR_UNSUPPORTED:
            raise
        return _NAN6  # a rigid pipe


def profile(sim: Sim, string: Id, pipes: int, per_pipe: int = 2) -> Profile:
    """The profile of a string of `pipes` pipes at `per_pipe` stations of each and at its rig end."""
    numpy = need("numpy")
    if per_pipe < 1:
        raise ValueError(f"per_pipe = {per_pipe}, must be >= 1")
    places = [station(string, 0, 0.0)] + [station(string, pipe, (i + 1) / per_pipe)
                                          for pipe in range(pipes) for i in range(per_pipe)]
    poses = [sim.pose(place) for place in places]
    position = numpy.array([list(pose.position) for pose in poses])
    steps = numpy.linalg.norm(numpy.diff(position, axis=0), axis=1)
    contacts = _contacts(sim, string)
    return Profile(along=numpy.concatenate([[0.0], numpy.cumsum(steps)]), depth=numpy.array([pose.depth for pose in poses]),
                   position=position, displacement=numpy.array([list(pose.displacement) for pose in poses]),
                   rotation=numpy.array([sim.rotation(place) for place in places]),
                   force=numpy.array([_section(sim, place) for place in places]),
                   contact_depth=numpy.array([one[0] for one in contacts]),
                   contact_force=numpy.array([one[1] for one in contacts]),
                   contact_gap=numpy.array([one[2] for one in contacts]))


def _contacts(sim: Sim, string: Id) -> list[tuple[float, float, float]]:
    """(depth, normal force, gap) of the contact sites of a string."""
    found: list[tuple[float, float, float]] = []
    site = 0
    while True:
        try:
            contact = sim.contact(site)
        except Error:
            return found  # there are no more
        site += 1
        if contact.part == string:
            end = contact.pipe == 0xFFFFFFFF
            pose = sim.pose(station(string, 0 if end else contact.pipe, 0.0 if end else 1.0))
            found.append((pose.depth, contact.normal_force, contact.gap))


FIELDS = [field.name for field in fields(Profile)]
