// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The site in three dimensions: ground, design, what must be kept clear of, and the machine.

const makeView = () => {
  const stage = makeStage();
  if (!stage) return null;
  const { T, world, ask, mark } = stage;
  const extent = {
    x0: grid.x0,
    y0: grid.y0,
    x1: grid.x0 + (grid.cols - 1) * grid.cell,
    y1: grid.y0 + (grid.rows - 1) * grid.cell,
  };
  const span = Math.max(extent.x1 - extent.x0, extent.y1 - extent.y0);
  const floor = range.low - Math.max(0.25, 0.04 * span);
  const contourStep = Math.max(0.05, roundStep(Math.max(0.3, range.high - range.low) / 6));
  const mesher = makeGroundMesher(T, floor, contourStep);
  const firstHeight = (x, y) => {
    const z = heightAt(grid, before, x, y);
    return Number.isNaN(z) ? range.low : z;
  };

  const meshOf = (corners, colour, opacity) => {
    const geometry = new T.BufferGeometry();
    geometry.setAttribute("position", new T.BufferAttribute(new Float32Array(corners), 3));
    geometry.computeVertexNormals();
    const material = new T.MeshLambertMaterial({
      color: colour,
      side: T.DoubleSide,
      transparent: opacity < 1,
      opacity,
      depthWrite: opacity === 1,
    });
    return new T.Mesh(geometry, material);
  };
  const linesOf = (points, colour, opacity) => {
    const geometry = new T.BufferGeometry();
    geometry.setAttribute("position", new T.BufferAttribute(new Float32Array(points), 3));
    const line = new T.LineSegments(
      geometry,
      new T.LineBasicMaterial({ color: colour, transparent: true, opacity, depthTest: false }),
    );
    line.renderOrder = 4;
    return line;
  };

  // -- The design
  const makeSheet = () => {
    const sheet = new T.Group();
    const known = (row, col) =>
      row >= 0 &&
      col >= 0 &&
      row < grid.rows &&
      col < grid.cols &&
      !Number.isNaN(target[row * grid.cols + col]);
    const corner = (row, col) => {
      const i = row * grid.cols + col;
      return [...placeOfCell(i), target[i]];
    };
    const faces = [];
    const rim = [];
    for (let row = 0; row < grid.rows; ++row) {
      for (let col = 0; col < grid.cols; ++col) {
        if (!known(row, col)) continue;
        const [a, b, c, d] = [
          [row, col],
          [row, col + 1],
          [row + 1, col],
          [row + 1, col + 1],
        ].map(([r, k]) => (known(r, k) ? corner(r, k) : null));
        if (a && b && c && d) faces.push(...a, ...b, ...c, ...b, ...d, ...c);
        const [x, y, z] = a;
        const h = 0.5 * grid.cell;
        if (!known(row - 1, col)) rim.push(x - h, y - h, z, x + h, y - h, z);
        if (!known(row + 1, col)) rim.push(x - h, y + h, z, x + h, y + h, z);
        if (!known(row, col - 1)) rim.push(x - h, y - h, z, x - h, y + h, z);
        if (!known(row, col + 1)) rim.push(x + h, y - h, z, x + h, y + h, z);
      }
    }
    // What the ground hides of it shines through.
    const face = meshOf(faces, 0x2a86c8, 0.38);
    const hidden = meshOf(faces, 0x2a86c8, 0.16);
    hidden.material.depthTest = false;
    face.renderOrder = 3;
    hidden.renderOrder = 2;
    sheet.add(face, hidden, linesOf(rim, 0x00528c, 0.75));
    return { sheet, hidden };
  };
  const { sheet, hidden } = makeSheet();
  world.add(sheet);

  // -- Polygons on the ground before, and what stands on them
  const edgesOf = (polygon) => polygon.map((p, i) => [p, polygon[(i + 1) % polygon.length]]);
  const drape = (polygon) => {
    const points = [];
    for (const [p, q] of edgesOf(polygon)) {
      const count = Math.max(1, Math.ceil(Math.hypot(q[0] - p[0], q[1] - p[1]) / 0.3));
      const at = (i) => {
        const [x, y] = [0, 1].map((k) => p[k] + (i / count) * (q[k] - p[k]));
        return [x, y, firstHeight(x, y) + 0.03];
      };
      for (let i = 0; i < count; ++i) points.push([at(i), at(i + 1)]);
    }
    return points;
  };
  const fence = (polygon, height, colour) => {
    const corners = [];
    for (const [p, q] of drape(polygon)) {
      const [pt, qt] = [p, q].map(([x, y, z]) => [x, y, z + height]);
      corners.push(...p, ...q, ...qt, ...p, ...qt, ...pt);
    }
    return meshOf(corners, colour, 0.3);
  };
  const middleOf = (polygon) =>
    [0, 1].map((k) => polygon.reduce((sum, p) => sum + p[k], 0) / polygon.length);
  const label = (text, polygon, above) => {
    const [x, y] = middleOf(polygon);
    mark(text, x, y, firstHeight(x, y) + above, "zone");
  };
  const outline = (polygon, colour) =>
    world.add(linesOf(drape(polygon).flat(2), colour, 0.9));
  const prism = (polygon, height, colour, opacity) => {
    const shape = new T.Shape();
    polygon.forEach(([x, y], i) => (i ? shape.lineTo(x, y) : shape.moveTo(x, y)));
    const body = new T.Mesh(
      new T.ExtrudeGeometry(shape, { depth: height, bevelEnabled: false }),
      new T.MeshLambertMaterial({
        color: colour,
        transparent: opacity < 1,
        opacity,
        depthWrite: opacity === 1,
      }),
    );
    body.position.z = firstHeight(...middleOf(polygon));
    world.add(body);
  };
  for (const area of scene.design.dump_areas) {
    outline(area.polygon, 0xb36b00);
    label(area.kind, area.polygon, 0.3);
  }
  for (const area of scene.design.keep_out) {
    outline(area.polygon, 0xb2182b);
    world.add(fence(area.polygon, 0.6, 0xb2182b));
    const below = "depth_m" in area ? ` below ${area.depth_m} m` : "";
    label(`keep out${area.kind ? `: ${area.kind}` : ""}${below}`, area.polygon, 0.7);
  }
  for (const each of scene.design.obstacles) {
    prism(each.polygon, each.height_m, 0x7a7f86, 0.85);
    label(each.kind || "obstacle", each.polygon, each.height_m + 0.3);
  }
  const { truck } = scene.design;
  if (truck) {
    prism(truck.polygon, truck.height_m, 0x4d78a3, 0.55);
    label("truck", truck.polygon, truck.height_m + 0.3);
  }

  // -- The machine and its way
  const carrier = new T.Group();
  world.add(carrier);
  const model = makeMachineModel(T, carrier);
  model.pose([-0.75, 1.75, 1.3], 0);
  let way = null;
  const placeMachine = (step) => {
    const [x, y, z, heading] = baseAt(step);
    carrier.position.set(x, y, z || firstHeight(x, y));
    carrier.rotation.z = heading;
    const points = [];
    for (let i = 1; i <= step; ++i) {
      if (events[i - 1].what !== "move") continue;
      for (const [px, py] of [baseAt(i - 1), baseAt(i)])
        points.push(px, py, firstHeight(px, py) + 0.06);
    }
    if (way) {
      world.remove(way);
      way.geometry.dispose();
    }
    way = linesOf(points, 0x3a3e44, 0.8);
    world.add(way);
  };

  // -- The ground
  let mesh = null;
  const colourings = {
    height: () => (z) => (i) => heightColour(range, z[i]),
    error: () => (z) => (i) =>
      Number.isNaN(target[i]) ? still : errorColour(tolerance, z[i] - target[i]),
    change: () => (z) => (i) => changeColour(range, z[i] - before[i]),
    step: (step) => {
      const made = new Float64Array(cellCount);
      if (step > 0)
        forEachOfBlock(events[step - 1].ground, (i, change) => {
          made[i] = change / 1000;
        });
      return () => (i) => changeColour(range, made[i]);
    },
  };
  const titles = { height: "height", error: "error", change: "change", step: "this step" };
  let shown = "height";
  let now = -1;
  const draw = (step) => {
    const { z } = groundAt(step);
    if (mesh) {
      world.remove(mesh);
      mesh.geometry.dispose();
      for (const child of mesh.children) child.geometry.dispose();
    }
    mesh = mesher.mesh(grid, z);
    mesher.paint(mesh, colourings[shown](step)(z));
    world.add(mesh);
    placeMachine(step);
    now = step;
    ask();
  };
  const show = (kind) => {
    shown = kind;
    hidden.visible = kind !== "error"; // whose colours it would change
    if (kind === "height") heightLegend(range, contourStep);
    else if (kind === "error") errorLegend(tolerance);
    else changeLegend(range);
    for (const button of element("states").children)
      button.setAttribute("aria-pressed", String(button.dataset.state === kind));
    if (now >= 0) draw(now);
  };
  for (const kind in colourings) {
    const button = htmlElement("button", { type: "button" }, element("states"));
    button.dataset.state = kind;
    button.textContent = titles[kind];
    button.addEventListener("click", () => show(kind));
  }
  element("sheet").addEventListener("click", (event) => {
    sheet.visible = !sheet.visible;
    event.currentTarget.setAttribute("aria-pressed", String(sheet.visible));
    ask();
  });

  const wide = extent.x1 - extent.x0 >= extent.y1 - extent.y0;
  const direction = wide ? [0.25, -1, 0.75] : [-1, -0.25, 0.75];
  stage.markEdges(extent, floor, direction);
  const points = [];
  const frame = (x0, x1, y0, y1, z0, z1) => {
    for (const x of [x0, x1])
      for (const y of [y0, y1]) for (const z of [z0, z1]) points.push([x, y, z]);
  };
  frame(extent.x0, extent.x1, extent.y0, extent.y1, floor, range.high);
  for (const [x, y, z] of [baseAt(0), baseAt(lastStep)])
    frame(x - 2.5, x + 2.5, y - 2.5, y + 2.5, z, z + 4);
  stage.open(points, direction);
  show(shown);
  return { draw };
};
