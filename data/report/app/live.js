// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// A page that follows its job by the events of plan-site show --serve.

(() => {
  const chartsEvery = 1000; // ms; they are made anew
  const note = htmlElement("p", { className: "origin", id: "live" }, document.querySelector("header"));
  const say = (text) => {
    if (note.textContent !== text) note.textContent = text;
  };
  let rows = "";
  let state = null;
  let drawing = false;
  let chartsAt = 0;
  let chartsTimer = 0;

  const rebuildCharts = () => {
    chartsTimer = 0;
    chartsAt = performance.now();
    page.rebuildCharts();
  };
  const draw = () => {
    drawing = false;
    if (rows) {
      page.grow(rows);
      rows = "";
      const wait = chartsAt + chartsEvery - performance.now();
      if (!chartsTimer) chartsTimer = setTimeout(rebuildCharts, Math.max(0, wait));
    }
    if (!state) return;
    const verdict = document.querySelector("header .verdict");
    if (verdict) verdict.outerHTML = state.verdict;
    document.querySelector(".headline").innerHTML = state.headline;
    document.querySelector("#figures .columns").innerHTML = state.figures;
    element("result").textContent = state.result;
    state = null;
  };
  // However many come, as often as the browser draws.
  const ask = () => {
    if (drawing) return;
    drawing = true;
    requestAnimationFrame(draw);
  };

  const source = new EventSource(`${scene.stream}&steps=${lastStep}`);
  const live = { messages: 0 };
  const on = (name, take) =>
    source.addEventListener(name, (message) => {
      ++live.messages;
      take(JSON.parse(message.data));
    });
  on("step", ({ event, row }) => {
    addStep(event);
    rows += row;
    ask();
  });
  on("state", (now) => {
    state = now;
    ask();
  });
  on("reload", () => location.reload());
  source.addEventListener("open", () => say("Live"));
  source.addEventListener("error", () =>
    say(source.readyState === EventSource.CLOSED ? "No longer served" : "Not connected; trying again"),
  );
  globalThis.excavplanReport.live = live;
})();
