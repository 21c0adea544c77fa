// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// Ground and digs.

const heightsOf = (state) => {
  const bytes = bytesOf(state.codes);
  const z = new Float64Array(bytes.length / 2);
  for (let i = 0; i < z.length; ++i) {
    const code = bytes[2 * i] | (bytes[2 * i + 1] << 8);
    z[i] = code === 65535 ? NaN : state.base_m + state.step_m * code;
  }
  return z;
};

// The part of an area that has a known cell in any state.
const areas = scene.areas
  .map((area) => {
    const states = area.states.map(heightsOf);
    const box = { row: [Infinity, -Infinity], col: [Infinity, -Infinity] };
    const grow = (pair, i) => {
      pair[0] = Math.min(pair[0], i);
      pair[1] = Math.max(pair[1], i);
    };
    for (const z of states) {
      z.forEach((value, i) => {
        if (Number.isNaN(value)) return;
        grow(box.row, Math.floor(i / area.cols));
        grow(box.col, i % area.cols);
      });
    }
    const [rows, cols] = [box.row[1] - box.row[0] + 1, box.col[1] - box.col[0] + 1];
    const cut = (list) => {
      const part = new list.constructor(Math.max(0, rows * cols));
      for (let i = 0; i < part.length; ++i) {
        part[i] = list[(box.row[0] + Math.floor(i / cols)) * area.cols + box.col[0] + (i % cols)];
      }
      return part;
    };
    return {
      x0: area.origin_m[0] + (box.col[0] + 0.5) * area.cell_m,
      y0: area.origin_m[1] + (box.row[0] + 0.5) * area.cell_m,
      cell: area.cell_m,
      rows,
      cols,
      coarse: area.cell_m > area.surveyed_cell_m * 1.5,
      names: area.states.map((state) => state.name),
      states: states.map(cut),
      zone: area.zone ? cut(bytesOf(area.zone)) : null,
    };
  })
  .filter((area) => area.rows > 1 && area.cols > 1);

let dig = scene.digs[0];
// The state of the ground that the dig leaves; the first is that before it.
const lastState = () =>
  dig && dig.state !== undefined
    ? dig.state
    : Math.max(0, ...areas.map((area) => area.states.length - 1));

const range = rangeOf(areas.flatMap((area) => area.states.map((z) => [z, area.states[0]])));
