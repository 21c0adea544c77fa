# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Soil-adaptive planning of autonomous excavation: from scans to density to the next dig.

Units are SI (m, kg, s, N, J, rad), densities and other shares of 100 are in percent. The site frame
has its origin on the machine's swing axis at ground level, x forward, y left, z up. Arrays are those
of NumPy where it is installed, else memoryviews; both are read-only.
"""

from . import _core, _show
from ._core import *  # noqa: F403
from ._core import __all__, __version__  # noqa: F401

_show.dress(_core)
