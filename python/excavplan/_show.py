# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""How objects show themselves: repr(), and in a notebook a table beneath the picture of plot().

All is read from the classes: the properties in their order, and the unit of each from the brackets of
its docstring. SHOWN names what of a class comes into its repr(), where that is not all.
"""

import base64
import functools
import html
import inspect
import math
import re

SHOWN = {
    "CloudSummary": ("finite_points", "min", "max", "density", "frame_guess"),
    "DensityEstimate": ("density", "bulking", "trustworthy", "warnings"),
    "DigPlan": ("dig", "spread", "method", "reason", "trustworthy", "warnings"),
    "DigResult": ("payload_mass", "payload_volume", "energy", "peak_force", "stall"),
    "DigScene": ("soil", "density_percent", "dig", "volumes", "duration"),
    "EnergyLedger": ("total", "soil", "payload", "links", "lift"),
    "JobEvent": ("what", "step", "payload_mass", "energy", "time", "left_volume"),
    "PlannedDig": ("parameters", "start_x", "payload_mass", "energy", "duration", "fill"),
    "RelativeDensity": ("percent", "sd_percent", "interval_percent"),
    "SiteUpdate": ("density", "digs", "taken", "warnings", "trustworthy"),
    "VolumeChange": ("excavated", "spilled", "dumped", "before", "after"),
}
# Units in which people read what is kept in SI: per kilojoule, per cubic metre.
SCALES = {
    "J": (1e-3, "kJ"), "N": (1e-3, "kN"), "N m": (1e-3, "kN m"), "J/m^3": (1e-3, "kJ/m^3"),
    "kg/J": (1e3, "kg/kJ"), "N/m^3": (1e-3, "kN/m^3"), "Pa": (1e-3, "kPa"), "W": (1e-3, "kW"),
}
LONGEST, LONGEST_INSIDE = 120, 250  # of a text, and of an object inside of another


@functools.lru_cache(maxsize=None)
def members(kind):
    """(name, unit, meaning) of all properties of a class, those of its bases first."""
    found = {}
    for each in reversed(kind.__mro__):
        for name, member in vars(each).items():
            if isinstance(member, property):
                lines = (member.__doc__ or "").strip().splitlines()
                text = " ".join(line for line in lines if "->" not in line)
                units = set(re.findall(r"\[([^\]]*)\]", text))
                found[name] = (name, units.pop() if len(units) == 1 else "", text)
    return tuple(found.values())


def with_unit(text, unit):
    shown = SCALES.get(unit, (1.0, unit))[1]
    return text if shown in ("", "-") else f"{text} {shown}"


def digits(value, unit):
    """Four of them, in the unit that people read: "12.35" of 12345 J."""
    value *= SCALES.get(unit, (1.0, unit))[0]
    return f"{value:.0f}" if 1e4 <= abs(value) < 1e15 else f"{value:.4g}"


def measured(value, sd, unit):
    """As far as the deviation lets it be known: "0.2681 +- 0.0020 m^3"."""
    factor = SCALES.get(unit, (1.0, unit))[0]
    if not 0 < sd * factor < 1e15:
        return with_unit(f"{digits(value, unit)} +- {digits(sd, unit)}", unit)
    places = max(0, 1 - math.floor(math.log10(sd * factor)))
    return with_unit(f"{value * factor:.{places}f} +- {sd * factor:.{places}f}", unit)


def sequence(values, unit):
    """A few numbers in full, else how many there are; "" for none."""
    if not values:
        return ""
    if len(values) <= 4 and all(isinstance(each, (int, float)) for each in values):
        return with_unit("(" + ", ".join(digits(each, unit) for each in values) + ")", unit)
    if all(hasattr(each, "code") for each in values):  # warnings
        return ", ".join(each.code for each in values)
    if all(isinstance(each, str) for each in values):
        return value_text(", ".join(dict.fromkeys(values)), unit)
    return f"{len(values)} of {type(values[0]).__name__}"


def value_text(value, unit):
    """A value in a line; "" if there is nothing to say."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value)
    if isinstance(value, (int, float)):
        return with_unit(digits(value, unit), unit)
    if isinstance(value, str):
        return value if len(value) <= LONGEST else value[:LONGEST] + "..."
    if isinstance(value, (tuple, list)):
        return sequence(value, unit)
    if hasattr(value, "value") and hasattr(value, "sd"):
        return measured(value.value, value.sd, unit)
    if hasattr(value, "value") and hasattr(value, "interval"):
        ends = " .. ".join(digits(each, unit) for each in value.interval)
        return with_unit(f"{digits(value.value, unit)} ({ends})", unit)
    if hasattr(value, "shape"):
        return "array of " + " x ".join(map(str, value.shape)) if all(value.shape) else ""
    text = repr(value)
    return text if len(text) <= LONGEST_INSIDE else f"<{type(value).__name__}>"


def stated(thing, name):
    """The value of a property, None where it has none now."""
    try:
        return getattr(thing, name)
    except Exception:  # a site that was closed: what it shows must not fail
        return None


def shown(thing):
    """<DigSpread: payload_mass 12.35 kg, energy 4.1 kJ>"""
    kind = type(thing)
    parts = []
    for name, unit, _ in members(kind):
        if name in SHOWN.get(kind.__name__, (name,)):
            text = value_text(stated(thing, name), unit)
            if text:
                parts.append(f"{name} {text}")
    return f"<{kind.__name__}: {', '.join(parts)}>" if parts else f"<{kind.__name__}>"


def picture_of(thing):
    """The picture of plot() as an image, which keeps its names to itself; "" if there is none."""
    if not hasattr(thing, "plot"):
        return ""
    try:
        svg = thing.plot().svg
    except Exception:  # a plan without a dig has nothing to draw
        return ""
    code = base64.b64encode(svg.encode("utf-8")).decode("ascii")
    return f'<img src="data:image/svg+xml;base64,{code}" style="display:block;max-width:100%;background:white">'


def as_html(thing):
    """The picture, and a table of all values with their units."""
    rows = []
    for name, unit, text in members(type(thing)):
        value = value_text(stated(thing, name), unit)
        if value:
            rows.append(f'<tr title="{html.escape(text)}"><th style="text-align:left">{name}</th>'
                        f'<td style="text-align:left">{html.escape(value)}</td></tr>')
    head = html.escape(type(thing).__name__ if rows else repr(thing))
    table = f"<table>{''.join(rows)}</table>" if rows else ""
    return f"<div><strong>{head}</strong>{picture_of(thing)}{table}</div>"


def dress(module):
    """Lets all public classes of a module show themselves; those with a text of their own keep it."""
    for name in module.__all__:
        kind = getattr(module, name)
        if not inspect.isclass(kind) or issubclass(kind, Exception):
            continue
        if kind.__repr__ is object.__repr__:
            kind.__repr__ = shown
        if not hasattr(kind, "_repr_svg_"):
            kind._repr_html_ = as_html
