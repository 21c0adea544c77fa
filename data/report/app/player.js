// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The slider of time or of steps: where it ends, how far it goes a second, what a time is called,
// and what is shown at it.

const makePlayer = ({ end, pace, text, show }) => {
  const slider = element("time");
  let time = 0;
  let frame = 0;

  const set = (value) => {
    time = Math.min(Math.max(value, 0), end());
    show(time);
    element("now").textContent = text(time);
    slider.value = time;
    slider.setAttribute("aria-valuetext", text(time));
  };
  const stop = () => {
    cancelAnimationFrame(frame);
    frame = 0;
    element("play").textContent = "▶";
    element("play").setAttribute("aria-label", "Play");
  };
  const start = () => {
    if (time >= end() - 1e-6) set(0);
    element("play").textContent = "❚❚";
    element("play").setAttribute("aria-label", "Pause");
    let last = performance.now();
    let exact = time;
    const step = (now) => {
      exact += (pace * Math.min(now - last, 100)) / 1000;
      last = now;
      set(exact);
      if (time >= end()) stop();
      else frame = requestAnimationFrame(step);
    };
    frame = requestAnimationFrame(step);
  };
  const toggle = () => (frame ? stop() : start());

  element("play").addEventListener("click", toggle);
  slider.addEventListener("input", () => {
    stop();
    set(Number(slider.value));
  });
  document.addEventListener("keydown", (event) => {
    if (event.key !== " " || event.target.closest("button, summary, select, a, textarea")) return;
    event.preventDefault();
    toggle();
  });
  return {
    set,
    time: () => time,
    // After another end.
    fit: () => {
      slider.max = end();
      set(time);
    },
  };
};

// Calls back when the width of the scene has changed.
const onWidth = (changed) => {
  let width = 0;
  new ResizeObserver(() => {
    if (printing || element("scene").clientWidth === width) return;
    width = element("scene").clientWidth;
    changed();
  }).observe(element("scene"));
};
