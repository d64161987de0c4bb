"""Runs an example and compares what it prints with the stored output.

usage: compare_output.py PROGRAM EXPECTED

Both texts are compared word by word. Lines of the stored output that begin with # are not compared; three of them
mean something:
    # arguments: --pipes 5 --time 0.2     what the program is called with
    # tolerance: 1e-6                     relative tolerance of the numbers with a point or exponent from here on
                                          (1e-9 without such a line)
    # again: --threads 1                  the program is called once more with these arguments behind the others, and
                                          has to print the same and leave the same files behind, to the byte
A word of the stored output may carry its own tolerance: 0.125~1e-4 is absolute, 0.125~2% relative, and * stands for any
word. Whole numbers and all other words must be the same. The program runs in an empty folder of its own.
"""
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")


def stored_output(path):
    arguments, again, lines, tolerance = [], None, [], 1e-9
    with open(path, encoding="utf-8") as text:
        for line in text:
            line = line.rstrip("\n")
            if line.startswith("# arguments:"):
                arguments = shlex.split(line.split(":", 1)[1])
            elif line.startswith("# again:"):
                again = arguments + shlex.split(line.split(":", 1)[1])
            elif line.startswith("# tolerance:"):
                tolerance = float(line.split(":", 1)[1])
            elif not line.startswith("#") and line.strip():
                lines.append((line.split(), tolerance))
    return arguments, again, lines


def same_word(expected, found, tolerance):
    if expected == "*" or expected == found:
        return True
    value, mark, own = expected.partition("~")
    value, found = value.rstrip(",;:"), found.rstrip(",;:")
    if not NUMBER.match(value) or not NUMBER.match(found):
        return False
    if not mark:
        if not re.search(r"[.eE]", value):
            return False
        own = f"{100 * tolerance}%"
    own = own.rstrip(",;:")
    bound = abs(float(value)) * float(own[:-1]) / 100 if own.endswith("%") else float(own)
    return abs(float(found) - float(value)) <= bound


def call(program, arguments):
    """Its output and its files: content of each file by its path."""
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True,
                             stdin=subprocess.DEVNULL, check=False)
        places = sorted(pathlib.Path(folder).rglob("*"))
        return run, {str(place.relative_to(folder)): place.read_bytes() for place in places if place.is_file()}


def differences(once_more, run, files, arguments):
    found = [] if once_more[0].stdout == run.stdout else ["what it prints"]
    found += [name for name in sorted(files.keys() | once_more[1].keys()) if files.get(name) != once_more[1].get(name)]
    for name in found:
        print(f"called with {arguments} it is another: {name}")
    return len(found)


def main():
    program, path = sys.argv[1:3]
    arguments, again, expected = stored_output(path)
    run, files = call(program, arguments)
    found = [line.split() for line in run.stdout.splitlines() if line.strip()]
    if run.returncode != 0:
        print(run.stdout, run.stderr, f"exit status {run.returncode}", sep="\n")
        return 1
    failures = 0
    for number, ((words, tolerance), line) in enumerate(zip(expected, found), 1):
        if len(words) != len(line) or not all(same_word(e, f, tolerance) for e, f in zip(words, line)):
            print(f"line {number}\n  expected {' '.join(words)}\n  found    {' '.join(line)}")
            failures += 1
    if len(expected) != len(found):
        print(f"{len(found)} lines instead of {len(expected)}")
        failures += 1
    if again is not None:
        failures += differences(call(program, again), run, files, shlex.join(again))
    if failures:
        print("---- whole output ----", run.stdout, sep="\n")
    return 1 if failures else 0


sys.exit(main())
