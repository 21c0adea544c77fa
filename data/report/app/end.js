// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// What every page does at its end: other colours and paper.

document.body.classList.toggle("drawn", view !== null);
element("view").hidden = view === null;
element("no-view").hidden = view !== null;

dark.addEventListener("change", () => {
  if (page) page.redraw();
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
  if (page) page.redraw(285);
});
addEventListener("afterprint", () => {
  printing = false;
  for (const id of ["stage", "marks"]) element(id).removeAttribute("style");
  if (page) page.redraw();
});

requestAnimationFrame(() =>
  requestAnimationFrame(() => {
    document.documentElement.dataset.drawnAfterMs = Math.round(performance.now());
  }),
);

// For tests and for the console of the browser.
globalThis.excavplanReport = page || { time: () => 0 };
