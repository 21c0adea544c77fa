// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The job: its ground after each step, and the line along which it lies.

const events = [];
let lastStep = 0;
const tolerance = scene.design.tolerance_m;
const grid = {
  x0: scene.origin_m[0] + 0.5 * scene.cell_m,
  y0: scene.origin_m[1] + 0.5 * scene.cell_m,
  cell: scene.cell_m,
  rows: scene.rows,
  cols: scene.cols,
};
const cellCount = grid.rows * grid.cols;
const placeOfCell = (i) => [
  grid.x0 + (i % grid.cols) * grid.cell,
  grid.y0 + Math.floor(i / grid.cols) * grid.cell,
];
const firstHeights = summedNumbersOf(scene.before, cellCount); // mm
const before = metresOf(firstHeights);
const target = metresOf(summedNumbersOf(scene.target, cellCount));

const forEachOfBlock = (block, visit) => {
  if (!block) return;
  for (let i = 0; i < block.numbers.length; ++i) {
    if (block.numbers[i] === 0) continue;
    const row = block.row + Math.floor(i / block.cols);
    visit(row * grid.cols + block.col + (i % block.cols), block.numbers[i]);
  }
};

// Heights after so many steps, in millimetres and in metres, and the step in which each cell was
// last seen, -1: never. The next step is made from the one before it.
const groundAt = (() => {
  const fresh = () => ({
    step: 0,
    millimetres: firstHeights.slice(),
    z: before.slice(),
    seen: summedNumbersOf(scene.seen, cellCount).map((known) => known - 1),
  });
  let now = fresh();
  return (step) => {
    if (step < now.step) now = fresh();
    while (now.step < step) {
      const event = events[now.step++];
      forEachOfBlock(event.ground, (i, change) => {
        now.millimetres[i] += change;
        now.z[i] = now.millimetres[i] === unknownHeight ? NaN : now.millimetres[i] / 1000;
      });
      forEachOfBlock(event.seen, (i, news) => {
        now.seen[i] = news > 0 ? now.step : -1;
      });
    }
    return now;
  };
})();

// Sums up to each step, the first before any.
const minutes = [0];
const kilojoules = [0];
const volumesLeft = [scene.design_m3];
const digsIn = (event) => event.what === "dig" || event.what === "finish";

// Along the design and beside it, from its near end on its middle line.
const axis = (() => {
  const heading = "heading_rad" in scene ? scene.heading_rad : scene.design.start[3];
  const [c, s] = [Math.cos(heading), Math.sin(heading)];
  const of = (x, y) => [c * x + s * y, c * y - s * x];
  const box = { a0: Infinity, a1: -Infinity, b0: Infinity, b1: -Infinity };
  target.forEach((z, i) => {
    if (Number.isNaN(z)) return;
    const [a, b] = of(...placeOfCell(i));
    box.a0 = Math.min(box.a0, a - 0.5 * grid.cell);
    box.a1 = Math.max(box.a1, a + 0.5 * grid.cell);
    box.b0 = Math.min(box.b0, b - 0.5 * grid.cell);
    box.b1 = Math.max(box.b1, b + 0.5 * grid.cell);
  });
  if (!(box.a1 > box.a0)) Object.assign(box, { a0: 0, a1: 1, b0: 0, b1: 1 });
  const middle = (box.b0 + box.b1) / 2;
  return {
    length: box.a1 - box.a0,
    half: (box.b1 - box.b0) / 2,
    of: (x, y) => {
      const [a, b] = of(x, y);
      return [a - box.a0, b - middle];
    },
    place: (along, beside) => {
      const [a, b] = [along + box.a0, beside + middle];
      return [c * a - s * b, s * a + c * b];
    },
  };
})();

// Where along the design each step dug, by what fell there; else where the step before did.
const dugAt = [axis.length / 2];
const placeDug = (event) => {
  let weight = 0;
  let sum = 0;
  if (digsIn(event))
    forEachOfBlock(event.ground, (i, change) => {
      if (!(change < -5) || Number.isNaN(target[i])) return;
      weight -= change;
      sum -= change * axis.of(...placeOfCell(i))[0];
    });
  return weight > 0 ? sum / weight : dugAt[lastStep];
};

const addStep = (event) => {
  const { ground, seen } = event;
  if (ground) ground.numbers = numbersOf(ground.codes, ground.rows * ground.cols);
  if (seen) seen.numbers = summedNumbersOf(seen.codes, seen.rows * seen.cols);
  minutes.push(minutes[lastStep] + (event.time_s || 0) / 60);
  kilojoules.push(kilojoules[lastStep] + (event.energy_j || 0) / 1000);
  volumesLeft.push(event.left_m3);
  dugAt.push(placeDug(event));
  events.push(event);
  ++lastStep;
};
scene.events.forEach(addStep);

const baseAt = (step) => (step > 0 ? events[step - 1].base : scene.design.start);

const range = (() => {
  const pairs = [0, 0.5, 1].map((share) => [
    groundAt(Math.round(share * lastStep)).z.slice(),
    before,
  ]);
  return rangeOf(pairs);
})();
