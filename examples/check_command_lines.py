"""Checks what programs do with --help, with nonsense, and with a folder they cannot write.

usage: check_command_lines.py PROGRAM...   (those of the examples)

--help of programs with options tells every one and ends well; every other call here is refused: exit status above 0, a
message on standard error that names what was wrong, nothing on standard output.
"""
import pathlib
import subprocess
import sys
import tempfile

# Programs that are not named here have no options.
OPTIONS = {
    "gas_drainage_rig": ["--system", "--couple", "--pipes", "--length", "--elements", "--step", "--time", "--drop",
                         "--quick", "--output", "--rate", "--quiet", "--bit", "--seed", "--threads"],
    "reference_study": ["--output", "--threads", "--step", "--short"],
    "safe_speeds": ["--output", "--threads", "--depth", "--order"],
    "turning_string": ["--threads"],
    "two_cores": ["--threads"],
    "control_loop": ["--seconds", "--jam", "--pipes", "--real-time"],
    "failure_probability": ["--samples", "--threads", "--seed"],
}
NONSENSE = {
    "gas_drainage_rig": [["--pipes", "0"], ["--pipes", "2.5"], ["--pipes", "many"], ["--length", "-1"],
                         ["--length", "nan"], ["--step", "0"], ["--step", "1e-3s"], ["--time", "inf"],
                         ["--system", "wooden"], ["--couple", "x"], ["--elements", "0"], ["--bit", "95"],
                         ["--rate", "0"], ["--seed", "-1"], ["--threads", "0"], ["--threads", "65"]],
    "reference_study": [["--threads", "0"], ["--threads", "-2"], ["--threads", "2x"], ["--threads", "65"],
                        ["--threads", "99999999999999999999"], ["--step", "0"], ["--step", "1"], ["--step", "nan"]],
    "safe_speeds": [["--threads", "0"], ["--threads", "two"], ["--depth", "0"], ["--depth", "-5"],
                    ["--depth", "5000"], ["--order", "0"], ["--order", "21"], ["--order", "2x"], ["--order", "nan"],
                    ["--order"]],
    "turning_string": [["--threads", "0"], ["--threads", "-2"], ["--threads", "2x"], ["--threads", "65"],
                       ["--threads", "99999999999999999999"], ["--threads"], ["--threads", ""], ["--bogus", "7"],
                       ["--threads", "2", "more"]],
    "two_cores": [["--threads", "0"], ["--threads", "65"], ["--threads", "1.5"], ["--threads"]],
    "control_loop": [["--seconds", "0"], ["--seconds", "3601"], ["--seconds", "nan"], ["--jam", "-1"], ["--jam", "6s"],
                     ["--pipes", "1"], ["--pipes", "401"], ["--pipes", "2.5"], ["--seconds"], ["--real-time", "7"]],
    "failure_probability": [["--samples", "0"], ["--samples", "2.5"], ["--threads=x"], ["--seed", "-1"], ["--seed"]],
}
COMMON = [["--nonsense"], ["nonsense"], ["--output"]]


def call(program, arguments, folder):
    return subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, timeout=60,
                          stdin=subprocess.DEVNULL, check=False)


def failures_of(program, folder):
    name = pathlib.Path(program).name
    found = []
    options = OPTIONS.get(name, [])
    for word in ("--help", "-h"):
        run = call(program, [word], folder)
        if run.returncode != 0 or run.stderr or not run.stdout.startswith("Usage: " + name) or any(
                option not in run.stdout for option in options):
            found.append(f"{name} {word} does not tell all options:\n{run.stdout}{run.stderr}")
    (folder / "file").write_text("no folder\n", encoding="utf-8")
    unwritable = [["--output", path] for path in ("file", "file/below", "/proc/no/such/place", "x" * 5000, "")]
    for arguments in NONSENSE.get(name, [["7"], [""]]) + COMMON + unwritable:
        run = call(program, arguments, folder)
        unknown = [word for word in arguments if word.startswith("--") and word.split("=")[0] not in options]
        wrong = (unknown or (arguments[-1:] if options else arguments))[0].split("=")[-1][:60]
        if run.returncode <= 0 or run.stdout or not run.stderr.strip() or wrong.lstrip("-") not in run.stderr:
            found.append(f"{name} {' '.join(arguments)[:100]}: exit status {run.returncode}, says {run.stderr!r}")
    return found


def main():
    found = []
    for program in sys.argv[1:]:
        with tempfile.TemporaryDirectory() as folder:
            found += failures_of(program, pathlib.Path(folder))
    print("\n".join(found))
    return 1 if found else 0


sys.exit(main())
