"""The command `drillmbd`, also `python3 -m drillmbd`: runs one analysis of a scene file and writes the results."""
from __future__ import annotations

import argparse
import importlib
import math
import os
import re
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any

from . import __version__, exit_status
from .errors import Usage
from .language_choice import NAMES as LANGUAGES
from .unit_choice import NAMES

EXAMPLES = """examples:
  drillmbd check rig.toml                     describes the scene and warns of doubtful values
  drillmbd run rig.toml --output out          runs the scene; table, pictures and files for ParaView
  drillmbd run rig.toml --until "5 s" --step "2 ms"
  drillmbd run rig.toml --output out          again after Ctrl-C: continues where it was stopped
  drillmbd static rig.toml --output out       static equilibrium: shape, forces, contact with the wall
  drillmbd modes rig.toml                     natural frequencies
  drillmbd response rig.toml --output out     linear forced response, by [response]
  drillmbd torque-drag rig.toml --weight-on-bit "15 kN" -o out   hook load and torque by depth and operation
  drillmbd torque-drag rig.toml --units field -o out   in ft, lbf, ft-lbf, psi; or --units mine; or [results] units
  drillmbd torque-drag rig.toml --measured log.csv -o out   the friction that explains measured hook loads
  drillmbd rod-by-rod rig.toml --make-up "2 kN m" -o out   thrust, torque and make-up torque for each number of rods
  drillmbd speeds rig.toml                    rotary speeds to avoid, by [speeds]
  drillmbd buckle rig.toml                    critical factors by [buckling], thrusts that buckle the string
  drillmbd report rig.toml --output out       one page for crew and engineer: out/report.html
  drillmbd stuck rig.toml --overpull "20 kN" --stretch "45 mm"   pull and torque at a stuck bit; free point
  drillmbd sweep rig.toml static --vary hole.diameter="90 mm,94 mm,98 mm" -o out
  drillmbd probability rig.toml -o out --samples 1000 --engine processes   how often does it fail, by [variability], [[failure]]?
  drillmbd fmu rig.toml -o rig.fmu            a unit for co-simulation (FMI 3.0) with other programs
  drillmbd live rig.toml -o rig.html          one page that runs the scene in a browser, with sliders and traces
  drillmbd save rig.toml copy.toml            the scene with all defaults written out, its units and comments kept
  drillmbd new drainage --length "200 m" --dip "5 deg" --rod "73 mm" -o hole.toml   a commented scene to start from
  drillmbd keys string.pipes                  keys with unit, default and meaning
  drillmbd catalogue "5 in"                   drill pipe, rods, collars and rigs that scene files name
  drillmbd schema > scene.schema.json         for editors that check TOML

exit status, of each command:
""" + exit_status.text() + """

frames, angles and signs: azimuth is clockwise from north, inclination from the downward vertical, dip from the horizontal, up positive;
thrust and compression are negative hook loads and axial forces. All with a drawing: examples/conventions/README.md

completion in the shell, by python3-argcomplete: eval "$(register-python-argcomplete drillmbd)"
"""  # noqa: E501

FMU = """examples:
  drillmbd fmu rig.toml -o rig.fmu                for importers of FMI 3.0
  drillmbd fmu rig.toml -o rig.fmu --version 2    for those of FMI 2.0
  drillmbd fmu rig.toml -o rig.fmu --sources      with its source code, for other machines

[[input]] of the scene become inputs and tunable parameters of the unit, [[output]] its outputs, [[event]] counts and, where the importer
allows it, early returns. [run] static and [run] step hold in the unit too. It holds the library and needs no Python; liblapacke must
be installed where it runs."""  # noqa: E501

LIVE = """examples:
  drillmbd live hole.toml -o hole.html                 opens in any browser, without a network
  drillmbd live hole.toml --replay hole_12.500s.json   the run that a reader of the page saved: same inputs, same hash?

The page holds the scene, the library and the view: the string in its hole, sliders for rotation, feed, load of the bit, friction, stuck places,
diameter of the hole and all [[input]] of the scene, traces of torque, thrust, bit speed and contact with [limits]. [run] static and [run] step
hold there too, so that it computes the same run as drillmbd run. It needs the package of JavaScript: bindings/web/build."""  # noqa: E501

