// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// Legends: a ramp of colours with its numbers.

const beginLegend = (title) => {
  const node = element("legend");
  node.replaceChildren();
  node.hidden = false;
  htmlElement("div", { textContent: title }, node);
  return node;
};

const addRamp = (node, stops, texts, kind) => {
  const ramp = htmlElement("div", { className: "ramp" }, node);
  htmlElement("i", {}, ramp).style.setProperty("--stops", stops.join(","));
  const list = htmlElement("div", { className: kind }, ramp);
  for (const text of texts) htmlElement("span", { textContent: text }, list);
  return ramp;
};

// Colours from the highest band down, with the numbers between them.
const addBands = (node, colours, texts) => {
  const share = (i) => `${((100 * i) / colours.length).toFixed(2)}%`;
  const stops = colours.map((c, i) => `${c} ${share(i)}, ${c} ${share(i + 1)}`);
  addRamp(node, stops, texts, "between").style.setProperty(
    "--length",
    `${colours.length * 15}px`,
  );
};

const changeLegend = (range) => {
  const node = beginLegend("height change [cm]");
  const up = range.bands.slice().reverse();
  const centimetres = (bound) => +(bound * 100).toFixed(0);
  addBands(
    node,
    [
      ...up.map((b) => css(changeColour(range, b * 1.001))),
      css(still),
      ...range.bands.map((b) => css(changeColour(range, -b * 1.001))),
    ],
    [
      ...up.map((b) => `+${centimetres(b)}`),
      ...range.bands.map((b) => `−${centimetres(b)}`),
    ],
  );
  return node;
};

const heightLegend = (range, contourStep) => {
  const node = beginLegend("height [m]");
  const beyond = range.clipped ? ["≥ ", "", "≤ "] : ["", "", ""];
  addRamp(
    node,
    [4, 3, 2, 1, 0].map((i) => css(soilRamp[i])),
    [1, 0.5, 0].map(
      (share, i) => beyond[i] + signed(range.low + share * (range.high - range.low), 2),
    ),
    "",
  );
  htmlElement("div", { textContent: `lines every ${+contourStep.toFixed(2)} m` }, node);
  return node;
};

const errorLegend = (tolerance) => {
  const node = beginLegend("ground over design [cm]");
  const up = errorBounds.slice().reverse();
  const colour = (factor) => css(errorColour(tolerance, factor * tolerance * 1.001));
  const centimetres = (bound) => +(100 * bound * tolerance).toFixed(1);
  addBands(
    node,
    [...up.map(colour), css(within), ...errorBounds.map((bound) => colour(-bound))],
    [
      ...up.map((bound) => `+${centimetres(bound)}`),
      ...errorBounds.map((bound) => `−${centimetres(bound)}`),
    ],
  );
  return node;
};
