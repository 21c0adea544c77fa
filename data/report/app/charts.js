// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// Charts over time, or over steps: what they show, up to where, with which unit, whether in
// whole numbers; bands and marks behind them; the time now, and how to set it.
const makeCharts = ({ listed, end, unit, whole, bands, marks, now, set }) => {
  const uPlot = globalThis.excavplanVendor.uPlot;
  let charts = [];

  const drawBands = (plot) => {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.fillStyle = theme().band;
    bands().forEach(([from, to]) => {
      const x0 = plot.valToPos(from, "x", true);
      ctx.fillRect(x0, bbox.top, plot.valToPos(to, "x", true) - x0, bbox.height);
    });
    for (const [at, colour] of marks()) {
      const x = Math.round(plot.valToPos(at, "x", true)) + 0.5;
      ctx.strokeStyle = theme()[colour];
      ctx.globalAlpha = 0.5;
      ctx.setLineDash([4, 4]);
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
    }
    ctx.restore();
  };
  const drawTime = (plot) => {
    const { ctx, bbox } = plot;
    const x = Math.round(plot.valToPos(now(), "x", true)) + 0.5;
    ctx.save();
    ctx.strokeStyle = theme().ink;
    ctx.lineWidth = Math.max(1, devicePixelRatio || 1);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  };

  const make = (chart, node, width) => {
    const colours = theme();
    const axis = {
      stroke: colours.soft,
      font: "11px system-ui, sans-serif",
      labelFont: "11px system-ui, sans-serif",
      grid: { stroke: colours.line, width: 1 },
      ticks: { stroke: colours.line, width: 1, size: 4 },
      gap: 3,
    };
    const plot = new uPlot(
      {
        width,
        height: 168,
        legend: { show: false },
        cursor: {
          y: false,
          points: { show: false },
          drag: { setScale: false, x: false, y: false },
        },
        scales: {
          x: { time: false, range: () => [0, end()] },
          ...(chart.highest > 0 ? { y: { range: () => [0, 1.05 * chart.highest] } } : {}),
        },
        axes: [
          {
            ...axis,
            size: 26,
            ...(whole ? { incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000] } : {}),
            values: (_, list) => list.map((t) => `${t}${unit}`),
          },
          { ...axis, size: 44 },
        ],
        series: [
          {},
          ...chart.series.map((series) => ({
            stroke: colours[series.colour],
            width: series.dots ? 0 : series.edge ? 0.6 : 1.8,
            points: { show: Boolean(series.dots), size: 6, fill: colours[series.colour] },
          })),
        ],
        ...(chart.between ? { bands: [{ series: chart.between, fill: colours.interval }] } : {}),
        hooks: { drawClear: [drawBands], draw: [drawTime] },
      },
      [chart.times, ...chart.series.map((series) => series.values)],
      node,
    );
    const take = (event) =>
      set(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x"));
    plot.over.addEventListener("pointerdown", take);
    plot.over.addEventListener("pointermove", (event) => {
      if (event.buttons) take(event);
    });
    plot.over.style.touchAction = "pan-y";
    return plot;
  };

  const build = (width) => {
    const parent = element("charts");
    for (const { plot } of charts) plot.destroy();
    parent.replaceChildren();
    charts = listed().map((chart) => {
      const card = htmlElement("div", { className: chart.wide ? "chart wide" : "chart" }, parent);
      const title = htmlElement("h3", { textContent: chart.title + " " }, card);
      htmlElement("small", { textContent: `[${chart.unit}]` }, title);
      const key = htmlElement("p", { className: "key" }, card);
      const texts = chart.series.map((series) => {
        if (!series.name) return null;
        const item = htmlElement("span", {}, key);
        htmlElement("i", {}, item).style.background = `var(--${series.colour})`;
        item.append(series.name + " ");
        return htmlElement("b", {}, item);
      });
      return { ...chart, card, texts, box: htmlElement("div", {}, card) };
    });
    for (const chart of charts)
      chart.plot = make(chart, chart.box, width || Math.max(200, chart.card.clientWidth - 24));
  };

  const update = () => {
    for (const chart of charts) {
      chart.plot.redraw(false, false);
      chart.series.forEach((series, i) => {
        if (!chart.texts[i]) return;
        const time = now();
        const last = chart.times[chart.times.length - 1];
        const beyond = !chart.stays && (time > last + 0.2 || time < chart.times[0] - 0.2);
        const value = series.at ? series.at(time) : valueAt(chart.times, series.values, time);
        chart.texts[i].textContent =
          beyond || value === null || Number.isNaN(value) ? "–" : signed(value, chart.digits);
      });
    }
  };
  return {
    build,
    update,
    fit: () =>
      charts.forEach((chart) =>
        chart.plot.setSize({ width: Math.max(200, chart.card.clientWidth - 24), height: 168 }),
      ),
  };
};
