// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// Sections along the design and across it.

const makeJobSections = () => {
  const beyond = 1.2; // what is shown beside the design [m]
  const bases = { along: "along-section", across: "across-section" };
  const deepest = target.reduce((low, z) => (z < low ? z : low), range.low);
  const heights = { low: deepest - 0.15, high: Math.max(deepest + 0.4, range.high) + 0.15 };

  const draw = (name, box, placeAt, crossing, z) => {
    const svg = element(bases[name]);
    const width = Math.max(260, svg.parentElement.clientWidth - 2);
    const scaleX = (width - margins.left - margins.right) / (box.x1 - box.x0);
    const tall = Math.min(230, Math.max(150, 0.45 * width));
    const scaleZ = Math.max(0.2, tall / (box.z1 - box.z0));
    const factor = scaleZ / scaleX;
    const drawn = layAxes(svg, box, {
      width,
      scaleX,
      scaleZ,
      id: `${name}-inside`,
      title:
        (name === "along" ? "from the near end of the design [m]" : "left of its middle [m]") +
        ` · heights × ${factor.toFixed(factor < 10 ? 1 : 0)}`,
    });
    const profile = (layer) => (x) => heightAt(grid, layer, ...placeAt(x));
    drawSoil(drawn, box, profile(before), soilLooks.before);
    drawSoil(drawn, box, profile(z), soilLooks.after);
    const { X, Z, inside } = drawn;
    const points = (list) =>
      list.map(([x, h]) => `${X(x).toFixed(1)},${Z(h).toFixed(1)}`).join(" ");
    for (const stretch of stretchesOf(box, profile(target), 800)) {
      const band = [
        ...stretch.map(([x, h]) => [x, h + tolerance]),
        ...stretch.map(([x, h]) => [x, h - tolerance]).reverse(),
      ];
      svgElement("polygon", { points: points(band), fill: "var(--boom)", opacity: 0.25 }, inside);
      svgElement(
        "polyline",
        { points: points(stretch), fill: "none", stroke: "var(--boom)", "stroke-width": 1.6 },
        inside,
      );
    }
    const at = { x1: X(crossing), x2: X(crossing), y1: Z(box.z1), y2: Z(box.z0) };
    svgElement("line", { ...at, stroke: "var(--ink)", "stroke-dasharray": "7 4" }, inside);
  };

  const key = () => {
    const node = element("section-key");
    node.replaceChildren();
    addKey(node, "ground before", "var(--soil-before)", "var(--edge-before)");
    addKey(node, "ground at this step", "var(--soil-after)", "var(--edge-after)");
    addKey(node, `design ± ${+(100 * tolerance).toFixed(1)} cm`, "var(--boom)");
  };
  key();

  return {
    draw: (step, cut) => {
      const { z } = groundAt(step);
      const levels = { z0: heights.low, z1: heights.high };
      draw(
        "along",
        { x0: -beyond, x1: axis.length + beyond, ...levels },
        (x) => axis.place(x, cut.beside),
        cut.along,
        z,
      );
      draw(
        "across",
        { x0: -axis.half - beyond, x1: axis.half + beyond, ...levels },
        (x) => axis.place(cut.along, x),
        cut.beside,
        z,
      );
    },
  };
};
