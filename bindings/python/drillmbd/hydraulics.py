"""Pressures of the mud by depth: losses, pump, equivalent circulating density, surge and swab of tripping."""
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ._structs import Hydraulics
from .results import CommandOutput, file_name, finite, key_of
from .sim import Sim

FIELDS = {name: unit for name, (unit, _) in Hydraulics.field_docs.items() if name not in ("struct_size", "reserved")}


def write(sim: Sim, out: CommandOutput, name: str, depths: Sequence[float], trip_speed: float) -> None:
    """Table, picture data and sentences; nothing for a scene whose mud does not flow."""
    if not sim.flow().rate > 0.0:
        return
    rows = [sim.hydraulics(depth, trip_speed) for depth in depths]
    columns = {key_of(key, unit): [finite(getattr(row, key)) for row in rows] for key, unit in FIELDS.items()}
    results: dict[str, Any] = {"trip_speed_m_s": trip_speed, **columns}
    out.summary.setdefault("hydraulics", {})[name] = results
    out.table(f"hydraulics_{file_name(name)}.csv", [f"{key.replace('_', ' ')} [{unit or '-'}]"
                                                    for key, unit in FIELDS.items()],
                 [[getattr(row, key) for key in FIELDS] for row in rows])
    out.say(f"{name}, mud at {out.units.text(rows[-1].depth, 'm')}: {_sentence(rows[-1], out)}")


def _sentence(row: Hydraulics, out: CommandOutput) -> str:
    units = out.units
    parts = [f"pump pressure {units.text(row.pump_pressure / 1e6, 'MPa', '.3g')}",
             f"{units.text(row.annulus_loss / 1e6, 'MPa', '.3g')} lost in the annulus"]
    if math.isfinite(row.circulating_density):
        parts.append(f"equivalent circulating density {units.text(row.circulating_density, 'kg/m3', '.4g')}")
        if row.trip_pressure > 0.0:
            parts.append(f"tripping gives {units.text(row.surge_density, 'kg/m3', '.4g')} going in and "
                         f"{units.text(row.swab_density, 'kg/m3', '.4g')} coming out")
    else:
        parts.append("equivalent density not assessed, because the bit is not below the collar")
    return ", ".join(parts)
