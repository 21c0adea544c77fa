// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// Colours of heights and of their change.

const rgb = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16) / 255);
const mix = (stops, share) => {
  if (Number.isNaN(share)) return still;
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(at), stops.length - 2);
  return stops[i].map((value, k) => value + (at - i) * (stops[i + 1][k] - value));
};
const still = rgb("#cfc7ba");
const soilRamp = ["#5d4a3a", "#937354", "#c0a17a", "#dec8a5", "#f4ebda"].map(rgb);
const fell = ["#f6d9cb", "#f4a582", "#d6604d", "#b2182b", "#67001f"].map(rgb);
const rose = ["#d6e7f1", "#92c5de", "#4393c3", "#2166ac", "#053061"].map(rgb);
const changeBounds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];

// Of heights but for outliers, such as walls and masts beside the soil, and the bounds of the bands
// of change: of states of the ground, each with that before it.
const rangeOf = (pairs) => {
  const heights = [];
  let change = 0;
  for (const [z, before] of pairs) {
    for (let i = 0; i < z.length; ++i) {
      if (Number.isNaN(z[i])) continue;
      heights.push(z[i]);
      change = Math.max(change, Math.abs(z[i] - before[i]) || 0);
    }
  }
  const sorted = Float64Array.from(heights).sort();
  const at = (share) => (sorted.length ? sorted[Math.round(share * (sorted.length - 1))] : 0);
  const [lowest, low, high, highest] = [0, 0.02, 0.98, 1].map(at);
  const clipped = highest - lowest > 2 * (high - low) && high - low > 0.2;
  const bands = changeBounds.filter((bound, i) => i === 0 || bound < change);
  return { low: clipped ? low : lowest, high: clipped ? high : highest, clipped, bands };
};

const heightColour = (range, z) =>
  mix(soilRamp, range.high - range.low < 1e-3 ? 0.5 : (z - range.low) / (range.high - range.low));
// Bands of 1, 2, 5, 10 cm and so on, so that centimetres show beside decimetres.
const changeColour = (range, change) => {
  const band = range.bands.filter((bound) => Math.abs(change) >= bound).length;
  if (!(band > 0)) return still;
  return mix(
    change < 0 ? fell : rose,
    range.bands.length > 1 ? (band - 1) / (range.bands.length - 1) : 1,
  );
};

const css = (colour) => `rgb(${colour.map((value) => Math.round(255 * value)).join(",")})`;

// Of ground over its design: within the tolerance, then to 2, 4, 8 times of it and beyond.
const errorBounds = [1, 2, 4, 8];
const within = rgb("#dfeadb");
const errorColour = (tolerance, error) => {
  if (Number.isNaN(error)) return still;
  const band = errorBounds.filter((bound) => Math.abs(error) > bound * tolerance).length;
  return band === 0 ? within : (error > 0 ? fell : rose)[band];
};
// From just now to long ago.
const ageRamp = ["#f4e61e", "#5ec962", "#21908d", "#3b528b", "#440154"].map(rgb);
