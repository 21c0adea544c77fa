// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The view in three dimensions: ground, machine and the path of the tip, with camera, marks, legend
// and controls.

const makeView = () => {
  const stage = makeStage();
  if (!stage) return null;
  const { T, world: tall, ask, mark } = stage;
  const ground = makeGround(T, tall);
  const { extent, floor, flat, contourStep, kinds } = ground;
  const model = machine ? makeMachineModel(T, tall) : null;

  // -- Path of the tip, in front of everything: two ribbons across each other
  const phaseColours = {
    approach: 0x8a8a8a,
    penetrate: 0xd55e00,
    drag: 0x2a86c8,
    scoop: 0x009e73,
    lift: 0xcc79a7,
  };
  let path = [];
  const ribbons = (stretch) => {
    const half = 0.018;
    const corners = [];
    for (const [a, b] of stretch) {
      const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
      const across = [(-(b[1] - a[1]) * half) / length, ((b[0] - a[0]) * half) / length];
      for (const [x, y, z] of [
        [across[0], 0, across[1]],
        [0, half, 0],
      ]) {
        const quad = [
          [a, 1],
          [b, 1],
          [b, -1],
          [a, 1],
          [b, -1],
          [a, -1],
        ];
        for (const [p, sign] of quad) corners.push(p[0] + sign * x, sign * y, p[1] + sign * z);
      }
    }
    return new Float32Array(corners);
  };
  const drawPath = () => {
    for (const mesh of path) {
      tall.remove(mesh);
      mesh.geometry.dispose();
    }
    path = [];
    if (!dig) return;
    const stretches = {};
    for (let i = 1; i < dig.time_s.length; ++i) {
      (stretches[dig.phase[i]] = stretches[dig.phase[i]] || []).push([
        [dig.tip_x_m[i - 1], dig.tip_z_m[i - 1]],
        [dig.tip_x_m[i], dig.tip_z_m[i]],
      ]);
    }
    for (const phase in stretches) {
      const geometry = new T.BufferGeometry();
      geometry.setAttribute("position", new T.BufferAttribute(ribbons(stretches[phase]), 3));
      const material = new T.MeshBasicMaterial({
        color: phaseColours[phase],
        side: T.DoubleSide,
        depthTest: false,
        transparent: true,
        opacity: 0.85,
      });
      const mesh = new T.Mesh(geometry, material);
      mesh.renderOrder = 5;
      tall.add(mesh);
      path.push(mesh);
    }
  };
  drawPath();

  // The longer side across; of ground that lies across, what the operator sees.
  const across = !machine && extent.y1 - extent.y0 > extent.x1 - extent.x0;
  const direction = across ? [-1, -0.35, 0.8] : [0.42, -1, machine ? 0.5 : 0.8];

  // -- Marks: lengths along the edges, volumes of the zones
  const makeMarks = () => {
    const span = Math.max(extent.x1 - extent.x0, extent.y1 - extent.y0);
    stage.markEdges(extent, floor, direction);
    const names = { dig: "hole", spill: "spill", dump: "heap", other: "left out" };
    const labelled = new Set(["other"]);
    for (const zone of [...scene.zones].sort((a, b) => b.volume_m3 - a.volume_m3)) {
      const [x0, y0, x1, y1] = zone.extent_m;
      if (labelled.has(zone.kind)) continue;
      labelled.add(zone.kind);
      const x = (x0 + x1) / 2;
      const y = zone.kind === "spill" ? y1 + 0.2 : (y0 + y1) / 2;
      const z = ground.height(x, y);
      const above = (Number.isNaN(z) ? range.low : z) + 0.04 * span;
      mark(`${names[zone.kind]} ${zone.volume}`, x, y, above, "zone");
    }
  };
  makeMarks();

  // -- What the camera frames
  const corners = () => {
    const list = ground.places();
    const addBox = (x0, x1, y0, y1, z0, z1) => {
      for (const x of [x0, x1])
        for (const y of [y0, y1]) for (const z of [z0, z1]) list.push([x, y, z]);
    };
    addBox(extent.x0, extent.x1, extent.y0, extent.y1, floor, floor);
    if (!machine) return list;
    const s = machine.track_front_m / 1.8;
    const h = machine.boom_pin_m[1] / 1.424;
    addBox(-2.2 * s, s, -1.3 * s, 1.3 * s, 0, 2.8 * h);
    addBox(
      s,
      machine.boom_pin_m[0] + 0.9 * machine.lengths_m[0],
      0,
      0,
      0,
      machine.boom_pin_m[1] + 0.55 * machine.lengths_m[0],
    );
    return list;
  };

  // -- Legend
  const legend = (name) => {
    let node = null;
    if (!areas.length || (name !== "change" && flat)) {
      node = beginLegend(areas.length ? "level ground" : "");
      node.hidden = !areas.length;
      return;
    }
    node = name === "change" ? changeLegend(range) : heightLegend(range, contourStep);
    if (areas.some((area) => area.states[0].some(Number.isNaN)))
      htmlElement("div", { textContent: "gaps: not seen" }, node);
    if (areas.some((area) => area.coarse))
      htmlElement("div", { textContent: "drawn coarser than surveyed" }, node);
  };

  let shown = kinds.includes("change") ? "change" : kinds[Math.min(1, kinds.length - 1)];
  const show = (kind) => {
    shown = kind;
    ground.show(kind);
    legend(kind);
    for (const button of element("states").children) {
      button.setAttribute("aria-pressed", String(button.dataset.state === kind));
      button.textContent = ground.nameOf(button.dataset.state);
    }
    ask();
  };
  for (const kind of kinds) {
    const button = htmlElement("button", { type: "button" }, element("states"));
    button.dataset.state = kind;
    button.addEventListener("click", () => show(kind));
  }

  stage.open(corners(), direction);
  if (shown) show(shown);
  else legend("");
  return {
    pose: (joints, fill) => {
      model.pose(joints, fill);
      ask();
    },
    changed: () => {
      drawPath();
      if (shown) show(shown);
    },
    // Where the tip is drawn, x and z in metres.
    tip: () => {
      model.tip.updateWorldMatrix(true, false);
      const at = new T.Vector3().setFromMatrixPosition(model.tip.matrixWorld);
      return [at.x, at.z / tall.scale.z];
    },
  };
};
