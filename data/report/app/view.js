// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The view in three dimensions: ground, machine and the path of the tip, with camera, marks, legend
// and controls.

const makeView = () => {
  const T = globalThis.excavplanVendor.three;
  const canvas = element("canvas");
  const stage = element("stage");
  const settings = { antialias: true, alpha: true, preserveDrawingBuffer: true };
  const context = canvas.getContext("webgl2", settings);
  if (!context) return null;
  const renderer = new T.WebGLRenderer({ canvas, context, ...settings });
  const world = new T.Scene();
  const camera = new T.PerspectiveCamera(32, 1, 0.1, 500);
  camera.up.set(0, 0, 1);
  const controls = new T.OrbitControls(camera, canvas);
  controls.maxPolarAngle = Math.PI * 0.52;
  controls.enableZoom = false;
  canvas.addEventListener("focus", () => {
    controls.enableZoom = true;
  });
  canvas.addEventListener("blur", () => {
    controls.enableZoom = false;
  });
  canvas.addEventListener(
    "touchstart",
    () => {
      controls.enableZoom = true;
    },
    { passive: true },
  );

  world.add(new T.HemisphereLight(0xffffff, 0xb8b0a4, 2.0));
  const sun = new T.DirectionalLight(0xffffff, 1.7);
  sun.position.set(-4, -6, 9);
  world.add(sun);
  const tall = new T.Group(); // all that the vertical scale stretches
  world.add(tall);

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

  // -- Marks: lengths along the edges, volumes of the zones
  const marks = [];
  const mark = (text, x, y, z, kind) =>
    marks.push({
      node: htmlElement("span", { textContent: text, className: kind || "" }, element("marks")),
      at: [x, y, z],
    });
  const makeMarks = () => {
    const span = Math.max(extent.x1 - extent.x0, extent.y1 - extent.y0);
    const narrow = stage.clientWidth < 560;
    const xs = ticks(extent.x0, extent.x1, narrow ? 6 : 10);
    for (const x of xs.list) mark(`${signed(x, xs.digits)}`, x, extent.y0 - 0.03 * span, floor);
    const ys = ticks(extent.y0, extent.y1, narrow ? 4 : 7);
    for (const y of ys.list) mark(`${signed(y, ys.digits)}`, extent.x1 + 0.03 * span, y, floor);
    mark("x [m]", (extent.x0 + extent.x1) / 2, extent.y0 - (narrow ? 0.16 : 0.1) * span, floor);
    mark("y [m]", extent.x1 + (narrow ? 0.16 : 0.1) * span, (extent.y0 + extent.y1) / 2, floor);
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

  const projected = new T.Vector3();
  const placeMarks = () => {
    const taken = [];
    for (const { node, at } of marks) {
      projected.set(at[0], at[1], at[2] * tall.scale.z).project(camera);
      const visible =
        Math.abs(projected.x) < 0.98 && Math.abs(projected.y) < 0.96 && projected.z < 1;
      node.style.visibility = visible ? "visible" : "hidden";
      const x = ((projected.x + 1) / 2) * stage.clientWidth;
      let y = ((1 - projected.y) / 2) * stage.clientHeight;
      if (node.className === "zone") {
        while (taken.some((other) => Math.abs(other[0] - x) < 190 && Math.abs(other[1] - y) < 22))
          y -= 4;
        taken.push([x, y]);
      }
      node.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
    }
  };

  // -- Camera
  const home = () => {
    const corners = [];
    const addBox = (x0, x1, y0, y1, z0, z1) => {
      for (const x of [x0, x1])
        for (const y of [y0, y1])
          for (const z of [z0, z1]) corners.push(new T.Vector3(x, y, z * tall.scale.z));
    };
    addBox(extent.x0, extent.x1, extent.y0, extent.y1, floor, floor);
    for (const [x, y, z] of ground.places()) corners.push(new T.Vector3(x, y, z * tall.scale.z));
    if (machine) {
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
    }
    const box = new T.Box3().setFromPoints(corners);
    box.getCenter(controls.target);
    // The longer side across; of ground that lies across, what the operator sees.
    const across = !machine && extent.y1 - extent.y0 > extent.x1 - extent.x0;
    const direction = new T.Vector3(
      ...(across ? [-1, -0.35, 0.8] : [0.42, -1, machine ? 0.5 : 0.8]),
    ).normalize();
    // As near as all corners of the box allow.
    const half = Math.tan(camera.fov / 2 / degrees);
    const ahead = direction.clone().negate();
    const right = new T.Vector3().crossVectors(ahead, camera.up).normalize();
    const up = new T.Vector3().crossVectors(right, ahead);
    // The middle of what is seen, then the distance.
    const seen = { right: [Infinity, -Infinity], up: [Infinity, -Infinity] };
    for (const [name, axis] of [
      ["right", right],
      ["up", up],
    ]) {
      for (const corner of corners) {
        const at = corner.clone().sub(controls.target).dot(axis);
        seen[name] = [Math.min(seen[name][0], at), Math.max(seen[name][1], at)];
      }
    }
    controls.target
      .addScaledVector(right, (seen.right[0] + seen.right[1]) / 2)
      .addScaledVector(up, (seen.up[0] + seen.up[1]) / 2);
    let distance = 0;
    for (const corner of corners) {
      const from = corner.clone().sub(controls.target);
      distance = Math.max(
        distance,
        -from.dot(ahead) + Math.abs(from.dot(up)) / half,
        -from.dot(ahead) + Math.abs(from.dot(right)) / (half * camera.aspect),
      );
    }
    camera.position.copy(controls.target).addScaledVector(direction, distance * 1.05);
    controls.minDistance = 0.12 * distance;
    controls.maxDistance = 4 * distance;
    camera.near = distance / 100;
    camera.far = distance * 10;
    camera.updateProjectionMatrix();
    controls.update();
  };

  let asked = false;
  const render = () => {
    asked = false;
    renderer.render(world, camera);
    placeMarks();
  };
  const ask = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(render);
  };
  controls.addEventListener("change", ask);

  const resize = () => {
    if (printing) return;
    renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    renderer.setSize(stage.clientWidth, stage.clientHeight, false);
    camera.aspect = stage.clientWidth / stage.clientHeight;
    camera.updateProjectionMatrix();
    ask();
  };

  // -- Legend
  const legend = (name) => {
    const node = element("legend");
    node.replaceChildren();
    if (!areas.length || (name !== "change" && flat)) {
      htmlElement("div", { textContent: areas.length ? "level ground" : "" }, node);
      node.hidden = !areas.length;
      return;
    }
    htmlElement(
      "div",
      { textContent: name === "change" ? "height change [cm]" : "height [m]" },
      node,
    );
    const ramp = htmlElement("div", { className: "ramp" }, node);
    const strip = htmlElement("i", {}, ramp);
    const texts = htmlElement("div", {}, ramp);
    if (name === "change") {
      const list = [
        ...range.bands
          .slice()
          .reverse()
          .map((b) => [b, 1]),
        ...range.bands.map((b) => [b, -1]),
      ];
      const colours = [
        ...range.bands
          .slice()
          .reverse()
          .map((b) => css(changeColour(b * 1.001))),
        css(still),
        ...range.bands.map((b) => css(changeColour(-b * 1.001))),
      ];
      const share = (i) => `${((100 * i) / colours.length).toFixed(2)}%`;
      strip.style.setProperty(
        "--stops",
        colours.map((c, i) => `${c} ${share(i)}, ${c} ${share(i + 1)}`).join(","),
      );
      ramp.style.setProperty("--length", `${colours.length * 15}px`);
      texts.className = "between";
      for (const [bound, sign] of list)
        htmlElement(
          "span",
          { textContent: `${sign > 0 ? "+" : "−"}${+(bound * 100).toFixed(0)}` },
          texts,
        );
    } else {
      strip.style.setProperty("--stops", [4, 3, 2, 1, 0].map((i) => css(soilRamp[i])).join(","));
      const beyond = range.clipped ? { 1: "≥ ", 0.5: "", 0: "≤ " } : { 1: "", 0.5: "", 0: "" };
      for (const share of [1, 0.5, 0])
        htmlElement(
          "span",
          { textContent: beyond[share] + signed(range.low + share * (range.high - range.low), 2) },
          texts,
        );
      htmlElement("div", { textContent: `lines every ${+contourStep.toFixed(2)} m` }, node);
    }
    if (areas.some((area) => area.states[0].some(Number.isNaN)))
      htmlElement("div", { textContent: "gaps: not seen" }, node);
    if (areas.some((area) => area.coarse))
      htmlElement("div", { textContent: "drawn coarser than surveyed" }, node);
  };

  let shown = kinds[Math.min(1, kinds.length - 1)];
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

  const scales = [1, 2, 5];
  element("exaggerate").addEventListener("click", (event) => {
    const scale = scales[(scales.indexOf(tall.scale.z) + 1) % scales.length];
    tall.scale.z = scale;
    event.currentTarget.textContent = `z × ${scale}`;
    event.currentTarget.setAttribute("aria-pressed", String(scale !== 1));
    ask();
  });
  element("reset").addEventListener("click", () => {
    home();
    ask();
  });

  const turn = (around, tilt) => {
    const offset = camera.position.clone().sub(controls.target);
    const radius = offset.length();
    const azimuth = Math.atan2(offset.y, offset.x) + around;
    const polar = Math.min(
      Math.max(Math.acos(offset.z / radius) + tilt, 0.05),
      controls.maxPolarAngle,
    );
    offset.set(
      Math.sin(polar) * Math.cos(azimuth),
      Math.sin(polar) * Math.sin(azimuth),
      Math.cos(polar),
    );
    camera.position.copy(controls.target).addScaledVector(offset, radius);
    controls.update();
    ask();
  };
  const zoom = (factor) => {
    camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
    controls.update();
    ask();
  };
  const keys = {
    ArrowLeft: () => turn(-0.1, 0),
    ArrowRight: () => turn(0.1, 0),
    ArrowUp: () => turn(0, -0.08),
    ArrowDown: () => turn(0, 0.08),
    "+": () => zoom(1 / 1.15),
    "=": () => zoom(1 / 1.15),
    "-": () => zoom(1.15),
    r: () => {
      home();
      ask();
    },
    R: () => {
      home();
      ask();
    },
  };
  canvas.addEventListener("keydown", (event) => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    keys[event.key]();
    event.preventDefault();
  });

  element("view").hidden = false; // or it has no size
  resize();
  home();
  if (shown) show(shown);
  else legend("");
  new ResizeObserver(resize).observe(stage);
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
