# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""A plain site as files: a short trench in level loam of 40 %, with a windrow to its left."""

import json
import pathlib

X_MIN, Y_MIN, WIDTH, HEIGHT = -8.0, -7.0, 18.0, 14.0  # of its ground [m]


def grid(path, cell, value):
    columns, rows = round(WIDTH / cell), round(HEIGHT / cell)
    row = " ".join([str(value)] * columns)
    path.write_text(f"ncols {columns}\nnrows {rows}\nxllcorner {X_MIN}\nyllcorner {Y_MIN}\n"
                    f"cellsize {cell}\nNODATA_value -9999\n" + "\n".join([row] * rows) + "\n",
                    encoding="ascii")


def write_plain_site(folder, length=2.5, depth=0.4):
    """Writes it into a folder that is not there. Lengths in [m]."""
    folder = pathlib.Path(folder)
    (folder / "hidden").mkdir(parents=True)
    site = {"format": "plain-site", "version": 1, "id": folder.name,
            "design": {"kind": "trench", "length_m": length, "floor_width_m": 1.0,
                       "depth_m": depth, "origin_m": [2.0, 0.0], "heading_rad": 0.0,
                       "floor_z_at_middle_m": -depth},
            "tolerance_m": 0.03, "machine": {"class": "zx120"},
            "start_pose": {"x": -0.2, "y": 0.0, "heading_rad": 0.0},
            "soil": {"name": "loam"},
            "sensor": {"name": "lidar", "mount": "cab", "noise_sd_at_1m_m": 0.01, "height_m": 3.0,
                       "tilt_deg": 25, "field_of_view_deg": [360, 45]},
            "dump_areas": [{"kind": "windrow",
                            "polygon": [[-1.0, 1.5], [7.0, 1.5], [7.0, 5.5], [-1.0, 5.5]]}],
            "keep_out": [], "obstacles": [], "files": {"first_scan": "scan0.asc"}}
    truth = {"payload_noise": 0.01, "tracking_height_sd_m": 0.012, "tracking_side_sd_m": 0.02}
    (folder / "site.json").write_text(json.dumps(site), encoding="ascii")
    (folder / "hidden/truth.json").write_text(json.dumps(truth), encoding="ascii")
    grid(folder / "scan0.asc", 0.1, 0)
    grid(folder / "hidden/ground.asc", 0.1, 0)
    grid(folder / "hidden/density.asc", 0.5, 40)
    return folder
