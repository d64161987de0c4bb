"""Installs the package. With the environment variable DRILLMBD_BUNDLE naming a libdrillmbd.so, that file is copied into
the package, which then needs no other."""
import os
import pathlib
import shutil

from setuptools import setup
from setuptools.command.build_py import build_py


class BuildWithLibrary(build_py):
    """Copies the library beside the modules, where it was asked for."""

    def run(self):
        super().run()
        library = os.environ.get("DRILLMBD_BUNDLE")
        if library:
            target = pathlib.Path(self.build_lib, "drillmbd")
            target.mkdir(parents=True, exist_ok=True)
            shutil.copy(os.path.realpath(library), target / "libdrillmbd.so")
            unit = pathlib.Path(library).with_name("drillmbd_fmu.so")  # of co-simulation units
            if unit.exists():
                shutil.copy(unit, target / unit.name)


setup(cmdclass={"build_py": BuildWithLibrary})
