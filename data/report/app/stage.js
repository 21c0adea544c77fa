// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The stage of a view in three dimensions: camera, light, marks, controls and keys.

const makeStage = () => {
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

  // -- Marks: texts at places
  const marks = [];
  const mark = (text, x, y, z, kind) => {
    const settings = { textContent: text, className: kind || "" };
    const node = htmlElement("span", settings, element("marks"));
    const entry = { node, at: [x, y, z] };
    marks.push(entry);
    return entry;
  };
  // Lengths along the two edges of a rectangle that are nearest to who looks from a direction.
  const markEdges = (extent, z, direction) => {
    const span = Math.max(extent.x1 - extent.x0, extent.y1 - extent.y0);
    const narrow = stage.clientWidth < 560;
    const xs = ticks(extent.x0, extent.x1, narrow ? 6 : 10);
    const beyond = (low, high, above) => (share) =>
      above ? high + share * span : low - share * span;
    const beyondX = beyond(extent.x0, extent.x1, direction[0] > 0);
    const beyondY = beyond(extent.y0, extent.y1, direction[1] > 0);
    for (const x of xs.list) mark(`${signed(x, xs.digits)}`, x, beyondY(0.03), z);
    const ys = ticks(extent.y0, extent.y1, narrow ? 4 : 7);
    for (const y of ys.list) mark(`${signed(y, ys.digits)}`, beyondX(0.03), y, z);
    mark("x [m]", (extent.x0 + extent.x1) / 2, beyondY(narrow ? 0.16 : 0.1), z);
    mark("y [m]", beyondX(narrow ? 0.16 : 0.1), (extent.y0 + extent.y1) / 2, z);
  };

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

  // -- Camera: what it frames, from which side
  let framing = { points: [], direction: [0.42, -1, 0.8] };
  const home = () => {
    const corners = framing.points.map(([x, y, z]) => new T.Vector3(x, y, z * tall.scale.z));
    const box = new T.Box3().setFromPoints(corners);
    box.getCenter(controls.target);
    const direction = new T.Vector3(...framing.direction).normalize();
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

  const scales = [1, 2, 5];
  element("exaggerate").addEventListener("click", (event) => {
    const scale = scales[(scales.indexOf(tall.scale.z) + 1) % scales.length];
    tall.scale.z = scale;
    event.currentTarget.textContent = `heights × ${scale}`;
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
  return {
    T,
    world: tall,
    ask,
    mark,
    markEdges,
    // Frames points from a direction, and begins to draw.
    open: (points, direction) => {
      framing = { points, direction };
      resize();
      home();
      new ResizeObserver(resize).observe(stage);
    },
  };
};
