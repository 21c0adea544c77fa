// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// What all parts of the page share: elements, numbers as texts, colours.

const element = (id) => document.getElementById(id);
const degrees = 180 / Math.PI;

const svgElement = (name, attributes, parent) => {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const key in attributes) node.setAttribute(key, attributes[key]);
  if (parent) parent.appendChild(node);
  return node;
};

const htmlElement = (name, attributes, parent) => {
  const node = Object.assign(document.createElement(name), attributes);
  if (parent) parent.appendChild(node);
  return node;
};

const signed = (value, digits) => {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text.replace("-", "−");
};

// Largest of 1, 2, 5, 10, ... times a power of ten that is at most `value`.
const roundStep = (value) => {
  const power = 10 ** Math.floor(Math.log10(value));
  return [10, 5, 2, 1].find((factor) => factor * power <= value * 1.0001) * power;
};

// At most `count` + 1 round values in low .. high.
const ticks = (low, high, count) => {
  const power = 10 ** Math.floor(Math.log10((high - low) / count));
  const step =
    [1, 2, 5, 10].find((factor) => factor * power >= ((high - low) / count) * 0.9999) * power;
  const list = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i)
    list.push(i * step);
  return { list, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
};

const dark = matchMedia("(prefers-color-scheme: dark)");
let printing = false;
// Colours of what is drawn on a canvas. On paper they are those of the light page.
const light = {
  card: "#ffffff",
  ink: "#1d2024",
  soft: "#5b626b",
  line: "#e4e1db",
  boom: "#0072b2",
  arm: "#b85000",
  bucket: "#00795a",
  total: "#1d2024",
  band: "rgba(91,98,107,0.07)",
  bad: "#a1221b",
  interval: "rgba(0,114,178,0.16)",
};
const theme = () => {
  if (printing || !dark.matches) return light;
  return {
    card: "#1d2126",
    ink: "#e7e5e0",
    soft: "#a3abb5",
    line: "#31363d",
    boom: "#58b4ee",
    arm: "#f0914a",
    bucket: "#42cda4",
    total: "#e7e5e0",
    band: "rgba(163,171,181,0.09)",
    bad: "#ff9d92",
    interval: "rgba(88,180,238,0.2)",
  };
};
