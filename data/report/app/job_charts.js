// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The charts of a job, over its steps.

const jobCharts = () => {
  const steps = Array.from({ length: lastStep + 1 }, (_, i) => i);
  const single = (title, unit, digits, colour, values) => ({
    title,
    unit,
    digits,
    times: steps,
    highest: Math.max(...values.filter((value) => value !== null)),
    series: [{ name: "at this step", colour, values, at: (step) => values[step] }],
  });
  const taken = volumesLeft.map((left) => scene.design_m3 - left);
  const least = 0.02 * scene.design_m3; // of less the cost says nothing
  const list = [
    single("Volume of the design left", "m³", 2, "boom", volumesLeft),
    single("Time so far", "min", 1, "total", minutes),
  ];
  if (kilojoules[lastStep] > 0)
    list.push(
      single("Energy so far", "kJ", 0, "arm", kilojoules),
      single(
        "Energy per m³ of the design",
        "kJ/m³",
        0,
        "bucket",
        kilojoules.map((energy, i) => (taken[i] > least ? energy / taken[i] : null)),
      ),
    );
  const digs = events.map((event, i) => [event, i + 1]).filter(([event]) => digsIn(event));
  if (!digs.length) return list;
  const of = (value) => {
    const all = digs.map(([event]) => {
      const found = value(event);
      return found === undefined ? null : found;
    });
    const at = (step) => {
      const k = digs.findIndex(([, i]) => i === step);
      return k < 0 ? null : all[k];
    };
    return { values: all, at };
  };
  const interval = (k) =>
    of((event) => event.foretold_interval_kg && event.foretold_interval_kg[k]);
  const highest = Math.max(
    ...digs.flatMap(([event]) => [event.payload_kg || 0, 1.3 * (event.foretold_kg || 0)]),
  );
  const foretold = digs.some(([event]) => "foretold_kg" in event);
  list.push({
    title: "Payload of each dig",
    unit: "kg",
    digits: 0,
    times: digs.map(([, i]) => i),
    stays: true,
    wide: true,
    highest, // of a wide interval not all
    between: foretold ? [4, 3] : null,
    series: [
      { name: "done", colour: "arm", dots: true, ...of((event) => event.payload_kg) },
      ...(foretold
        ? [
            { name: "foretold", colour: "boom", ...of((event) => event.foretold_kg) },
            { name: "95 % from", colour: "boom", edge: true, ...interval(0) },
            { name: "to", colour: "boom", edge: true, ...interval(1) },
          ]
        : []),
    ],
  });
  return list;
};

// Moves and stalls behind the charts.
const jobMarks = () =>
  events
    .map((event, i) => [i + 1, event.stall ? "bad" : event.what === "move" ? "soft" : null])
    .filter(([, colour]) => colour);
