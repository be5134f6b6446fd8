#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""wheel.py VERSION LIBRARY LICENSE FOLDER: writes FOLDER/nmtan-VERSION-....whl, the package with the shared library.

A wheel is a zip with three files of metadata (PEP 427); the same input gives the same bytes.
"""

import base64
import hashlib
import os
import platform
import sys
import zipfile

version, library, licence, folder = sys.argv[1:]
here = os.path.dirname(os.path.abspath(__file__))
tag = f"py3-none-linux_{platform.machine()}"
info = f"nmtan-{version}.dist-info"
metadata = f"""Metadata-Version: 2.1
Name: nmtan
Version: {version}
Summary: Tangents for normal-mapped meshes: MikkTSpace to the byte, in NumPy arrays
License: MIT
Requires-Python: >=3.9
Requires-Dist: numpy
"""
wheel = f"Wheel-Version: 1.0\nGenerator: nmtan\nRoot-Is-Purelib: false\nTag: {tag}\n"


def read(path):
    with open(path, "rb") as file:
        return file.read()


package = os.path.join(here, "nmtan")
files = {f"nmtan/{name}": read(os.path.join(package, name)) for name in sorted(os.listdir(package))
         if name.endswith(".py") or name == "py.typed"}
files["nmtan/libnmtan.so.0"] = read(library)
files[f"{info}/LICENSE"] = read(licence)
files[f"{info}/METADATA"] = metadata.encode()
files[f"{info}/WHEEL"] = wheel.encode()
record = [f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()},{len(data)}"
          for name, data in files.items()]
files[f"{info}/RECORD"] = ("\n".join(record + [f"{info}/RECORD,,"]) + "\n").encode()

os.makedirs(folder, exist_ok=True)
path = os.path.join(folder, f"nmtan-{version}-{tag}.whl")
with zipfile.ZipFile(path + ".part", "w", zipfile.ZIP_DEFLATED) as archive:
    for name, data in files.items():
        entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
        entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
        archive.writestr(entry, data)
os.replace(path + ".part", path)
print(path)
