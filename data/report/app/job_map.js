// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The site from above: what is left of the design, or how long ago a cell was seen.

const makeMap = (moveCut) => {
  const canvas = element("map");
  const svg = element("map-lines");
  const box = element("map-box");
  const layers = { error: "error left", age: "last scan" };
  const picture = document.createElement("canvas");
  picture.width = grid.cols;
  picture.height = grid.rows;
  const image = picture.getContext("2d").createImageData(grid.cols, grid.rows);
  let shown = "error";
  let last = null; // step and cut that were drawn last

  // Grey, lit from the north-west.
  const shade = (z, i) => {
    const east = z[i + 1] - z[i - 1];
    const north = z[i + grid.cols] - z[i - grid.cols];
    const slope = (north - east) / (4 * grid.cell);
    return Number.isNaN(slope) ? 0.86 : Math.min(0.98, Math.max(0.55, 0.86 - 0.6 * slope));
  };
  const colourOf = {
    error: ({ z }) => (i) => {
      if (Number.isNaN(z[i])) return [1, 1, 1];
      if (!Number.isNaN(target[i])) return errorColour(tolerance, z[i] - target[i]);
      const light = shade(z, i);
      return [light, 0.985 * light, 0.96 * light];
    },
    age: ({ seen, step }) => {
      const longest = Math.max(1e-9, minutes[step]);
      return (i) =>
        seen[i] < 0 ? [1, 1, 1] : mix(ageRamp, (minutes[step] - minutes[seen[i]]) / longest);
    },
  };

  const paint = (step) => {
    const colour = colourOf[shown](groundAt(step));
    for (let i = 0; i < cellCount; ++i) {
      const c = colour(i);
      const row = grid.rows - 1 - Math.floor(i / grid.cols);
      const at = 4 * (row * grid.cols + (i % grid.cols));
      for (let k = 0; k < 3; ++k) image.data[at + k] = 255 * c[k];
      image.data[at + 3] = 255;
    }
    picture.getContext("2d").putImageData(image, 0, 0);
    const context = canvas.getContext("2d");
    context.imageSmoothingEnabled = false;
    context.drawImage(picture, 0, 0, canvas.width, canvas.height);
  };

  // -- Lines over it
  const extent = {
    x0: grid.x0 - 0.5 * grid.cell,
    y0: grid.y0 - 0.5 * grid.cell,
    width: grid.cols * grid.cell,
    height: grid.rows * grid.cell,
  };
  let scale = 1; // pixels per metre
  const X = (x) => scale * (x - extent.x0);
  const Y = (y) => scale * (extent.y0 + extent.height - y);
  const point = ([x, y]) => `${X(x).toFixed(1)},${Y(y).toFixed(1)}`;
  const polygon = (corners, attributes) => {
    const points = corners.map(point).join(" ");
    svgElement("polygon", { points, fill: "none", ...attributes }, svg);
  };
  const segment = ([x1, y1], [x2, y2], attributes) =>
    svgElement("line", { x1: X(x1), y1: Y(y1), x2: X(x2), y2: Y(y2), ...attributes }, svg);
  const text = (string, x, y, attributes) => {
    svgElement("text", { x, y, "text-anchor": "middle", ...attributes }, svg).textContent = string;
  };
  // Names of places, each below those that it would cover.
  const names = [];
  const name = (string, [x, y]) => {
    const half = 3.6 * string.length;
    const at = { x: Math.min(Math.max(X(x), half), scale * extent.width - half), y: Y(y) - 4 };
    const covers = (other) =>
      Math.abs(other.x - at.x) < half + other.half && Math.abs(other.y - at.y) < 14;
    while (names.some(covers)) at.y += 3;
    names.push({ ...at, half });
    text(string, at.x, at.y, { class: "on-map" });
  };
  const footprint = (() => {
    const parts = [];
    const inside = (row, col) =>
      Math.min(row, col) >= 0 &&
      row < grid.rows &&
      col < grid.cols &&
      !Number.isNaN(target[row * grid.cols + col]);
    for (let row = 0; row <= grid.rows; ++row)
      for (let col = 0; col <= grid.cols; ++col) {
        const [x, y] = [extent.x0 + col * grid.cell, extent.y0 + row * grid.cell];
        const edge = (dx, dy) => parts.push([[x, y], [x + dx, y + dy]]);
        if (inside(row, col) !== inside(row - 1, col)) edge(grid.cell, 0);
        if (inside(row, col) !== inside(row, col - 1)) edge(0, grid.cell);
      }
    return parts;
  })();
  const highest = (corners) => corners.reduce((a, b) => (b[1] > a[1] ? b : a));
  const middleOf = (corners) =>
    [0, 1].map((k) => corners.reduce((sum, p) => sum + p[k], 0) / corners.length);

  const edges = () => {
    const line = (x1, y1, x2, y2) =>
      svgElement("line", { x1, y1, x2, y2, stroke: "#5b626b", "stroke-width": 1 }, svg);
    const [w, h] = [scale * extent.width, scale * extent.height];
    const xs = ticks(extent.x0, extent.x0 + extent.width, Math.min(12, w / 55));
    const ys = ticks(extent.y0, extent.y0 + extent.height, Math.min(10, h / 45));
    for (const x of xs.list) {
      line(X(x), h, X(x), h - 5);
      if (X(x) > 24 && X(x) < w - 24) text(signed(x, xs.digits), X(x), h - 9, {});
    }
    for (const y of ys.list) {
      line(0, Y(y), 5, Y(y));
      if (Y(y) > 14 && Y(y) < h - 26)
        text(signed(y, ys.digits), 8, Y(y) + 4, { "text-anchor": "start" });
    }
  };
  const machineOn = (step) => {
    for (let i = 1; i <= step; ++i) {
      if (events[i - 1].what !== "move") continue;
      segment(baseAt(i - 1), baseAt(i), { stroke: "#3a3e44", "stroke-dasharray": "3 3" });
    }
    const [x, y, , heading] = baseAt(step);
    const [c, s] = [Math.cos(heading), Math.sin(heading)];
    const at = (a, b) => [x + c * a - s * b, y + s * a + c * b];
    const front = machine.track_front_m;
    const half = 0.7 * front;
    polygon([at(-front, -half), at(front, -half), at(front, half), at(-front, half)], {
      fill: "#e6ae34",
      stroke: "#3a3e44",
      "stroke-width": 1.2,
    });
    polygon([at(0.9 * front, -0.35 * half), at(1.5 * front, 0), at(0.9 * front, 0.35 * half)], {
      fill: "#3a3e44",
    });
  };
  const dumpOn = (step) => {
    const event = step > 0 ? events[step - 1] : null;
    if (!event || !event.dump) return;
    const [x, y] = event.dump;
    svgElement(
      "circle",
      { cx: X(x), cy: Y(y), r: 5, fill: "none", stroke: "#7a4b00", "stroke-width": 2 },
      svg,
    );
  };
  const lay = (step, cut) => {
    svg.replaceChildren();
    names.length = 0;
    const path = footprint.map((part) => `M${point(part[0])}L${point(part[1])}`).join("");
    svgElement("path", { d: path, stroke: "#00528c", "stroke-width": 1.4, fill: "none" }, svg);
    const { dump_areas, keep_out, obstacles, truck } = scene.design;
    const look = (stroke, fill) => ({ stroke, fill, "stroke-width": 1.6 });
    for (const area of dump_areas) polygon(area.polygon, look("#b36b00", "none"));
    for (const area of keep_out) polygon(area.polygon, look("#b2182b", "rgba(178,24,43,0.14)"));
    for (const each of obstacles) polygon(each.polygon, look("#3a3e44", "rgba(90,95,102,0.7)"));
    if (truck) polygon(truck.polygon, look("#33567a", "rgba(77,120,163,0.5)"));
    machineOn(step);
    dumpOn(step);
    const reach = 1.5;
    for (const [a0, b0, a1, b1] of [
      [-reach, cut.beside, axis.length + reach, cut.beside],
      [cut.along, -axis.half - 2 * reach, cut.along, axis.half + 2 * reach],
    ]) {
      const [p, q] = [axis.place(a0, b0), axis.place(a1, b1)];
      const dashed = { "stroke-dasharray": "7 4" };
      segment(p, q, { ...dashed, stroke: "#ffffff", "stroke-width": 3, opacity: 0.7 });
      segment(p, q, { ...dashed, stroke: "#1d2024" });
    }
    edges();
    for (const area of dump_areas) name(area.kind, middleOf(area.polygon));
    for (const area of keep_out) {
      name(`keep out${area.kind ? `: ${area.kind}` : ""}`, highest(area.polygon));
    }
    for (const each of obstacles) name(each.kind || "obstacle", highest(each.polygon));
    if (truck) name("truck", middleOf(truck.polygon));
  };

  const key = (step) => {
    const node = element("map-key");
    node.replaceChildren();
    if (shown === "age") {
      for (const share of [0, 0.25, 0.5, 0.75, 1]) {
        const colour = css(mix(ageRamp, share));
        addKey(node, `${(share * minutes[step]).toFixed(0)} min ago`, colour, colour);
      }
      addKey(node, "not seen as it is now", "#ffffff", "var(--soft)");
      return;
    }
    const centimetres = (factor) => +(100 * factor * tolerance).toFixed(1);
    const entry = (text, factor) => {
      const colour = css(errorColour(tolerance, factor * tolerance));
      addKey(node, text, colour, "var(--line)");
    };
    const bands = errorBounds.map((bound, k) => [bound, errorBounds[k + 1]]);
    for (const [from, to] of bands.slice().reverse()) {
      const low = `+${centimetres(from)}`;
      entry(to ? `${low} .. ${centimetres(to)}` : `over ${low} cm`, from * 1.01);
    }
    entry(`within ±${centimetres(1)}`, 0);
    for (const [from, to] of bands) {
      const high = `−${centimetres(from)}`;
      entry(to ? `${high} .. ${centimetres(to)}` : `below ${high} cm`, -from * 1.01);
    }
  };

  const draw = (step, cut) => {
    last = [step, cut];
    paint(step);
    lay(step, cut);
    key(step);
  };
  const fit = () => {
    const width = Math.max(240, element("plan").clientWidth - 2);
    const most = printing ? 420 : Math.max(320, Math.min(640, 0.9 * width));
    scale = Math.min(width / extent.width, most / extent.height);
    const [w, h] = [extent.width, extent.height].map((side) => Math.round(scale * side));
    Object.assign(box.style, { width: `${w + 2}px`, height: `${h + 2}px` });
    const ratio = Math.min(devicePixelRatio || 1, 2);
    Object.assign(canvas, { width: w * ratio, height: h * ratio });
    svg.setAttribute("viewBox", `0 0 ${w} ${h}`);
    if (last) draw(...last);
  };
  for (const layer in layers) {
    const button = htmlElement("button", { type: "button" }, element("layers"));
    button.textContent = layers[layer];
    button.dataset.layer = layer;
    button.setAttribute("aria-pressed", String(layer === shown));
    button.addEventListener("click", () => {
      shown = layer;
      for (const each of element("layers").children)
        each.setAttribute("aria-pressed", String(each === button));
      if (last) draw(...last);
    });
  }
  box.addEventListener("click", (event) => {
    const from = canvas.getBoundingClientRect();
    const x = extent.x0 + (event.clientX - from.left) / scale;
    const y = extent.y0 + extent.height - (event.clientY - from.top) / scale;
    moveCut(axis.of(x, y));
  });
  return { draw, fit };
};
