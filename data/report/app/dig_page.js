// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// A page about digs.

const playable = machine && dig && dig.time_s.length > 1;
element("scene").classList.toggle("played", Boolean(playable));

const view = makeView();
if (!machine) element("view-title").textContent = "Ground";

const jointsAt = (t) => dig.joints_rad.map((list) => valueAt(dig.time_s, list, t));
const fillAt = (t) =>
  dig.loads && dig.loads.time_s.length
    ? t < dig.loads.time_s[0]
      ? 0
      : valueAt(dig.loads.time_s, dig.loads.fill_m3, t)
    : 0;

const play = () => {
  const section = makeSection();
  const end = () => dig.time_s[dig.time_s.length - 1];
  let charts = null;
  const player = makePlayer({
    end,
    pace: 1,
    text: (time) =>
      `${time.toFixed(2)} s of ${end().toFixed(2)} s · ${dig.phase[placeOf(dig.time_s, time)[1]]}`,
    show: (time) => {
      const [joints, fill] = [jointsAt(time), fillAt(time)];
      if (view) view.pose(joints, fill);
      section.pose(joints, fill);
      charts.update(time);
    },
  });
  charts = makeCharts({
    listed: chartsOf,
    end,
    unit: " s",
    bands: phaseBands,
    marks: () => [],
    now: player.time,
    set: player.set,
  });

  const choose = () => {
    section.lay();
    charts.build();
    player.fit();
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
  onWidth(() => {
    section.lay();
    charts.fit();
    player.set(player.time());
  });
  return {
    redraw: (paperWidth) => {
      section.lay();
      charts.build(paperWidth);
      player.set(player.time());
    },
    setTime: player.set,
    time: player.time,
    tip: view ? view.tip : null,
  };
};
const page = playable ? play() : null;
if (!playable && view && machine && !dig) view.pose([-0.4, 1.5, 1.2], 0);
