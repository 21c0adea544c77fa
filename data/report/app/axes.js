// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// Sections through the ground: axes, soil and their key.

const margins = { left: 46, right: 14, top: 12, bottom: 38 };

// Axes around the box of a section, x0 .. x1 and z0 .. z1, at so many pixels a metre.
const layAxes = (svg, box, { width, scaleX, scaleZ, id, title }) => {
  const { left, right, top, bottom } = margins;
  const height = Math.round(scaleZ * (box.z1 - box.z0) + bottom + top);
  const X = (x) => left + scaleX * (x - box.x0);
  const Z = (z) => top + scaleZ * (box.z1 - z);
  svg.replaceChildren();
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.style.height = `${height}px`;
  const clip = svgElement("clipPath", { id }, svgElement("defs", {}, svg));
  svgElement(
    "rect",
    { x: left, y: top, width: width - left - right, height: height - bottom - top },
    clip,
  );
  const xs = ticks(box.x0, box.x1, Math.min(12, width / 50));
  const zs = ticks(box.z0, box.z1, Math.max(3, Math.min(9, height / 40)));
  const line = (x0, y0, x1, y1) =>
    svgElement("line", { x1: x0, y1: y0, x2: x1, y2: y1, stroke: "var(--line)" }, svg);
  const text = (string, attributes) => {
    svgElement("text", attributes, svg).textContent = string;
  };
  for (const x of xs.list) {
    line(X(x), top, X(x), height - bottom);
    text(signed(x, xs.digits), { x: X(x), y: height - bottom + 15, "text-anchor": "middle" });
  }
  for (const z of zs.list) {
    line(left, Z(z), width - right, Z(z));
    text(signed(z, zs.digits), { x: left - 6, y: Z(z) + 4, "text-anchor": "end" });
  }
  text(title, { x: (left + width) / 2, y: height - 6, "text-anchor": "middle" });
  const middle = 10 + (height - bottom) / 2;
  text("z [m]", {
    x: 12,
    y: middle,
    "text-anchor": "middle",
    transform: `rotate(-90 12 ${middle})`,
  });
  return { X, Z, inside: svgElement("g", { "clip-path": `url(#${id})` }, svg) };
};

const soilLooks = {
  before: { fill: "soil-before", edge: "edge-before", thick: 1.2 },
  after: { fill: "soil-after", edge: "edge-after", thick: 1.8 },
};

// A profile in stretches of known heights.
const stretchesOf = (box, height, count) => {
  const stretches = [[]];
  for (let i = 0; i <= count; ++i) {
    const x = box.x0 + ((box.x1 - box.x0) * i) / count;
    const z = height(x);
    if (!Number.isNaN(z)) stretches[stretches.length - 1].push([x, z]);
    else if (stretches[stretches.length - 1].length) stretches.push([]);
  }
  return stretches.filter((stretch) => stretch.length > 1);
};

const drawSoil = ({ X, Z, inside }, box, height, { fill, edge, thick }) => {
  const base = Z(box.z0).toFixed(1);
  for (const stretch of stretchesOf(box, height, 500)) {
    const top = stretch.map(([x, z]) => `${X(x).toFixed(1)},${Z(z).toFixed(1)}`).join(" ");
    const [from, to] = [stretch[0], stretch[stretch.length - 1]].map(([x]) => X(x).toFixed(1));
    svgElement(
      "polygon",
      { points: `${from},${base} ${top} ${to},${base}`, fill: `var(--${fill})`, stroke: "none" },
      inside,
    );
    svgElement(
      "polyline",
      { points: top, fill: "none", stroke: `var(--${edge})`, "stroke-width": thick },
      inside,
    );
  }
};

// An entry of the key of a figure: a swatch, and what it stands for.
const addKey = (node, text, colour, area) => {
  const item = htmlElement("span", {}, node);
  const swatch = htmlElement("i", { className: area ? "area" : "" }, item);
  swatch.style.background = colour;
  if (area) swatch.style.borderColor = area;
  item.append(text);
  return item;
};
