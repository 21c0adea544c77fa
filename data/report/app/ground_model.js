// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The ground in three dimensions.

const makeGround = (T, parent) => {
  const extent = { x0: Infinity, y0: Infinity, x1: -Infinity, y1: -Infinity };
  for (const area of areas) {
    extent.x0 = Math.min(extent.x0, area.x0);
    extent.y0 = Math.min(extent.y0, area.y0);
    extent.x1 = Math.max(extent.x1, area.x0 + (area.cols - 1) * area.cell);
    extent.y1 = Math.max(extent.y1, area.y0 + (area.rows - 1) * area.cell);
  }
  if (!areas.length) Object.assign(extent, { x0: -3, y0: -3, x1: 9, y1: 3 });
  const flat = !(range.high - range.low > 1e-3);
  const floor = (areas.length ? range.low : 0) - Math.max(0.25, 0.05 * (extent.x1 - extent.x0));
  const contourStep = flat ? 0.1 : Math.max(0.05, roundStep((range.high - range.low) / 6));
  const mesher = makeGroundMesher(T, floor, contourStep);

  const kinds =
    areas.length === 0 ? [] : lastState() > 0 ? ["before", "after", "change"] : ["before"];
  const nameOf = (kind) =>
    kind === "change" ? kind : areas[0].names[kind === "before" ? 0 : lastState()];
  const meshes = new Map(); // by kind and state, made when first shown
  const meshesOf = (kind) => {
    const state = kind === "before" ? 0 : lastState();
    const key = `${kind} ${state}`;
    if (!meshes.has(key)) {
      meshes.set(
        key,
        areas.map((area) => {
          const z = area.states[state];
          const mesh = mesher.mesh(area, z);
          mesher.paint(
            mesh,
            kind === "change"
              ? (i) => changeColour(range, z[i] - area.states[0][i])
              : (i) => heightColour(range, z[i]),
          );
          parent.add(mesh);
          return mesh;
        }),
      );
    }
    return meshes.get(key);
  };

  const lines = (points, colour) => {
    const geometry = new T.BufferGeometry();
    geometry.setAttribute("position", new T.BufferAttribute(new Float32Array(points), 3));
    const line = new T.LineSegments(
      geometry,
      new T.LineBasicMaterial({ color: colour, transparent: true }),
    );
    parent.add(line);
    return line;
  };

  // A grid of metres where there is no ground, at the level that the machine stands on.
  const level = machine ? 0 : floor;
  const gridPoints = [];
  const bounds = {
    x0: Math.floor(Math.min(extent.x0, machine ? -3.5 : Infinity)),
    x1: Math.ceil(extent.x1),
    y0: Math.floor(extent.y0),
    y1: Math.ceil(extent.y1),
  };
  const pitch = Math.max(1, roundStep((bounds.x1 - bounds.x0) / 14));
  const onGround = (x, y) =>
    areas.length && x > extent.x0 && x < extent.x1 && y > extent.y0 && y < extent.y1;
  const gridLine = (x, y, dx, dy) => {
    if (onGround(x + dx / 2, y + dy / 2)) return;
    gridPoints.push(x, y, level, x + dx, y + dy, level);
  };
  for (let x = bounds.x0; x <= bounds.x1; x += pitch) {
    for (let y = bounds.y0; y < bounds.y1; y += pitch) gridLine(x, y, 0, pitch);
  }
  for (let y = bounds.y0; y <= bounds.y1; y += pitch) {
    for (let x = bounds.x0; x < bounds.x1; x += pitch) gridLine(x, y, pitch, 0);
  }
  const grid = lines(gridPoints, 0x888888);
  grid.material.opacity = 0.35;

  // -- Zones of the change, drawn on the ground after
  const zoneColours = { dig: 0x111111, spill: 0x00795a, dump: 0xc98200, other: 0xa8487f };
  const zoneLine = (area, zone, index) => {
    const z = area.states[area.states.length - 1];
    const points = [];
    const at = (row, col) => {
      const [x, y] = [area.x0 + col * area.cell, area.y0 + row * area.cell];
      return [x, y, heightAt(area, z, x, y) + 0.012];
    };
    // Not where no scan saw the ground.
    const edge = (a, b) => {
      if (!Number.isNaN(a[2] + b[2])) points.push(...a, ...b);
    };
    const inZone = (row, col) =>
      Math.min(row, col) >= 0 &&
      row < area.rows &&
      col < area.cols &&
      area.zone[row * area.cols + col] === index;
    const [x0, y0, x1, y1] = zone.extent_m;
    const rowOf = (y) => Math.min(Math.max(Math.round((y - area.y0) / area.cell), 0), area.rows);
    const colOf = (x) => Math.min(Math.max(Math.round((x - area.x0) / area.cell), 0), area.cols);
    for (let row = rowOf(y0) - 1; row <= rowOf(y1) + 1; ++row) {
      for (let col = colOf(x0) - 1; col <= colOf(x1) + 1; ++col) {
        const here = inZone(row, col);
        if (here !== inZone(row - 1, col)) edge(at(row - 0.5, col - 0.5), at(row - 0.5, col + 0.5));
        if (here !== inZone(row, col - 1)) edge(at(row - 0.5, col - 0.5), at(row + 0.5, col - 0.5));
      }
    }
    return lines(points, zoneColours[zone.kind]);
  };
  const zoneLines = areas
    .filter((area) => area.zone)
    .flatMap((area) => scene.zones.map((zone, index) => zoneLine(area, zone, index)));

  // The ground at a place in the state that is left; NaN where there is none.
  const height = (x, y) => {
    for (const area of areas) {
      const z = heightAt(area, area.states[lastState()], x, y);
      if (!Number.isNaN(z)) return z;
    }
    return NaN;
  };

  // Some of the places of that state, for the camera.
  const places = () =>
    areas.flatMap((area) => {
      const step = Math.ceil(Math.sqrt((area.rows * area.cols) / 2000));
      const list = [];
      for (let row = 0; row < area.rows; row += step) {
        for (let col = 0; col < area.cols; col += step) {
          const z = area.states[lastState()][row * area.cols + col];
          if (!Number.isNaN(z))
            list.push([area.x0 + col * area.cell, area.y0 + row * area.cell, z]);
        }
      }
      return list;
    });

  return {
    extent,
    height,
    places,
    floor,
    flat,
    contourStep,
    kinds,
    nameOf,
    show: (kind) => {
      for (const list of meshes.values())
        list.forEach((mesh) => {
          mesh.visible = false;
        });
      meshesOf(kind).forEach((mesh) => {
        mesh.visible = true;
      });
      zoneLines.forEach((line) => {
        line.visible = kind !== "before";
      });
    },
  };
};
