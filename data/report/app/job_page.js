// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// A page about a job.

const view = makeView();

const page = (() => {
  let pinned = null; // where the sections lie, once a click has said it
  let shown = -1;
  const cutAt = (step) => pinned || { along: dugAt[step], beside: 0 };
  const sections = makeJobSections();
  const rows = [...document.querySelectorAll("#steps tbody tr")];
  const list = document.querySelector("#steps .scroll");

  const markRow = (step) => {
    rows.forEach((row, i) => row.classList.toggle("now", i + 1 === step));
    const row = rows[step - 1];
    list.scrollTop = row ? row.offsetTop - list.clientHeight / 2 : 0;
  };
  const drawFlat = (step) => {
    map.draw(step, cutAt(step));
    sections.draw(step, cutAt(step));
  };
  const map = makeMap(([along, beside]) => {
    const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
    pinned = {
      along: clamp(along, 0, axis.length),
      beside: clamp(beside, -axis.half, axis.half),
    };
    drawFlat(shown);
  });
  element("reset").addEventListener("click", () => {
    pinned = null;
    drawFlat(shown);
  });

  const stepOf = (time) => Math.floor(time + 1e-6);
  let charts = null;
  const player = makePlayer({
    end: () => lastStep,
    pace: Math.max(3, lastStep / 30),
    text: (time) => {
      const step = stepOf(time);
      const event = events[step - 1];
      const what = event ? event.what + (event.stall ? ", stalled" : "") : "before";
      return `step ${step} of ${lastStep} · ${what}`;
    },
    show: (time) => {
      const step = stepOf(time);
      if (step === shown) return;
      shown = step;
      if (view) view.draw(step);
      drawFlat(step);
      markRow(step);
      if (charts) charts.update();
    },
  });
  charts = makeCharts({
    listed: jobCharts,
    end: () => Math.max(1, lastStep),
    unit: "",
    whole: true,
    bands: () => [],
    marks: jobMarks,
    now: () => stepOf(player.time()),
    set: (time) => player.set(Math.round(time)),
  });
  list.addEventListener("click", (event) => {
    const row = event.target.closest("tbody tr");
    if (row) player.set(rows.indexOf(row) + 1);
  });

  const key = element("charts-key");
  for (const [text, colour] of [
    ["moves", "soft"],
    ["stalls", "bad"],
  ])
    if (jobMarks().some((mark) => mark[1] === colour)) addKey(key, text, `var(--${colour})`);

  const redraw = (paperWidth) => {
    map.fit();
    charts.build(paperWidth);
    if (shown >= 0) drawFlat(shown);
    charts.update();
  };
  map.fit();
  charts.build();
  player.fit();
  player.set(lastStep);
  charts.update();
  onWidth(() => {
    map.fit();
    charts.fit();
    drawFlat(shown);
  });
  // After steps that came to those that there were.
  const grow = (html) => {
    const follows = shown === rows.length;
    const body = document.querySelector("#steps tbody");
    body.insertAdjacentHTML("beforeend", html);
    rows.push(...[...body.children].slice(rows.length));
    player.fit();
    if (follows) player.set(lastStep);
  };
  return {
    redraw,
    grow,
    rebuildCharts: () => {
      charts.build();
      charts.update();
    },
    setTime: player.set,
    time: player.time,
    // Heights that are drawn now, row by row [m].
    heights: () => Array.from(groundAt(shown).z),
  };
})();
