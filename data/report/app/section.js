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
    const scale = (width - margins.left - margins.right) / (box.x1 - box.x0);
    // Beside the view in three dimensions, as tall as that.
    const stage = element("stage");
    const beside =
      stage.clientWidth > 0 && stage.clientWidth < 0.8 * element("scene").clientWidth && !printing;
    if (beside) {
      box.z1 = Math.max(box.z1, box.z0 + (stage.clientHeight - margins.bottom - 14) / scale);
    }
    const { X, Z, inside } = layAxes(svg, box, {
      width,
      scaleX: scale,
      scaleZ: scale,
      id: "inside",
      title: "x, from the swing axis [m]",
    });

    const soil = (state, look) => drawSoil({ X, Z, inside }, box, profileOf(state), look);
    if (areas.length) soil(0, soilLooks.before);
    if (lastState() > 0) soil(lastState(), soilLooks.after);

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
    const entry = (text, colour, area) =>
      addKey(node, text, `var(--${colour})`, area && `var(--${area})`);
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
