// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The slider of time, and what starts the page.

const playable = machine && dig && dig.time_s.length > 1;
element("scene").classList.toggle("played", Boolean(playable));

const view = makeView();
document.body.classList.toggle("drawn", view !== null);
element("view").hidden = view === null;
element("no-view").hidden = view !== null;
if (!machine) element("view-title").textContent = "Ground";

let time = 0;

const jointsAt = (t) => dig.joints_rad.map((list) => valueAt(dig.time_s, list, t));
const fillAt = (t) =>
  dig.loads && dig.loads.time_s.length
    ? t < dig.loads.time_s[0]
      ? 0
      : valueAt(dig.loads.time_s, dig.loads.fill_m3, t)
    : 0;

const play = () => {
  const slider = element("time");
  const section = makeSection();
  let frame = 0;
  let charts = null;

  const show = () => {
    const joints = jointsAt(time);
    const fill = fillAt(time);
    if (view) view.pose(joints, fill);
    section.pose(joints, fill);
    charts.update();
    const [, at] = placeOf(dig.time_s, time);
    const text = `${time.toFixed(2)} s of ${dig.time_s[dig.time_s.length - 1].toFixed(2)} s`;
    element("now").textContent = `${text} · ${dig.phase[at]}`;
    slider.value = time;
    slider.setAttribute("aria-valuetext", `${text}, ${dig.phase[at]}`);
  };
  const setTime = (value) => {
    time = Math.min(Math.max(value, 0), dig.time_s[dig.time_s.length - 1]);
    show();
  };
  charts = makeCharts(() => time, setTime);

  const stop = () => {
    cancelAnimationFrame(frame);
    frame = 0;
    element("play").textContent = "▶";
    element("play").setAttribute("aria-label", "Play");
  };
  const start = () => {
    if (time >= dig.time_s[dig.time_s.length - 1] - 1e-6) setTime(0);
    element("play").textContent = "❚❚";
    element("play").setAttribute("aria-label", "Pause");
    let last = performance.now();
    const step = (now) => {
      setTime(time + Math.min(now - last, 100) / 1000);
      last = now;
      if (time >= dig.time_s[dig.time_s.length - 1]) stop();
      else frame = requestAnimationFrame(step);
    };
    frame = requestAnimationFrame(step);
  };
  const toggle = () => (frame ? stop() : start());

  element("play").addEventListener("click", toggle);
  slider.addEventListener("input", () => {
    stop();
    setTime(Number(slider.value));
  });
  document.addEventListener("keydown", (event) => {
    if (event.key !== " " || event.target.closest("button, summary, select, a, textarea")) return;
    event.preventDefault();
    toggle();
  });

  const choose = () => {
    slider.max = dig.time_s[dig.time_s.length - 1];
    section.lay();
    charts.build();
    setTime(Math.min(time, dig.time_s[dig.time_s.length - 1]));
  };
  if (scene.digs.length > 1) {
    const list = element("dig");
    scene.digs.forEach((each, i) =>
      htmlElement("option", { value: i, textContent: each.name }, list),
    );
    element("dig-choice").hidden = false;
    list.addEventListener("change", () => {
      dig = scene.digs[Number(list.value)];
      if (view) view.changed();
      choose();
    });
  }
  for (const id of ["section", "charts", "player"]) element(id).hidden = false;
  choose();

  let width = 0;
  new ResizeObserver(() => {
    if (printing || element("scene").clientWidth === width) return;
    width = element("scene").clientWidth;
    section.lay();
    charts.fit();
    show();
  }).observe(element("scene"));
  return {
    redraw: (paperWidth) => {
      section.lay();
      charts.build(paperWidth);
      show();
    },
    setTime,
  };
};
const player = playable ? play() : null;
if (!playable && view && machine && !dig) view.pose([-0.4, 1.5, 1.2], 0);

// ---- Page -------------------------------------------------------------------------------------

dark.addEventListener("change", () => {
  if (player) player.redraw();
});
// On paper the view is the picture that is on the screen, scaled: a canvas drawn anew is not yet
// there when the browser prints.
const fitPaper = () => {
  const stage = element("stage");
  const [width, height] = [stage.clientWidth, stage.clientHeight];
  const scale = 650 / width;
  Object.assign(stage.style, { width: "650px", height: `${height * scale}px` });
  Object.assign(element("marks").style, {
    width: `${width}px`,
    height: `${height}px`,
    transformOrigin: "0 0",
    transform: `scale(${scale})`,
  });
};
addEventListener("beforeprint", () => {
  printing = true;
  if (view) fitPaper();
  if (player) player.redraw(285);
});
addEventListener("afterprint", () => {
  printing = false;
  for (const id of ["stage", "marks"]) element(id).removeAttribute("style");
  if (player) player.redraw();
});

element("copy").addEventListener("click", () => {
  const range = document.createRange();
  range.selectNodeContents(element("result"));
  getSelection().removeAllRanges();
  getSelection().addRange(range);
  element("copy").textContent = document.execCommand("copy")
    ? "Copied"
    : "Selected: copy with Ctrl+C";
});

requestAnimationFrame(() =>
  requestAnimationFrame(() => {
    document.documentElement.dataset.drawnAfterMs = Math.round(performance.now());
  }),
);

// For tests and for the console of the browser.
globalThis.excavplanReport = {
  setTime: player && player.setTime,
  tip: view && player ? view.tip : null,
  time: () => time,
};
