#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""wheel.py LIBRARY FOLDER: writes FOLDER/nmtan-VERSION-....whl, the package with the shared library.
wheel.py --sdist AMALGAMATION FOLDER: writes FOLDER/nmtan-VERSION.tar.gz, which builds that library of one C file.

From the top folder. A wheel is a zip with three files of metadata (PEP 427); in a source distribution this file is the
backend that pip calls (PEP 517). The same input gives the same bytes.
"""

import base64
import glob
import gzip
import hashlib
import io
import os
import platform
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
PYPROJECT = '[build-system]\nrequires = []\nbuild-backend = "wheel"\nbackend-path = ["."]\n'


def read(path):
    with open(path, "rb") as file:
        return file.read()


def version_of(header):
    return re.search(rb'NMTAN_VERSION_STRING "(.*)"', read(header))[1].decode()


def metadata(version):
    return f"""Metadata-Version: 2.1
Name: nmtan
Version: {version}
Summary: Tangents for normal-mapped meshes: MikkTSpace to the byte, in NumPy arrays
License: MIT
Requires-Python: >=3.9
Requires-Dist: numpy
""".encode()


def package():
    return {f"nmtan/{os.path.basename(path)}": read(path)
            for path in sorted(glob.glob(os.path.join(HERE, "nmtan", "*.py")) + [os.path.join(HERE, "nmtan", "py.typed")])}


def platform_tag(library):
    """manylinux by the newest symbol of glibc that the library asks for: an older system does not load it."""
    newest = max((int(minor) for minor in re.findall(rb"GLIBC_2\.(\d+)", library)), default=None)
    if newest is None:
        return re.sub(r"[-.]", "_", sysconfig.get_platform())
    return f"manylinux_2_{newest}_{platform.machine()}"


def write_wheel(version, library, licence, folder):
    tag = f"py3-none-{platform_tag(library)}"
    info = f"nmtan-{version}.dist-info"
    wheel = f"Wheel-Version: 1.0\nGenerator: nmtan\nRoot-Is-Purelib: false\nTag: {tag}\n"
    files = {**package(), "nmtan/libnmtan.so.0": library, f"{info}/LICENSE": licence,
             f"{info}/METADATA": metadata(version), f"{info}/WHEEL": wheel.encode()}
    record = [f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()},{len(data)}"
              for name, data in files.items()]
    files[f"{info}/RECORD"] = ("\n".join(record + [f"{info}/RECORD,,"]) + "\n").encode()
    path = os.path.join(folder, f"nmtan-{version}-{tag}.whl")
    with zipfile.ZipFile(path + ".part", "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, data)
    os.replace(path + ".part", path)
    return path


def write_sdist(version, files, folder):
    files = {**files, **package(), "pyproject.toml": PYPROJECT.encode(), "wheel.py": read(__file__),
             "PKG-INFO": metadata(version)}
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for name in sorted(files):
            entry = tarfile.TarInfo(f"nmtan-{version}/{name}")
            entry.size, entry.mode = len(files[name]), 0o644
            archive.addfile(entry, io.BytesIO(files[name]))
    path = os.path.join(folder, f"nmtan-{version}.tar.gz")
    with open(path, "wb") as file:
        file.write(gzip.compress(packed.getvalue(), mtime=0))
    return path


# Entry points for pip, in the folder of an unpacked source distribution.
def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    with tempfile.TemporaryDirectory() as folder:
        library = os.path.join(folder, "libnmtan.so.0")
        subprocess.run([*os.environ.get("CC", "cc").split(), "-O2", "-fPIC", "-shared", "-pthread", "-DNMTAN_THREADS",
                        "-DNMTAN_SUMS", "-Wl,-soname,libnmtan.so.0", "-o", library, "nmtan.c", "-lm"], check=True, cwd=HERE)
        path = write_wheel(version_of(os.path.join(HERE, "nmtan.h")), read(library), read(os.path.join(HERE, "LICENSE")),
                           wheel_directory)
    return os.path.basename(path)


def build_sdist(sdist_directory, config_settings=None):
    files = {name: read(os.path.join(HERE, name)) for name in ("nmtan.c", "nmtan.h", "LICENSE")}
    return os.path.basename(write_sdist(version_of(os.path.join(HERE, "nmtan.h")), files, sdist_directory))


if __name__ == "__main__":
    *kind, source, target = sys.argv[1:]
    os.makedirs(target, exist_ok=True)
    number = version_of("include/nmtan.h")
    if kind:
        print(write_sdist(number, {"nmtan.c": read(source), "nmtan.h": read("include/nmtan.h"), "LICENSE": read("LICENSE")},
                          target))
    else:
        print(write_wheel(number, read(source), read("LICENSE"), target))