PROBABILITY = """examples:
  drillmbd probability rig.toml -o out --samples 1000                     on all processors
  drillmbd probability rig.toml -o out --samples 1000                     again: continues, or adds samples
  drillmbd probability rig.toml -o out --question torque-drag --samples 100000   as a soft string: thousands of samples a second
  drillmbd probability rig.toml -o out --question auto --samples 10000    runs in time only where torque and drag do not decide
  drillmbd probability rig.toml -o out --vary "time_function[rotation].segment.h1=60 rpm,100 rpm,130 rpm" --vary "time_function[feed].segment.h1=8 mm/s,12 mm/s"   a map
  drillmbd probability rig.toml -o out --until 30%                         as many samples as that needs
  drillmbd probability rig.toml -o out --method subset --failure stress   a rare failure
  drillmbd probability rig.toml -o out --indices 64                       which parameter matters most: Sobol' indices
  mpirun -n 9 drillmbd probability rig.toml -o out --engine mpi
  drillmbd probability rig.toml -o out --engine dask --address tcp://10.0.0.1:8786

All samples are kept in out/study.h5, which can be read while it grows (drillmbd.probability.study.read_rows). It is refused where
scene, code or settings are others than those it was made with."""  # noqa: E501
STUCK = {"pull": "of the rig, instead of [limits] pull", "push": "of the rig, instead of [limits] push",
         "torque": "of the rig, instead of [limits] torque",
         "overpull": "pulled beyond the weight to see how far it is free",
         "stretch": "by which the rig end came up then"}
SWEEP = """example:
  drillmbd sweep rig.toml torque-drag --vary hole.mu_dynamic=0.1:0.4:7 --vary "string[0].pipes[0].outer_diameter=63.5 mm,73 mm" \
      -o out -- --weight-on-bit "10 kN"

Options after -- belong to the command that is repeated. A key that does not exist is refused before the first case.
A case that fails is a row with its message; the exit status is 1 then.
After Ctrl-C the same line continues: cases that are complete in the folder are not computed again."""  # noqa: E501


