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

  // Lines of equal height. They lie half a step beside round heights, where level ground would be
  // full of them.
  const withContours = (material) => {
    material.onBeforeCompile = (shader) => {
      shader.uniforms.contour = { value: contourStep };
      shader.vertexShader =
        "varying float vHeight;\n" +
        shader.vertexShader.replace(
          "#include <begin_vertex>",
          "#include <begin_vertex>\nvHeight = position.z;",
        );
      shader.fragmentShader =
        "varying float vHeight;\nuniform float contour;\n" +
        shader.fragmentShader.replace(
          "#include <color_fragment>",
          `#include <color_fragment>
        float level = vHeight / contour + 0.5;
        float slope = fwidth(level);
        float away = abs(fract(level - 0.5) - 0.5) / max(slope, 1e-5);
        float line = (1.0 - smoothstep(0.4, 1.2, away)) * (1.0 - smoothstep(0.25, 0.5, slope));
        diffuseColor.rgb *= 1.0 - 0.3 * line * step(1e-4, slope);`,
        );
    };
    return material;
  };

  const sides = new T.MeshLambertMaterial({ color: 0x8d7355, side: T.DoubleSide });
  const surface = withContours(
    new T.MeshLambertMaterial({ vertexColors: true, side: T.DoubleSide }),
  );

  const groundMesh = (area, z) => {
    const count = area.rows * area.cols;
    const position = new Float32Array(3 * count);
    const colour = new Float32Array(3 * count);
    for (let row = 0, i = 0; row < area.rows; ++row) {
      for (let col = 0; col < area.cols; ++col, ++i) {
        position[3 * i] = area.x0 + col * area.cell;
        position[3 * i + 1] = area.y0 + row * area.cell;
        position[3 * i + 2] = Number.isNaN(z[i]) ? 0 : z[i];
      }
    }
    const index = [];
    const skirt = [];
    const known = (i) => !Number.isNaN(z[i]);
    const wall = (a, b) => {
      const [p, q] = [a, b].map((i) => [position[3 * i], position[3 * i + 1], position[3 * i + 2]]);
      skirt.push(...p, ...q, q[0], q[1], floor, ...p, q[0], q[1], floor, p[0], p[1], floor);
    };
    // Walls down to the floor, unless the border of the ground is ragged.
    let open = 0;
    for (let i = 0; i < count; ++i) {
      const [row, col] = [Math.floor(i / area.cols), i % area.cols];
      if ((row === 0 || col === 0 || row === area.rows - 1 || col === area.cols - 1) && !known(i))
        ++open;
    }
    const closed = open < 0.1 * (area.rows + area.cols);
    for (let row = 0; row + 1 < area.rows; ++row) {
      for (let col = 0; col + 1 < area.cols; ++col) {
        const a = row * area.cols + col;
        const b = a + 1;
        const c = a + area.cols;
        const d = c + 1;
        if (!(known(a) && known(b) && known(c) && known(d))) continue;
        if ((row + col) % 2) index.push(a, b, d, a, d, c);
        else index.push(a, b, c, b, d, c);
        if (!closed) continue;
        if (row === 0) wall(a, b);
        if (row + 2 === area.rows) wall(c, d);
        if (col === 0) wall(a, c);
        if (col + 2 === area.cols) wall(b, d);
      }
    }
    const geometry = new T.BufferGeometry();
    geometry.setAttribute("position", new T.BufferAttribute(position, 3));
    geometry.setAttribute("color", new T.BufferAttribute(colour, 3));
    geometry.setIndex(new T.BufferAttribute(new Uint32Array(index), 1));
    geometry.computeVertexNormals();
    const mesh = new T.Mesh(geometry, surface);
    const border = new T.BufferGeometry();
    border.setAttribute("position", new T.BufferAttribute(new Float32Array(skirt), 3));
    border.computeVertexNormals();
    mesh.add(new T.Mesh(border, sides));
    return mesh;
  };

  const linear = new T.Color();
  const paint = (mesh, colours) => {
    const attribute = mesh.geometry.getAttribute("color");
    for (let i = 0; i < attribute.count; ++i) {
      const c = colours(i);
      linear.setRGB(c[0], c[1], c[2], "srgb");
      attribute.setXYZ(i, linear.r, linear.g, linear.b);
    }
    attribute.needsUpdate = true;
  };

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
          const mesh = groundMesh(area, z);
          paint(
            mesh,
            kind === "change"
              ? (i) => changeColour(z[i] - area.states[0][i])
              : (i) => heightColour(z[i]),
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
