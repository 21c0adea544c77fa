# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the type stub of the package from the signatures of the module.

    PYTHONPATH=build/python python3 python/stub/write_stub.py > python/excavplan/__init__.pyi

tests/python/stubs_test.py compares the two.
"""

import inspect
import re

import excavplan
from excavplan import _core

HEAD = '''# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
# Written by python/stub/write_stub.py from the module.
import os
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union, final, overload

__version__: str
__all__: List[str]

Array = Any  # numpy.ndarray where NumPy is installed, else memoryview; read-only
ArrayLike = Any  # whatever has the buffer protocol, or nested sequences of numbers
Vector2 = Tuple[float, float]
Vector3 = Tuple[float, float, float]
Vector4 = Tuple[float, float, float, float]
File = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]
'''

SCAN = "Union[Scan, File, Cloud, ArrayLike]"
# Arguments that the module itself tells apart, by function and name.
ARGUMENTS = {
    "source": "Union[File, Cloud, ArrayLike, Sequence[Union[File, Cloud]]]",
    "before": SCAN,
    "after": SCAN,
    "scan": SCAN,
    "dump": "Optional[Tuple[Any, Any]]",
}
TOLD_OF_STEPS = "Optional[Callable[[TrialStep], Optional[bool]]]"
MAY_BE_DERIVED_FROM = 1 << 10  # Py_TPFLAGS_BASETYPE
SIMULATOR_KIND = "Union[str, Callable[[Machine, SoilKind, float], SoilSimulator], None]"


def type_of(text):
    """A type as the stub has it, of an argument or a result."""
    text = re.sub(r"\bexcavplan\.", "", text)
    text = re.sub(r"([Ll])ist\[float\[(\d+)\]\]", lambda m: "List[float]", text)
    return re.sub(r"\bobject\b", "Any", text)


def result_type(text):
    return re.sub(r"\bFile\b", "str", type_of(text))


def argument_type(function, name, text):
    """Of an argument, which takes more than a result gives."""
    if function == "play_job" and text == "object":
        return "Union[SiteJob, str]" if name == "planner" else TOLD_OF_STEPS
    if text == "object" and name == "simulator":
        return "SoilSimulator" if function in ("evaluate_dig", "search_dig") else SIMULATOR_KIND
    if text == "object" and name == "progress":
        told = "LibraryProgress" if function == "build_path_library" else "SearchProgress"
        return f"Optional[Callable[[{told}], Optional[bool]]]"
    if text == "object" and name in ARGUMENTS:
        return ARGUMENTS[name]
    text = type_of(text)
    text = re.sub(r"\bVector[234]\b", "Sequence[float]", text)
    text = re.sub(r"\bList\[", "Sequence[", text)
    text = re.sub(r"\bGroundDensity\b", "Union[GroundDensity, float]", text)
    if function == "dig":  # which simulators override
        return text
    return re.sub(r"\bTerrain\b", "Union[Terrain, HeightMap, GroundState]", text)


def split(text):
    """Parts between commas that stand in no bracket."""
    parts, depth, part = [], 0, ""
    for letter in text:
        depth += (letter in "[(<") - (letter in "])>")
        if letter == "," and depth == 0:
            parts.append(part.strip())
            part = ""
        else:
            part += letter
    return [*parts, part.strip()] if part.strip() else parts


def argument(function, text):
    match = re.fullmatch(r"(\w+)(?:: (.*?))?( = .*)?", text, re.DOTALL)
    if text == "*" or match is None:
        return text
    name, kind, default = match.groups()
    if name == "self" or kind is None:
        return name
    wanted = argument_type(function, name, kind)
    if default == " = None" and wanted == SCAN:
        wanted = f"Optional[{SCAN}]"
    return f"{name}: {wanted}{' = ...' if default else ''}"


def signatures(function):
    """(arguments, result) of each overload, from the docstring that pybind11 writes."""
    name = function.__name__
    found = re.findall(rf"^(?:\d+\. )?{re.escape(name)}\((.*)\) -> (.*)$", function.__doc__,
                       re.MULTILINE)
    return [([argument(name, part) for part in split(arguments)], result_type(result))
            for arguments, result in found]


def lines_of(name, function, indent=""):
    lines = []
    is_static = isinstance(function, staticmethod)
    found = signatures(function.__func__ if is_static else function)
    for arguments, result in found:
        if indent and not is_static:
            arguments[0] = "self"
        lines += [f"{indent}@overload"] * (len(found) > 1)
        lines += [f"{indent}@staticmethod"] * is_static
        lines.append(f"{indent}def {name}({', '.join(arguments)}) -> {result}: ...")
    return lines


def property_lines(name, member):
    first_line = member.fget.__doc__.strip().splitlines()[0]
    kind = result_type(re.search(r"-> (.*)$", first_line).group(1))
    if member.fset is not None:
        return [f"    {name}: {kind}"]
    return ["    @property", f"    def {name}(self) -> {kind}: ..."]


def class_lines(name, kind):
    if issubclass(kind, Exception):
        base = kind.__base__.__name__
        return [f"class {name}({base}):", "    kind: str"]
    base = kind.__base__.__name__
    lines = [f"class {name}({base}):" if hasattr(excavplan, base) else f"class {name}:"]
    if not kind.__flags__ & MAY_BE_DERIVED_FROM:
        lines.insert(0, "@final")
    for member_name, member in sorted(vars(kind).items()):
        if isinstance(member, property):
            lines += property_lines(member_name, member)
        elif inspect.isroutine(member) and member.__doc__ and (
                not member_name.startswith("_") or member_name in ("__init__", "__len__",
                                                                   "__bool__", "__enter__",
                                                                   "__exit__")):
            if signatures(getattr(member, "__func__", member)):
                lines += lines_of(member_name, member, "    ")
    return lines if lines[-1].startswith(" ") else [*lines, "    ..."]


def stub():
    blocks = []
    for name in sorted(_core.__all__):
        member = getattr(excavplan, name)
        blocks.append(class_lines(name, member) if inspect.isclass(member)
                      else lines_of(name, member))
    return HEAD + "".join("\n" + "\n".join(block) + "\n" for block in blocks)


if __name__ == "__main__":
    print(stub(), end="")
