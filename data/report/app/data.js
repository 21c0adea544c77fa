// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// What the page draws, from the element #data.

const scene = JSON.parse(document.getElementById("data").textContent);

const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

const machine = scene.machine;

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
