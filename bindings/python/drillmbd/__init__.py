"""libdrillmbd from Python: describe - compile - run - query. Needs ctypes only; uses numpy for arrays, pandas for
frames, matplotlib for pictures where they are there.

    import drillmbd as mbd

    model = mbd.Model()
    model.add_wall(diameter=0.094)
    string = model.add_pipes(100, outer_diameter=0.073, inner_diameter=0.061)
    model.add_bit(mass=5.0)
    feed = model.add_time_function(mbd.Segment(kind=mbd.SEGMENT_STEP, x1=1.0, h1=0.01))
    model.add_drive(time_function=feed)
    model.compile()
    with model.sim() as sim:
        sim.run(40.0, step=1e-3)
        print(sim.pose(mbd.station(string, 99, 1.0)).position)

Structs carry the names of the C interface without dmb_ and in capitals (dmb_pipe_def is PipeDef), with the same fields,
units and defaults: help(drillmbd.PipeDef) shows them. Functions that take one also take its fields as keywords. A call
that fails raises Error; a status above 0 is in the `status` of the result. Everything is in SI units, angles in
radians.
The library is the file that the environment variable DRILLMBD_LIBRARY names, otherwise the one beside this package,
otherwise the one the system finds.
"""
from . import _structs, analysis, outputs, enums, errors, model, profile, recorder, sim
from ._keep import station
from ._library import lib as _lib
from ._optional import numpy
from ._record import Sized as _Sized
from ._structs import *  # noqa: F401,F403
from ._structs import STRUCTS
from .analysis import Buckling, Modes, Response, TorqueDrag, operation_name, usual_operation
from .outputs import output_name, output_names, output_of, output_text, output_quantity, output_unit
from .enums import *  # noqa: F401,F403
from .enums import ENUMS, VERSION, __version__
from .errors import Error, status_name, status_text
from .fatigue import Fatigue
from .inputs import InputLog, Inputs
from .model import Model, motor_drive
from .profile import Extremes, Profile
from .recorder import ProfileRecorder, Recorder
from .sensitivity import Sensitivity, sensitivity_of
from .state_equation import StateEquation
from .sim import Progress, Sim
from .state_space import Arrays, StateSpace
from .window import Window

__all__ = ["STRUCTS", "VERSION", "__version__", "Arrays", "Buckling", "Error", "Extremes", "Fatigue", "Model", "Modes",
           "Profile", "ProfileRecorder", "Progress", "Recorder", "Response", "Sensitivity", "Sim", "StateEquation",
           "StateSpace", "TorqueDrag", "Window", "output_name",
           "output_names", "output_of", "output_quantity", "output_text", "output_unit", "motor_drive",
           "operation_name", "sensitivity_of", "station", "status_name", "status_text", "usual_operation"]
__all__ += [name for name, value in vars(_structs).items() if name.endswith("_FN") or value in STRUCTS.values()]
__all__ += [name for name, value in vars(enums).items() if name.isupper() and isinstance(value, int)]
__all__ += [cls.__name__ for cls in ENUMS]
