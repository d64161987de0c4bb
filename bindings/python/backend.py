"""Builds the package for pip (PEP 517, PEP 660) with nothing but Python, so that it installs without network,
setuptools or wheel. In the source tree it builds the library and the binary of co-simulation units by CMake (preset
user, which repeats no work), and both go into the package, which then needs no other. The environment variable
DRILLMBD_BUNDLE names another libdrillmbd.so to be taken, or "none": the package then looks for an installed library, as
it does where the sources of the library or CMake are absent."""
import ast
import base64
import hashlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
KINDS = (".py", ".typed", ".json", ".toml", ".so", ".dylib", ".dll")


def project():
    """Sections of pyproject.toml as dicts, for tables, texts and lists of texts on one line, as this one has."""
    sections, section = {}, {}
    for line in (HERE / "pyproject.toml").read_text(encoding="utf-8").splitlines():
        if line.startswith("["):
            section = sections.setdefault(line.strip("[]"), {})
        elif "=" in line:
            name, value = line.split("=", 1)
            section[name.strip()] = ast.literal_eval(value.strip())
    return sections


def version():
    """The version that the headers gave the package."""
    text = (HERE / "drillmbd" / "enums.py").read_text(encoding="utf-8")
    return re.search(r'^__version__ = "([^"]+)"', text, re.M).group(1)


def built():
    """The library that CMake builds of the sources around this folder; None where they or CMake are absent."""
    root = HERE.parents[1]
    if not (root / "CMakePresets.json").is_file() or not shutil.which("cmake"):
        print("drillmbd: without a library of its own: CMake or the sources of the library are absent", file=sys.stderr)
        return None
    for command in (["cmake", "--preset", "user"],
                    ["cmake", "--build", "build/user", "--target", "drillmbd", "drillmbd_fmu", "--parallel",
                     str(os.cpu_count() or 1)]):
        done = subprocess.run(command, cwd=root, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            raise SystemExit(f"{done.stdout[-4000:]}\n{' '.join(command)} in {root} failed. DRILLMBD_BUNDLE=FILE takes "
                             "a library "
                             "that is built, DRILLMBD_BUNDLE=none an installed one")
    files = (root / "build" / "user" / name for name in ("libdrillmbd.so", "libdrillmbd.dylib", "drillmbd.dll"))
    return next(file for file in files if file.exists())


def named(name):
    """The library that DRILLMBD_BUNDLE names, from the folder of the call or of the project."""
    places = [pathlib.Path(os.environ.get("PWD", ".")), HERE.parents[1], pathlib.Path.cwd()]
    library = next((place / name for place in places if (place / name).is_file()), None)
    if library is None:
        raise SystemExit(f"DRILLMBD_BUNDLE = {name}, must be the file of a library that is built, or none; without it, "
                         "the "
                         "library is built")
    return library


def bundled():
    """The library that goes into the package, and the binary of units beside it: pairs of a name in the package and a
    file."""
    name = os.environ.get("DRILLMBD_BUNDLE")
    library = None if name == "none" else named(name) if name else built()
    if library is None:
        return []
    unit = library.with_name("drillmbd_fmu" + (".dll" if library.suffix == ".dll" else ".so"))
    kind = ".so" if ".so" in library.name else library.suffix
    found = [("libdrillmbd" + kind if kind != ".dll" else "drillmbd.dll", library)]
    return found + ([(unit.name, unit)] if unit.exists() else [])


def sources():
    """Pairs of a path in the wheel and a file."""
    files = [path for path in sorted((HERE / "drillmbd").rglob("*"))
             if path.is_file() and "__pycache__" not in path.parts and path.name.endswith(KINDS)]
    return [(path.relative_to(HERE).as_posix(), path) for path in files]


def metadata():
    """The text of METADATA."""
    about, extras = project()["project"], project()["project.optional-dependencies"]
    lines = ["Metadata-Version: 2.1", f"Name: {about['name']}", f"Version: {version()}",
             f"Summary: {about['description']}", f"Requires-Python: {about['requires-python']}"]
    for extra, needs in extras.items():
        lines += [f"Provides-Extra: {extra}", *(f'Requires-Dist: {one}; extra == "{extra}"' for one in needs)]
    return "\n".join(lines) + "\n"


def write_wheel(folder, contents, tag):
    """Writes (path, bytes) of contents with the wheel's own files; the same bytes from the same sources."""
    info = f"drillmbd-{version()}.dist-info"
    scripts = "".join(f"{name} = {target}\n" for name, target in project()["project.scripts"].items())
    pure = "true" if tag.endswith("any") else "false"
    contents = [*contents, (f"{info}/METADATA", metadata().encode()),
                (f"{info}/WHEEL",
                 f"Wheel-Version: 1.0\nGenerator: drillmbd\nRoot-Is-Purelib: {pure}\nTag: {tag}\n".encode()),
                (f"{info}/entry_points.txt", f"[console_scripts]\n{scripts}".encode())]
    record = ""
    for path, data in contents:
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{path},sha256={digest},{len(data)}\n"
    contents.append((f"{info}/RECORD", (record + f"{info}/RECORD,,\n").encode()))
    name = f"drillmbd-{version()}-{tag}.whl"
    with zipfile.ZipFile(pathlib.Path(folder, name), "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, data in contents:
            entry = zipfile.ZipInfo(path, (1980, 1, 1, 0, 0, 0))
            entry.external_attr, entry.compress_type = 0o644 << 16, zipfile.ZIP_DEFLATED
            wheel.writestr(entry, data)
    return name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """The package, with the library where there is one."""
    added = bundled()
    names = [f"drillmbd/{name}" for name, _ in added]
    files = [one for one in sources() if one[0] not in names] + list(zip(names, (path for _, path in added)))
    binary = any(not path.endswith((".py", ".typed", ".json", ".toml")) for path, _ in files)
    tag = "py3-none-" + (re.sub(r"[-.]", "_", sysconfig.get_platform()) if binary else "any")
    return write_wheel(wheel_directory, [(path, file.read_bytes()) for path, file in files], tag)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """The path to the sources, which stay where they are; the library is found as where it is installed."""
    return write_wheel(wheel_directory, [("drillmbd.pth", f"{HERE}\n".encode())], "py3-none-any")


def build_sdist(sdist_directory, config_settings=None):
    """The sources."""
    base = f"drillmbd-{version()}"
    contents = [(path, file.read_bytes()) for path, file in sources()]
    contents += [(name, (HERE / name).read_bytes()) for name in ("backend.py", "pyproject.toml")]
    contents.append(("PKG-INFO", metadata().encode()))
    with tarfile.open(pathlib.Path(sdist_directory, f"{base}.tar.gz"), "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for path, data in contents:
            entry = tarfile.TarInfo(f"{base}/{path}")
            entry.size, entry.mode = len(data), 0o644
            archive.addfile(entry, io.BytesIO(data))
    return f"{base}.tar.gz"
