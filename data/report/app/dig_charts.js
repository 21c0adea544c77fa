// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The charts of a dig.

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

// Every other phase, as [from, to] in time.
const phaseBands = () => {
  const list = [];
  dig.phase.forEach((phase, i) => {
    if (!list.length || list[list.length - 1].phase !== phase)
      list.push({ phase, from: dig.time_s[Math.max(0, i - 1)] });
    list[list.length - 1].to = dig.time_s[i];
  });
  return list.filter((_, i) => i % 2).map(({ from, to }) => [from, to]);
};
