# SPDX-License-Identifier: MIT
"""Whole files: runs the tool nmtan and returns what its manifest says."""

import json
import os
import subprocess
import tempfile
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Union


class Conversion(NamedTuple):
    """The outcome of one input: a line of the manifest (data/nmtan-manifest.schema.json)."""

    input: str
    status: str  #: "done", or why there is no output
    exit_code: int
    outputs: List[str]  #: paths, the main file first
    dependencies: List[str]  #: every file that was read
    findings: Dict[str, int]  #: how often each code was found
    manifest: Dict[str, Any]  #: all that the line says


class ConversionError(RuntimeError):
    """The tool ended with an error: exit_code, message, and the conversion where the tool came that far."""

    def __init__(self, message: str, exit_code: int, conversion: Optional[Conversion] = None) -> None:
        super().__init__(message)
        self.exit_code, self.conversion = exit_code, conversion


def _arguments(options: Dict[str, Any]) -> Iterator[str]:
    chosen: Dict[str, Any] = {"outside": "no", **options}
    for name, value in chosen.items():
        name = name.rstrip("_").replace("_", "-")
        values = value if isinstance(value, (list, tuple)) else [value]
        for one in values:
            if one is True:
                yield f"--{name}"
            elif one is not False and one is not None:
                yield f"--{name}={one}"


def convert(input: Union[str, "os.PathLike[str]"], output: Union[str, "os.PathLike[str]"], *,
            program: Union[str, "os.PathLike[str]", Sequence[str]] = "nmtan", **options: Any) -> Conversion:
    """Converts a file with the tool nmtan, as `nmtan INPUT OUTPUT --options` does.

    Options have the tool's names with _ for -: convert("a.obj", "a.glb", normals="smooth", verify=True); False and
    None leave one out, a list repeats it. outside="no" is the default: who calls may not know the file.
    program: the tool, found along PATH, or a list with arguments before ours.
    Raises ValueError where a path is "-", ConversionError where the tool ends with anything but 0, FileNotFoundError
    where there is no tool.
    """
    for name, path in (("input", input), ("output", output)):
        if os.fspath(path) == "-":
            raise ValueError(f"{name}: the path of a file is expected: standard input and output are not passed on")
    command = [os.fspath(program)] if isinstance(program, (str, os.PathLike)) else list(program)
    with tempfile.TemporaryDirectory() as folder:
        manifest = os.path.join(folder, "manifest")
        run = subprocess.run([*command, *_arguments(options), f"--manifest={manifest}", "--", os.fspath(input),
                              os.fspath(output)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, text=True, errors="replace", check=False)
        lines = []
        if os.path.exists(manifest):
            with open(manifest, encoding="utf-8", errors="replace") as file:
                lines = file.read().splitlines()
    line = json.loads(lines[0]) if lines else None
    conversion = None if line is None else Conversion(
        line["input"], line["status"], line["exit_code"], [entry["path"] for entry in line["outputs"]],
        [entry["path"] for entry in line["dependencies"]], line["findings"], line)
    if run.returncode or conversion is None:
        raise ConversionError(run.stderr.strip() or f"nmtan ended with {run.returncode}", run.returncode, conversion)
    return conversion