def parser() -> argparse.ArgumentParser:
    """The command line."""
    found = argparse.ArgumentParser(prog="drillmbd",
                                    description="Multibody dynamics of drill strings from scene files.",
                                    epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter)
    found.add_argument("--version", action="version", version=f"drillmbd {__version__}")
    commands = found.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, text in (("check", "describes the scene and warns of doubtful values"),
                       ("static", "computes the static equilibrium"), ("run", "runs the scene in time"),
                       ("modes", "computes natural frequencies about the static equilibrium"),
                       ("response", "computes the linear response to excitations about the static equilibrium"),
                       ("speeds", "computes rotary speeds to avoid"),
                       ("buckle", "computes critical factors, and thrusts at which the string buckles"),
                       ("torque-drag",
                        "computes hook load and torque by depth as a soft string, reach of the rig, friction from "
                        "measurements"),
                       ("rod-by-rod",
                        "computes thrust, pull, torque and make-up torque for each number of rods in the hole"),
                       ("stuck",
                        "computes pull, push and torque that arrive at a stuck bit, and the free point by stretch"),
                       ("report", "writes one HTML page with all results; needs plotly")):
        command = commands.add_parser(name, help=text, description=text)
        command.add_argument("scene", help="a scene file (TOML)")
        command.add_argument("--output", "-o", metavar="FOLDER",
                             help="where tables, pictures and summary.json are written")
        command.add_argument("--quiet", "-q", action="store_true", help="no progress, no summary on the terminal")
        command.add_argument("--units", choices=NAMES,
                             help="of texts, tables and pictures, instead of [results] units: SI (default), field "
                                  "units "
                             "(ft, lbf, psi) or mine units (m, kN, MPa); summary.json and files for ParaView stay "
                             "in SI")
        if name == "run":
            command.add_argument("--until", metavar="TIME", help='ends there, as "5 s", instead of [run] end')
            command.add_argument("--step", metavar="TIME", help='length of a step, as "1 ms", instead of [run] step')
            command.add_argument("--verify", action="store_true",
                                 help="runs the last tenth again with half the step and compares all outputs")
        if name == "stuck":
            for word, unit in (("pull", "kN"), ("push", "kN"), ("torque", "N m"), ("overpull", "kN"),
                               ("stretch", "mm")):
                command.add_argument(f"--{word}", metavar=word.upper(), help=STUCK[word] + f', as "20 {unit}"')
            command.add_argument("--friction", type=float, metavar="MU",
                                 help="coefficient, instead of that of the wall")
        if name == "torque-drag":
            command.add_argument("--depths", metavar="N|LIST", default="20",
                                 help='number of depths up to the described one '
                                 '(default %(default)s), or depths as "100 m,200 m"')
        if name == "rod-by-rod":
            command.add_argument("--make-up", metavar="TORQUE",
                                 help='of the joints of the rods, as "2 kN m"; left out: not assessed')
        if name in ("torque-drag", "rod-by-rod"):
            command.add_argument("--weight-on-bit", metavar="FORCE",
                                 help='while drilling and sliding, as "20 kN"; left out: that of the scene')
            command.add_argument("--torque-on-bit", metavar="TORQUE",
                                 help='while drilling, as "500 N m"; left out: estimated from the load')
            command.add_argument("--block-weight", metavar="FORCE",
                                 help='of block and top drive, added to the hook loads')
            command.add_argument("--friction", type=float, metavar="MU",
                                 help="coefficient, instead of that of the wall")
        if name == "torque-drag":
            command.add_argument("--frictions", metavar="LIST",
                                 help="coefficients of the broomstick picture, as 0.2,0.3,0.4")
            command.add_argument("--measured", metavar="FILE",
                                 help="table of depth, pick_up, slack_off, rotate, torque: drawn, friction fitted")
        if name == "report":
            command.add_argument("--language", choices=LANGUAGES, default="en",
                                 help="of the page and of the lines on the terminal: English "
                                 "(default) or Chinese; summary.json stays English")
            command.add_argument("--probability", metavar="FOLDER",
                                 help="--output of a study of this scene by drillmbd probability: its "
                                 "estimates become part of the page")
            command.add_argument("--live", action="store_true",
                                 help="the page runs the scene too, as that of drillmbd live does: with sliders and "
                                 "traces; needs the library as WebAssembly, which bindings/web/build makes")
        if name == "speeds":
            command.add_argument("--check", nargs="?", type=int, const=12, default=0, metavar="N",
                                 help="runs N rotary speeds (12 where no number "
                                 "is given) in time too and marks those where the torque oscillates or the lateral "
                                 "acceleration is large")
        if name == "modes":
            command.add_argument("--count", type=int, metavar="N", help="number of modes, instead of [modes] count")
    sweep = commands.add_parser("sweep", help="repeats a command for all combinations of some values", epilog=SWEEP,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    sweep.add_argument("scene", help="a scene file (TOML)")
    repeated = ["check", "static", "run", "modes", "response", "speeds", "buckle", "torque-drag", "rod-by-rod", "stuck",
                "report", "probability"]
    sweep.add_argument("repeated_command", metavar="COMMAND", choices=repeated,
                       help=f"that is repeated: {', '.join(repeated)}")
    sweep.add_argument("--vary", action="append", required=True, metavar="KEY=VALUES", help="KEY=V1,V2,... or "
                       "KEY=LOW:HIGH:COUNT; once for each key; keys between & change together: A & B=V1,V2 or A & B=V1 "
                       "& W1,V2 & W2")
    sweep.add_argument("--output", "-o", metavar="FOLDER", help="sweep.csv, and a folder for each case")
    sweep.add_argument("--quiet", "-q", action="store_true")
    _add_probability(commands)
    _add_fmu(commands)
    _add_live(commands)
    save = commands.add_parser("save",
                               help="writes the scene with all values that decide the result, comments and units kept")
    save.add_argument("scene")
    save.add_argument("target",
                      help="the new file; - for the terminal; NAME.scene: a scene record for dmb_model_read, NAME.h: "
                           "the same as an array of C")
    commands.add_parser("schema", help="prints the JSON schema of scene files")
    keys = commands.add_parser("keys", help="lists the keys of scene files with unit, default and meaning")
    keys.add_argument("table", nargs="?", help="a table, as string.pipes; left out: the usual keys of all")
    listed = commands.add_parser("catalogue",
                                 help="lists drill pipe, rods, collars and rigs that scene files name, with sources")
    listed.add_argument("word", nargs="?", help="of the names or sources; left out: all")
    listed.add_argument("--file", action="append", default=[], metavar="FILE",
                        help="a catalogue of your own too; once for each")
    _add_new(commands)
    return found


def _add_new(commands: Any) -> None:
    from .new_options import OPTIONS
    text = "writes a commented scene from a few values"
    made = commands.add_parser("new", help=text, description=text)
    made.add_argument("kind", choices=list(OPTIONS))
    made.add_argument("--output", "-o", metavar="FILE",
                      help="the scene file, which must not exist yet; left out: the terminal")
    for name, (_, _, about) in OPTIONS["drainage"].items():
        defaults = ", ".join(f"{values[name][1]} ({kind})" for kind, values in OPTIONS.items())
        made.add_argument(f"--{name.replace('_', '-')}", metavar="VALUE", help=f"{about}; default {defaults}")
    made.add_argument("--rods", metavar="NAME",
                      help='of a catalogue or a size, as "phi 73 x 6.5" or "5 in 19.50 S135", instead of --rod and '
                           '--bore; '
                      "an outer diameter alone as of --rod")
    made.add_argument("--survey", metavar="FILE",
                      help="of the hole, instead of --dip and --length: CSV, text with blanks, LAS 2.0, Excel")
    made.add_argument("--rig", metavar="NAME", help="of a catalogue, for [limits]: drillmbd catalogue")


def _new(options: Any) -> int:
    from .new_options import OPTIONS
    from .scene import new
    try:
        given = {name: getattr(options, name) for name in (*OPTIONS[options.kind], "rods", "rig", "survey")
                 if getattr(options, name)}
        text = new.text(options.kind, given, os.path.dirname(options.output or "") or ".")
    except ValueError as error:
        raise Usage(str(error)) from None
    if options.output is None:
        print(text, end="")
    else:
        with open(options.output, "x", encoding="utf-8") as file:
            file.write(text)
    return 0


def _keys(table: str | None) -> int:
    from .scene import keys
    try:
        print(keys.text(table), end="")
    except ValueError as error:
        raise Usage(str(error)) from None
    return 0


def _catalogue(options: Any) -> int:
    from .scene import catalogue
    try:
        print(catalogue.text(options.word, options.file), end="")
    except catalogue.CatalogueError as error:
        raise Usage(str(error)) from None
    return 0


def _add_fmu(commands: Any) -> None:
    text = "writes the scene as a unit for co-simulation by the standard FMI"
    command = commands.add_parser("fmu", help=text, description=text, epilog=FMU,
                                  formatter_class=argparse.RawDescriptionHelpFormatter)
    command.add_argument("scene", help="a scene file (TOML) with [[output]], and [[input]] to be steered by")
    command.add_argument("--output", "-o", metavar="FILE", help="the unit; left out: the name of the scene with .fmu")
    command.add_argument("--version", type=int, choices=[2, 3], default=3, dest="fmi",
                         help="of FMI (default %(default)s)")
    command.add_argument("--sources", nargs="?", const=True, default=False, metavar="FOLDER",
                         help="the source code too; FOLDER: that of "
                         "libdrillmbd's sources, where this package does not stand in it")
    command.add_argument("--quiet", "-q", action="store_true", help="no notes on the terminal")


def _add_live(commands: Any) -> None:
    text = "writes one HTML page that runs the scene in a browser, or computes the run that such a page saved"
    command = commands.add_parser("live", help=text, description=text, epilog=LIVE,
                                  formatter_class=argparse.RawDescriptionHelpFormatter)
    command.add_argument("scene", help="a scene file (TOML)")
    command.add_argument("--output", "-o", metavar="FILE", help="the page; left out: the name of the scene with .html")
    command.add_argument("--language", choices=LANGUAGES, default="en",
                         help="of the page: English (default) or Chinese; titles, comments and names of "
                         "the scene file stay as they are")
    command.add_argument("--replay", metavar="LOG",
                         help="a log that the page saved: computes its run and compares the hash of the state")
    command.add_argument("--quiet", "-q", action="store_true", help="no notes on the terminal")


def _add_probability(commands: Any) -> None:
    text = "estimates the probability of each [[failure]] of the scene over its [variability]"
    command = commands.add_parser("probability", help=text, description=text, epilog=PROBABILITY,
                                  formatter_class=argparse.RawDescriptionHelpFormatter)
    command.add_argument("scene", help="a scene file (TOML) with [variability] and [[failure]]")
    command.add_argument("--output", "-o", metavar="FOLDER", help="study.h5, samples.csv, summary.json")
    command.add_argument("--quiet", "-q", action="store_true", help="no progress, no summary on the terminal")
    command.add_argument("--question", choices=["torque-drag", "static", "run", "auto"],
                         help="analysis of each sample, instead of [variability] question: "
                         "soft string, static states, run in time; auto: runs only where torque and drag do not decide")
    command.add_argument("--vary", action="append", default=[], metavar="KEY=VALUES",
                         help="a map of the probability over KEY=V1,V2,... or "
                         "KEY=LOW:HIGH:COUNT, with the same random numbers everywhere; once for each key; keys between "
                         "& change together: A & B=V1,V2 or A & B=V1 & W1,V2 & W2")
    command.add_argument("--until", metavar="RULE",
                         help='adds samples up to --samples until half of the interval is "30%%" of the probability, '
                         'or it is "below 1e-2" or above')
    command.add_argument("--samples", type=int, metavar="N",
                         help="instead of [variability] samples; of a subset simulation: in a level")
    command.add_argument("--method", choices=["monte-carlo", "latin-hypercube", "sobol", "subset"],
                         help="instead of [variability] method")
    command.add_argument("--seed", type=int, metavar="N", help="instead of [variability] seed")
    command.add_argument("--failure", metavar="NAME",
                         help="which failure subset and indices are about; left out: any, by margin over limit")
    command.add_argument("--indices", type=int, metavar="N",
                         help="Sobol' indices of N rows, N (2 + number of uncertain parameters) samples")
    command.add_argument("--surrogate", action="store_true", help="also by a polynomial that is fitted to the samples")
    command.add_argument("--salvage", action="store_true",
                         help="keeps the sound rows of a study.h5 that is damaged and computes the others again")
    command.add_argument("--engine", choices=["serial", "threads", "processes", "mpi", "dask"], default="processes",
                         help="where samples are computed; the numbers are the same (default %(default)s)")
    command.add_argument("--workers", type=int, metavar="N", help="left out: number of processors")
    command.add_argument("--address", metavar="HOST:PORT",
                         help="of the scheduler of a Dask cluster; left out: one on this machine")
    command.add_argument("--own", action="append", default=[], metavar="NAME=FILE.py:FUNCTION",
                         help="the function of a failure of the "
                         "kind own: function(look) -> margin; once for each")


def _complete(command_line: argparse.ArgumentParser) -> None:
    """Completes the line for a shell, and ends."""
    try:
        argcomplete: Any = importlib.import_module("argcomplete")
    except ImportError:
        return
    argcomplete.autocomplete(command_line)


def _joined(words: list[str]) -> list[str]:
    """--dip -5deg as --dip=-5deg: a value below 0 is no option."""
    found: list[str] = []
    for word in words:
        if found and re.fullmatch(r"--[a-z-]+", found[-1]) and re.match(r"-\.?\d", word):
            found[-1] += "=" + word
        else:
            found.append(word)
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command; returns the exit status."""
    command_line = parser()
    _complete(command_line)
    words = _joined(list(sys.argv[1:] if arguments is None else arguments))
    cut = words.index("--") if words[:1] == ["sweep"] and "--" in words else len(words)
    options = command_line.parse_args(words[:cut])
    if "" in (getattr(options, "output", None), getattr(options, "scene", None)):
        return _fail(2,
                     "drillmbd: the name of a file or folder is empty; give --output or the scene file, or leave "
                     "--output out")
    options.more = words[cut + 1:]  # options of the command that a sweep repeats
    try:
        from ._progress import INTERRUPTS
        INTERRUPTS.install()
        status = _guarded(lambda: _carry_out(options))
        sys.stdout.flush()
        return status
    except BrokenPipeError:  # nobody reads on, as behind "| head"; what is left goes nowhere, at the end of Python too
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 3


def program() -> None:
    """The command as a program, which ends here with its exit status."""
    status = main()
    # Python would end by the signal itself if Ctrl-C came within an exec, as of a dataclass, and HDF5 that could not
    # write its file crashes at exit
    if status in (exit_status.STOPPED, exit_status.FILE):
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    sys.exit(status)


def _guarded(action: Callable[[], int]) -> int:
    try:
        return action()
    except (Exception, KeyboardInterrupt) as error:
        found = exit_status.status_and_message(error)
        if found is None:
            raise
        return _fail(*found)


def _fail(status: int, text: str) -> int:
    print(text, file=sys.stderr)
    return status


def _sweep(options: Any) -> int:
    if options.repeated_command == "probability":
        raise Usage("sweep does not repeat probability, which has a map of its own with the same random numbers "
                    "everywhere: "
                    f"drillmbd probability {options.scene} " + " ".join(f"--vary {text!r}" for text in options.vary))
    from . import scene
    from .sweep import MOST_CASES, keys_of, refuse_wrong_keys, sweep, varied
    try:
        vary = [varied(text) for text in options.vary]
        refuse_wrong_keys([one for key, _ in vary for one in keys_of(key)], options.scene)
    except ValueError as error:
        raise Usage(f"--vary {error}") from None
    cases = math.prod(len(values) for _, values in vary)
    if cases > MOST_CASES:
        raise Usage(f"--vary asks for {cases} cases, must be <= {MOST_CASES}")
    repeated = parser().parse_args([options.repeated_command, options.scene, *options.more])
    if options.repeated_command == "report" and options.output is None:
        raise Usage("sweep of report needs --output FOLDER, which holds a page for each case")
    return sweep(options.repeated_command, vary, lambda overrides: scene.load(options.scene, overrides), options.scene,
                 repeated, options.output, options.quiet, options.more)


def _fmu(options: Any) -> int:
    from . import fmu, scene
    from .scene.warned import warnings_of
    target = options.output or os.path.splitext(options.scene)[0] + ".fmu"
    if os.path.isdir(target):
        raise Usage(f"--output {target}: is a folder, must be the file of the unit")
    loaded = scene.load(options.scene)
    notes = fmu.export(loaded, target, options.fmi, options.sources)
    if not options.quiet:
        for note in [*warnings_of(loaded), *notes]:
            print(f"note: {note}")
        print(f"{target}: FMI {options.fmi}.0, {len(loaded.model.inputs())} inputs and parameters, "
              f"{len(loaded.outputs)} outputs, "
              f"{len(loaded.model.events())} events, {os.path.getsize(target) / 1e6:.1f} MB")
    return 0


def _live(options: Any) -> int:
    from . import live, scene
    from .language import Language
    from .scene.warned import warnings_of
    loaded = scene.load(options.scene)
    if options.replay:
        found, wanted, end = live.replay(loaded, options.replay)
        same = found == wanted
        if not options.quiet or not same:
            print(f"{options.replay}: {end:g} s, hash {found}, "
                  + ("as in the browser" if same else f"but {wanted} in the browser: another version of the library "
                     "or of the scene file"))
        return 0 if same else exit_status.FAILED
    target = options.output or os.path.splitext(options.scene)[0] + ".html"
    if os.path.isdir(target):
        raise Usage(f"--output {target}: is a folder, must be the file of the page")
    size = live.write(loaded, options.scene, target, Language(options.language))
    if not options.quiet:
        for note in warnings_of(loaded):
            print(f"note: {note}")
        print(f"{target}: {size / 1e6:.1f} MB, opens in a browser")
    return 0


LEAST = {"response": """[[response.excitation]]
kind = "eccentricity"          # excitation: eccentric pipes; or "drive", "load", "force" with a place
[[response.output]]
quantity = "vibration-z"
place = {place}
""", "speeds": """[speeds]
[[speeds.order]]               # eccentric pipes excite once a revolution
[[speeds.output]]
quantity = "vibration-z"
place = {place}
limit = "1 mm"                 # the amplitude that may be
""", "buckling": """[buckling]
scale = "all"                  # weight and all loads grow; or "part" with the load or load drive that does
"""}


def least(name: str, scene: Any) -> str:
    """The lines that a scene file needs for an analysis, at the least, about the middle of its first string."""
    string, pipes = next(iter(scene.pipes.items()), ("name", 1))
    return LEAST[name].replace("{place}", f'{{part = "{string}", pipe = {pipes // 2}, fraction = 0.5}}')


def _carry_out(options: Any) -> int:
    from . import scene
    from .results import CommandOutput, units_of
    from .language import Language
    from .commands import COMMANDS
    from .runner import carry_out
    from .scene.warned import warnings_of
    started = time.perf_counter()
    if options.command == "schema":
        from .scene.schema import text
        print(text(), end="")
        return 0
    if options.command == "keys":
        return _keys(options.table)
    if options.command == "catalogue":
        return _catalogue(options)
    if options.command == "new":
        return _new(options)
    if options.command == "save":
        loaded = scene.load(options.scene)
        if options.target.endswith((".scene", ".h")):
            scene.save_record(loaded, options.target)
            return 0
        saved = scene.saves(loaded)
        for warning in warnings_of(loaded):
            print(f"note: {warning}", file=sys.stderr)
        if options.target == "-":
            print(saved, end="")
        else:
            with open(options.target, "w", encoding="utf-8") as file:
                file.write(saved)
        return 0
    if options.command == "sweep":
        return _sweep(options)
    if options.command == "fmu":
        return _fmu(options)
    if options.command == "live":
        return _live(options)
    if options.command == "probability":
        from .probability.command import probability
        options.started = started
        return probability(options)
    needed = {"response": "response", "speeds": "speeds", "buckle": "buckling"}.get(options.command)
    loaded = scene.load(options.scene)
    if needed and needed not in loaded.analyses:
        raise Usage(f"{options.scene} has no [{needed}], which {options.command} needs, for example:\n\n"
                    + least(needed, loaded))
    if getattr(options, "probability",
               None) and options.output and os.path.realpath(options.probability) == os.path.realpath(options.output):
        raise Usage(f"--probability {options.probability}: is the --output folder too, whose files would be replaced; "
                    "give another --output")
    out = CommandOutput(options.output, options.scene, loaded, options.command, options.quiet,
                        units_of(options, loaded),
                    Language(getattr(options, "language", "en")))
    out.started = started
    return carry_out(loaded, out, options, COMMANDS[options.command])


if __name__ == "__main__":
    sys.exit(main())
