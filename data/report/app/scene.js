// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// What the page draws: ground, machine and digs, from the element #data.

const scene = JSON.parse(document.getElementById("data").textContent);

const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

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

// Bilinear between the centres of cells; NaN outside and beside unknown cells.
const heightAt = (area, z, x, y) => {
  const u = Math.min(Math.max((x - area.x0) / area.cell, 0), area.cols - 1);
  const v = Math.min(Math.max((y - area.y0) / area.cell, 0), area.rows - 1);
  if (
    Math.abs((x - area.x0) / area.cell - u) > 0.51 ||
    Math.abs((y - area.y0) / area.cell - v) > 0.51
  )
    return NaN;
  const col = Math.min(Math.floor(u), area.cols - 2);
  const row = Math.min(Math.floor(v), area.rows - 2);
  const at = (r, c) => z[r * area.cols + c];
  const low = at(row, col) + (u - col) * (at(row, col + 1) - at(row, col));
  const high = at(row + 1, col) + (u - col) * (at(row + 1, col + 1) - at(row + 1, col));
  return low + (v - row) * (high - low);
};

const machine = scene.machine;
let dig = scene.digs[0];
// The state of the ground that the dig leaves; the first is that before it.
const lastState = () =>
  dig && dig.state !== undefined
    ? dig.state
    : Math.max(0, ...areas.map((area) => area.states.length - 1));

// Index and share of the point before a time in rising times.
const placeOf = (times, time) => {
  let low = 0;
  let high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  if (high === low) return [0, 0, 0];
  const share = Math.min(Math.max((time - times[low]) / (times[high] - times[low]), 0), 1);
  return [low, high, share];
};

const valueAt = (times, values, time) => {
  const [low, high, share] = placeOf(times, time);
  return values[low] + share * (values[high] - values[low]);
};
