// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// Charts over time.

const chartsOf = () => {
  const joints = (lists, factor) =>
    ["boom", "arm", "bucket"].map((name, i) => ({
      name,
      colour: name,
      values: lists[i].map((v) => v * factor),
    }));
  const list = [
    {
      title: "Joint angles",
      unit: "°",
      digits: 1,
      times: dig.time_s,
      series: joints(dig.joints_rad, degrees),
    },
    {
      title: "Joint rates",
      unit: "°/s",
      digits: 1,
      times: dig.time_s,
      series: joints(dig.rates_rad_per_s, degrees),
    },
  ];
  const loads = dig.loads;
  if (!loads) return list;
  const size = loads.soil_x_kn.map((x, i) => Math.hypot(x, loads.soil_z_kn[i]));
  list.push(
    {
      title: "Joint torques",
      unit: "kN m",
      digits: 1,
      times: loads.time_s,
      series: joints(loads.torque_kn_m, 1),
    },
    {
      title: "Force of the soil on the bucket",
      unit: "kN",
      digits: 1,
      times: loads.time_s,
      series: [
        { name: "size", colour: "total", values: size },
        { name: "forward", colour: "boom", values: loads.soil_x_kn },
        { name: "up", colour: "arm", values: loads.soil_z_kn },
      ],
    },
    {
      title: "Power of the joints",
      unit: "kW",
      digits: 1,
      times: loads.time_s,
      series: [{ name: "power", colour: "total", values: loads.power_kw }],
    },
    {
      title: "Energy of the dig so far",
      stays: true,
      unit: "kJ",
      digits: 1,
      times: loads.energy_time_s,
      series: [{ name: "energy", colour: "total", values: loads.energy_kj }],
    },
    {
      title: "Soil in the bucket",
      stays: true,
      unit: "m³",
      digits: 3,
      times: loads.time_s,
      series: [{ name: "loose volume", colour: "total", values: loads.fill_m3 }],
    },
  );
  return list;
};

const makeCharts = (timeOf, setTime) => {
  const uPlot = globalThis.excavplanVendor.uPlot;
  let charts = [];

  const phases = () => {
    const list = [];
    dig.phase.forEach((phase, i) => {
      if (!list.length || list[list.length - 1].phase !== phase)
        list.push({ phase, from: dig.time_s[Math.max(0, i - 1)] });
      list[list.length - 1].to = dig.time_s[i];
    });
    return list;
  };

  const drawBands = (plot) => {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.fillStyle = theme().band;
    phases().forEach(({ from, to }, i) => {
      if (i % 2 === 0) return;
      const x0 = plot.valToPos(from, "x", true);
      ctx.fillRect(x0, bbox.top, plot.valToPos(to, "x", true) - x0, bbox.height);
    });
    ctx.restore();
  };
  const drawTime = (plot) => {
    const { ctx, bbox } = plot;
    const x = Math.round(plot.valToPos(timeOf(), "x", true)) + 0.5;
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
        scales: { x: { time: false, range: () => [0, dig.time_s[dig.time_s.length - 1]] } },
        axes: [
          { ...axis, size: 26, values: (_, list) => list.map((t) => `${t} s`) },
          { ...axis, size: 44 },
        ],
        series: [
          {},
          ...chart.series.map((series) => ({
            stroke: colours[series.colour],
            width: 1.8,
            points: { show: false },
          })),
        ],
        hooks: { drawClear: [drawBands], draw: [drawTime] },
      },
      [chart.times, ...chart.series.map((series) => series.values)],
      node,
    );
    const take = (event) =>
      setTime(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x"));
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
    charts = chartsOf().map((chart) => {
      const card = htmlElement("div", { className: "chart" }, parent);
      const title = htmlElement("h3", { textContent: chart.title + " " }, card);
      htmlElement("small", { textContent: `[${chart.unit}]` }, title);
      const key = htmlElement("p", { className: "key" }, card);
      const texts = chart.series.map((series) => {
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
        const time = timeOf();
        const last = chart.times[chart.times.length - 1];
        const beyond = !chart.stays && (time > last + 0.2 || time < chart.times[0] - 0.2);
        chart.texts[i].textContent = beyond
          ? "–"
          : signed(valueAt(chart.times, series.values, time), chart.digits);
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
