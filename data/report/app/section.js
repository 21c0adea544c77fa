// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The section in the boom plane.

const makeSection = () => {
  const svg = element("profile");
  let draw = null; // places of what moves

  const profileOf = (state) => (x) => {
    for (const area of areas) {
      const z = heightAt(area, area.states[state], x, 0);
      if (!Number.isNaN(z)) return z;
    }
    return NaN;
  };

  const extentOf = () => {
    const box = { x0: dig.start_x_m, x1: dig.start_x_m, z0: dig.ground_z_m, z1: dig.ground_z_m };
    const add = (p) => {
      box.x0 = Math.min(box.x0, p[0]);
      box.x1 = Math.max(box.x1, p[0]);
      box.z0 = Math.min(box.z0, p[1]);
      box.z1 = Math.max(box.z1, p[1]);
    };
    dig.time_s.forEach((_, i) => {
      const posture = postureOf(dig.joints_rad.map((list) => list[i]));
      add(posture.tip);
      for (const corner of machine.profile_m) add(bucketPoint(posture, corner));
    });
    return { x0: box.x0 - 0.4, x1: box.x1 + 0.4, z0: box.z0 - 0.3, z1: box.z1 + 0.15 };
  };

  const lay = () => {
    const box = extentOf();
    const width = Math.max(280, svg.parentElement.clientWidth - 2);
    const left = 46;
    const bottom = 38;
    const scale = (width - left - 14) / (box.x1 - box.x0);
    // Beside the view in three dimensions, as tall as that.
    const stage = element("stage");
    const beside =
      stage.clientWidth > 0 && stage.clientWidth < 0.8 * element("scene").clientWidth && !printing;
    if (beside) box.z1 = Math.max(box.z1, box.z0 + (stage.clientHeight - bottom - 14) / scale);
    const height = Math.round(scale * (box.z1 - box.z0) + bottom + 12);
    const X = (x) => left + scale * (x - box.x0);
    const Z = (z) => 12 + scale * (box.z1 - z);
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.style.height = `${height}px`;
    const clip = svgElement("clipPath", { id: "inside" }, svgElement("defs", {}, svg));
    svgElement(
      "rect",
      { x: left, y: 12, width: width - left - 14, height: height - bottom - 12 },
      clip,
    );
    const xs = ticks(box.x0, box.x1, Math.min(12, width / 50));
    const zs = ticks(box.z0, box.z1, Math.max(3, Math.min(9, height / 40)));
    const line = (x0, y0, x1, y1) =>
      svgElement("line", { x1: x0, y1: y0, x2: x1, y2: y1, stroke: "var(--line)" }, svg);
    for (const x of xs.list) {
      line(X(x), 12, X(x), height - bottom);
      svgElement(
        "text",
        { x: X(x), y: height - bottom + 15, "text-anchor": "middle" },
        svg,
      ).textContent = signed(x, xs.digits);
    }
    for (const z of zs.list) {
      line(left, Z(z), width - 14, Z(z));
      svgElement("text", { x: left - 6, y: Z(z) + 4, "text-anchor": "end" }, svg).textContent =
        signed(z, zs.digits);
    }
    svgElement(
      "text",
      { x: (left + width) / 2, y: height - 6, "text-anchor": "middle" },
      svg,
    ).textContent = "x, from the swing axis [m]";
    svgElement(
      "text",
      {
        x: 12,
        y: 10 + (height - bottom) / 2,
        "text-anchor": "middle",
        transform: `rotate(-90 12 ${10 + (height - bottom) / 2})`,
      },
      svg,
    ).textContent = "z [m]";
    const inside = svgElement("g", { "clip-path": "url(#inside)" }, svg);

    const soil = (state, fill, edge, thick) => {
      const height0 = profileOf(state);
      let stretch = [];
      const close = () => {
        if (stretch.length > 1) {
          const top = stretch.map(([x, z]) => `${X(x).toFixed(1)},${Z(z).toFixed(1)}`).join(" ");
          const base = Z(box.z0).toFixed(1);
          svgElement(
            "polygon",
            {
              points: `${X(stretch[0][0]).toFixed(1)},${base} ${top} ${X(stretch[stretch.length - 1][0]).toFixed(1)},${base}`,
              fill: `var(--${fill})`,
              stroke: "none",
            },
            inside,
          );
          svgElement(
            "polyline",
            { points: top, fill: "none", stroke: `var(--${edge})`, "stroke-width": thick },
            inside,
          );
        }
        stretch = [];
      };
      for (let i = 0; i <= 500; ++i) {
        const x = box.x0 + ((box.x1 - box.x0) * i) / 500;
        const z = height0(x);
        if (Number.isNaN(z)) close();
        else stretch.push([x, z]);
      }
      close();
    };
    if (areas.length) soil(0, "soil-before", "edge-before", 1.2);
    if (lastState() > 0) soil(lastState(), "soil-after", "edge-after", 1.8);

    let stretch = [];
    const flush = (phase) => {
      svgElement(
        "polyline",
        {
          points: stretch.join(" "),
          fill: "none",
          stroke: `var(--${phase})`,
          "stroke-width": 2.2,
          "stroke-linejoin": "round",
        },
        inside,
      );
    };
    dig.time_s.forEach((_, i) => {
      const point = `${X(dig.tip_x_m[i]).toFixed(1)},${Z(dig.tip_z_m[i]).toFixed(1)}`;
      if (i > 0 && dig.phase[i] !== dig.phase[i - 1] && stretch.length > 1) {
        flush(dig.phase[i - 1]);
        stretch = [stretch[stretch.length - 1]];
      }
      stretch.push(point);
    });
    flush(dig.phase[dig.phase.length - 1]);

    draw = {
      X,
      Z,
      links: svgElement(
        "polyline",
        {
          fill: "none",
          stroke: "var(--steel)",
          "stroke-width": Math.max(4, 0.12 * scale),
          "stroke-linecap": "round",
          "stroke-linejoin": "round",
          opacity: 0.45,
        },
        inside,
      ),
      soil: svgElement(
        "polygon",
        { fill: "var(--soil-after)", stroke: "var(--edge-after)", "stroke-width": 1 },
        inside,
      ),
      bucket: svgElement(
        "polyline",
        {
          id: "bucket",
          fill: "none",
          stroke: "var(--ink)",
          "stroke-width": 2.4,
          "stroke-linejoin": "round",
        },
        inside,
      ),
      tip: svgElement("circle", { id: "tip", r: 4, fill: "var(--ink)" }, inside),
    };
  };

  const key = () => {
    const node = element("profile-key");
    node.replaceChildren();
    const entry = (text, colour, area) => {
      const item = htmlElement("span", {}, node);
      const swatch = htmlElement("i", { className: area ? "area" : "" }, item);
      swatch.style.background = `var(--${colour})`;
      if (area) swatch.style.borderColor = `var(--${area})`;
      item.append(text);
    };
    if (areas.length) entry(`ground ${areas[0].names[0]}`, "soil-before", "edge-before");
    if (lastState() > 0) entry(`ground ${areas[0].names[lastState()]}`, "soil-after", "edge-after");
    for (const phase of [...new Set(dig.phase)]) entry(`tip, ${phase}`, phase);
    htmlElement("b", { id: "tip-text" }, node);
  };

  const pose = (joints, fill) => {
    const posture = postureOf(joints);
    const { X, Z } = draw;
    const points = (list) =>
      list.map((p) => `${X(p[0]).toFixed(2)},${Z(p[1]).toFixed(2)}`).join(" ");
    draw.links.setAttribute("points", points([posture.boomPin, posture.armPin, posture.bucketPin]));
    draw.bucket.setAttribute(
      "points",
      points(
        machine.profile_m.length
          ? machine.profile_m.map((p) => bucketPoint(posture, p))
          : [posture.bucketPin, posture.tip],
      ),
    );
    draw.soil.setAttribute(
      "points",
      points(soilInBucket(fill).map((p) => bucketPoint(posture, p))),
    );
    draw.tip.setAttribute("cx", X(posture.tip[0]).toFixed(2));
    draw.tip.setAttribute("cy", Z(posture.tip[1]).toFixed(2));
    draw.tip.dataset.x = posture.tip[0];
    draw.tip.dataset.z = posture.tip[1];
    element("tip-text").textContent =
      `tip at x ${signed(posture.tip[0], 2)} m, z ${signed(posture.tip[1], 2)} m` +
      (fill > 0 ? `; ${signed(fill, 3)} m³ in the bucket` : "");
  };

  return {
    lay: () => {
      lay();
      key();
    },
    pose,
  };
};
