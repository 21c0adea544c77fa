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
  const polygon = (corners, attributes) =>
    svgElement("polygon", { points: corners.map(point).join(" "), fill: "none", ...attributes }, svg);
  const text = (string, [x, y], attributes) => {
    const node = svgElement("text", { x: X(x), y: Y(y), "text-anchor": "middle", ...attributes }, svg);
    node.textContent = string;
  };
  const footprint = (() => {
    const parts = [];
    const inside = (row, col) =>
      row >= 0 && col >= 0 && row < grid.rows && col < grid.cols && !Number.isNaN(target[row * grid.cols + col]);
    for (let row = 0; row <= grid.rows; ++row)
      for (let col = 0; col <= grid.cols; ++col) {
        const [x, y] = [extent.x0 + col * grid.cell, extent.y0 + row * grid.cell];
        if (inside(row, col) !== inside(row - 1, col)) parts.push([[x, y], [x + grid.cell, y]]);
        if (inside(row, col) !== inside(row, col - 1)) parts.push([[x, y], [x, y + grid.cell]]);
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
      if (X(x) > 24 && X(x) < w - 24) text(signed(x, xs.digits), [x, extent.y0 + 9 / scale], {});
    }
    for (const y of ys.list) {
      line(0, Y(y), 5, Y(y));
      if (Y(y) > 14 && Y(y) < h - 26)
        text(signed(y, ys.digits), [extent.x0 + 8 / scale, y - 4 / scale], { "text-anchor": "start" });
    }
  };
  const machineOn = (step) => {
    for (let i = 1; i <= step; ++i) {
      if (events[i - 1].what !== "move") continue;
      const [from, to] = [baseAt(i - 1), baseAt(i)];
      svgElement(
        "line",
        { x1: X(from[0]), y1: Y(from[1]), x2: X(to[0]), y2: Y(to[1]), stroke: "#3a3e44", "stroke-dasharray": "3 3" },
        svg,
      );
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
    const path = footprint.map((part) => `M${point(part[0])}L${point(part[1])}`).join("");
    svgElement("path", { d: path, stroke: "#00528c", "stroke-width": 1.4, fill: "none" }, svg);
    for (const area of scene.design.dump_areas) {
      polygon(area.polygon, { stroke: "#b36b00", "stroke-width": 1.6 });
      text(area.kind, middleOf(area.polygon), { class: "on-map" });
    }
    for (const area of scene.design.keep_out) {
      polygon(area.polygon, { stroke: "#b2182b", "stroke-width": 1.6, fill: "rgba(178,24,43,0.14)" });
      const [x, y] = highest(area.polygon);
      text(`keep out${area.kind ? `: ${area.kind}` : ""}`, [x, y + 4 / scale], { class: "on-map" });
    }
    for (const each of scene.design.obstacles) {
      polygon(each.polygon, { stroke: "#3a3e44", fill: "rgba(90,95,102,0.7)" });
      const [x, y] = highest(each.polygon);
      text(each.kind || "obstacle", [x, y + 4 / scale], { class: "on-map" });
    }
    if (scene.design.truck) {
      polygon(scene.design.truck.polygon, { stroke: "#33567a", fill: "rgba(77,120,163,0.5)" });
      text("truck", middleOf(scene.design.truck.polygon), { class: "on-map" });
    }
    machineOn(step);
    dumpOn(step);
    const reach = 1.5;
    for (const [a0, b0, a1, b1] of [
      [-reach, cut.beside, axis.length + reach, cut.beside],
      [cut.along, -axis.half - 2 * reach, cut.along, axis.half + 2 * reach],
    ]) {
      const [p, q] = [axis.place(a0, b0), axis.place(a1, b1)];
      const [x1, y1, x2, y2] = [X(p[0]), Y(p[1]), X(q[0]), Y(q[1])];
      const at = { x1, y1, x2, y2, "stroke-dasharray": "7 4" };
      svgElement("line", { ...at, stroke: "#ffffff", "stroke-width": 3, opacity: 0.7 }, svg);
      svgElement("line", { ...at, stroke: "#1d2024" }, svg);
    }
    edges();
  };

  const key = (step) => {
    const node = element("map-key");
    node.replaceChildren();
    if (shown === "age") {
      for (const share of [0, 0.25, 0.5, 0.75, 1])
        addKey(node, `${(share * minutes[step]).toFixed(0)} min ago`, css(mix(ageRamp, share)), css(mix(ageRamp, share)));
      addKey(node, "never seen", "#ffffff", "var(--soft)");
      return;
    }
    const centimetres = (factor) => +(100 * factor * tolerance).toFixed(1);
    const entry = (text, factor) => {
      const colour = css(errorColour(tolerance, factor * tolerance));
      addKey(node, text, colour, "var(--line)");
    };
    const bounds = errorBounds;
    bounds
      .map((bound, k) => [bound, bounds[k + 1]])
      .reverse()
      .forEach(([bound, next]) =>
        entry(next ? `+${centimetres(bound)} .. ${centimetres(next)}` : `over +${centimetres(bound)} cm`, bound * 1.01),
      );
    entry(`within ±${centimetres(1)}`, 0);
    bounds.forEach((bound, k) =>
      entry(
        bounds[k + 1] ? `−${centimetres(bound)} .. ${centimetres(bounds[k + 1])}` : `below −${centimetres(bound)} cm`,
        -bound * 1.01,
      ),
    );
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
    const button = htmlElement("button", { type: "button", textContent: layers[layer] }, element("layers"));
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
