// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The page of --report: ground and machine in three dimensions, the section in the boom plane and
// the charts, all at the time of one slider. All numbers come from the element #data.
"use strict";

(() => {
  const scene = JSON.parse(document.getElementById("data").textContent);
  const element = (id) => document.getElementById(id);
  const degrees = 180 / Math.PI;

  // ---- Small tools ------------------------------------------------------------------------------

  const svgElement = (name, attributes, parent) => {
    const node = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const key in attributes) node.setAttribute(key, attributes[key]);
    if (parent) parent.appendChild(node);
    return node;
  };

  const htmlElement = (name, attributes, parent) => {
    const node = Object.assign(document.createElement(name), attributes);
    if (parent) parent.appendChild(node);
    return node;
  };

  const signed = (value, digits) => {
    const text = value.toFixed(digits);
    return Number(text) === 0 ? (0).toFixed(digits) : text.replace("-", "−");
  };

  // Largest of 1, 2, 5, 10, ... times a power of ten that is at most `value`.
  const roundStep = (value) => {
    const power = 10 ** Math.floor(Math.log10(value));
    return [10, 5, 2, 1].find((factor) => factor * power <= value * 1.0001) * power;
  };

  // At most `count` + 1 round values in low .. high.
  const ticks = (low, high, count) => {
    const power = 10 ** Math.floor(Math.log10((high - low) / count));
    const step = [1, 2, 5, 10].find((factor) => factor * power >= ((high - low) / count) * 0.9999) * power;
    const list = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) list.push(i * step);
    return { list, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
  };

  const dark = matchMedia("(prefers-color-scheme: dark)");
  let printing = false;
  // Colours of what is drawn on a canvas. On paper they are those of the light page.
  const light = {
    card: "#ffffff", ink: "#1d2024", soft: "#5b626b", line: "#e4e1db", boom: "#0072b2",
    arm: "#b85000", bucket: "#00795a", total: "#1d2024", band: "rgba(91,98,107,0.07)",
  };
  const theme = () => {
    if (printing || !dark.matches) return light;
    return {
      card: "#1d2126", ink: "#e7e5e0", soft: "#a3abb5", line: "#31363d", boom: "#58b4ee",
      arm: "#f0914a", bucket: "#42cda4", total: "#e7e5e0", band: "rgba(163,171,181,0.09)",
    };
  };

  // ---- The data ---------------------------------------------------------------------------------

  const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

  const heightsOf = (state) => {
    const bytes = bytesOf(state.codes);
    const z = new Float64Array(bytes.length / 2);
    for (let i = 0; i < z.length; ++i) {
      const code = bytes[2 * i] | (bytes[2 * i + 1] << 8);
      z[i] = code === 65535 ? NaN : state.base_m + state.step_m * code;
    }
    return z;
  };

  // The part of an area that has a known cell in any state.
  const areas = scene.areas.map((area) => {
    const states = area.states.map(heightsOf);
    const box = { row: [Infinity, -Infinity], col: [Infinity, -Infinity] };
    const grow = (pair, i) => { pair[0] = Math.min(pair[0], i); pair[1] = Math.max(pair[1], i); };
    for (const z of states) {
      z.forEach((value, i) => {
        if (Number.isNaN(value)) return;
        grow(box.row, Math.floor(i / area.cols));
        grow(box.col, i % area.cols);
      });
    }
    const [rows, cols] = [box.row[1] - box.row[0] + 1, box.col[1] - box.col[0] + 1];
    const cut = (list) => {
      const part = new list.constructor(Math.max(0, rows * cols));
      for (let i = 0; i < part.length; ++i) {
        part[i] = list[(box.row[0] + Math.floor(i / cols)) * area.cols + box.col[0] + i % cols];
      }
      return part;
    };
    return {
      x0: area.origin_m[0] + (box.col[0] + 0.5) * area.cell_m,
      y0: area.origin_m[1] + (box.row[0] + 0.5) * area.cell_m,
      cell: area.cell_m, rows, cols,
      coarse: area.cell_m > area.surveyed_cell_m * 1.5,
      names: area.states.map((state) => state.name),
      states: states.map(cut),
      zone: area.zone ? cut(bytesOf(area.zone)) : null,
    };
  }).filter((area) => area.rows > 1 && area.cols > 1);

  // Bilinear between the centres of cells; NaN outside and beside unknown cells.
  const heightAt = (area, z, x, y) => {
    const u = Math.min(Math.max((x - area.x0) / area.cell, 0), area.cols - 1);
    const v = Math.min(Math.max((y - area.y0) / area.cell, 0), area.rows - 1);
    if (Math.abs((x - area.x0) / area.cell - u) > 0.51 || Math.abs((y - area.y0) / area.cell - v) > 0.51) return NaN;
    const col = Math.min(Math.floor(u), area.cols - 2);
    const row = Math.min(Math.floor(v), area.rows - 2);
    const at = (r, c) => z[r * area.cols + c];
    const low = at(row, col) + (u - col) * (at(row, col + 1) - at(row, col));
    const high = at(row + 1, col) + (u - col) * (at(row + 1, col + 1) - at(row + 1, col));
    return low + (v - row) * (high - low);
  };

  const machine = scene.machine;
  let dig = scene.digs[0];
  // The state of the ground that the dig leaves; the first is that before it.
  const lastState = () => (dig && dig.state !== undefined ? dig.state : Math.max(0, ...areas.map((area) => area.states.length - 1)));

  // Index and share of the point before a time in rising times.
  const placeOf = (times, time) => {
    let low = 0;
    let high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle; else high = middle;
    }
    if (high === low) return [0, 0, 0];
    const share = Math.min(Math.max((time - times[low]) / (times[high] - times[low]), 0), 1);
    return [low, high, share];
  };

  const valueAt = (times, values, time) => {
    const [low, high, share] = placeOf(times, time);
    return values[low] + share * (values[high] - values[low]);
  };

  // ---- Kinematics: the convention of the library's machine.hpp ---------------------------------

  const along = (from, length, angle) => [from[0] + length * Math.cos(angle), from[1] + length * Math.sin(angle)];

  const postureOf = (joints) => {
    const phi = [-joints[0], -joints[0] - joints[1], -joints[0] - joints[1] - joints[2]];
    const boomPin = machine.boom_pin_m;
    const armPin = along(boomPin, machine.lengths_m[0], phi[0]);
    const bucketPin = along(armPin, machine.lengths_m[1], phi[1]);
    return { phi, boomPin, armPin, bucketPin, tip: along(bucketPin, machine.lengths_m[2], phi[2]) };
  };

  const bucketPoint = (posture, point) => along(
    along(posture.bucketPin, point[0], posture.phi[2]), point[1], posture.phi[2] + Math.PI / 2);

  const pin = (at, direction, polar) => along(at, polar[0], direction + polar[1]);

  // Where two bars from `a` and `b` meet, on the other side of the line between them than `away`.
  const joinOf = (a, lengthA, b, lengthB, away) => {
    const dx = b[0] - a[0];
    const dy = b[1] - a[1];
    const distance = Math.hypot(dx, dy);
    const foot = (distance * distance + lengthA * lengthA - lengthB * lengthB) / (2 * distance);
    const height = Math.sqrt(Math.max(0, lengthA * lengthA - foot * foot));
    const side = dx * (away[1] - a[1]) - dy * (away[0] - a[0]) > 0 ? -1 : 1;
    return [a[0] + (foot * dx - side * height * dy) / distance, a[1] + (foot * dy + side * height * dx) / distance];
  };

  // Ends of the cylinders of boom, arm and bucket, with the bars of the bucket's linkage.
  const cylindersOf = (posture) => {
    const joints = [posture.boomPin, posture.armPin, posture.bucketPin];
    const before = [0, posture.phi[0], posture.phi[1]];
    return machine.cylinders.map((cylinder, i) => {
      const foot = pin(joints[i], before[i], cylinder.foot);
      if (cylinder.rod) return { foot, rod: pin(joints[i], posture.phi[i], cylinder.rod), bars: [] };
      const rocker = pin(joints[i], before[i], cylinder.rocker.pin);
      const link = pin(joints[i], posture.phi[i], cylinder.link.pin);
      const rod = joinOf(rocker, cylinder.rocker.length_m, link, cylinder.link.length_m, joints[i]);
      return { foot, rod, bars: [[rocker, rod], [link, rod]] };
    });
  };

  // The soil in the bucket in its frame: cut parallel to the mouth, heaped where it is more than
  // fits below.
  const soilInBucket = (fill) => {
    const profile = machine.profile_m;
    const area = fill / machine.width_inside_m;
    if (!(area > 1e-4) || profile.length < 3) return [];
    const first = profile[0];
    const last = profile[profile.length - 1];
    const length = Math.hypot(last[0] - first[0], last[1] - first[1]);
    const normal = [-(last[1] - first[1]) / length, (last[0] - first[0]) / length];
    const depth = (p) => (p[0] - first[0]) * normal[0] + (p[1] - first[1]) * normal[1];
    const inside = profile.some((p) => depth(p) > 1e-6) ? 1 : -1;
    const below = (level) => {
      const cut = [];
      profile.forEach((p, i) => {
        const q = profile[(i + 1) % profile.length];
        const a = inside * depth(p) - level;
        const b = inside * depth(q) - level;
        if (a >= 0) cut.push(p);
        if (a * b < 0) cut.push([p[0] + (q[0] - p[0]) * a / (a - b), p[1] + (q[1] - p[1]) * a / (a - b)]);
      });
      return cut;
    };
    const sizeOf = (polygon) => Math.abs(polygon.reduce((sum, p, i) => {
      const q = polygon[(i + 1) % polygon.length];
      return sum + (p[0] * q[1] - q[0] * p[1]) / 2;
    }, 0));
    const struck = sizeOf(profile);
    if (area >= struck) {
      const height = Math.min(2 * (area - struck) / length, length / 2);
      const top = [0.35, 0.65].map((share) => [
        last[0] + share * (first[0] - last[0]) - inside * normal[0] * height * 0.75,
        last[1] + share * (first[1] - last[1]) - inside * normal[1] * height * 0.75]);
      return profile.concat(top);
    }
    let low = 0;
    let high = Math.max(...profile.map((p) => inside * depth(p)));
    for (let i = 0; i < 30; ++i) {
      const middle = (low + high) / 2;
      if (sizeOf(below(middle)) > area) low = middle; else high = middle;
    }
    return below((low + high) / 2);
  };

  // ---- Colours of the ground --------------------------------------------------------------------

  const rgb = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16) / 255);
  const mix = (stops, share) => {
    if (Number.isNaN(share)) return still;
    const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
    const i = Math.min(Math.floor(at), stops.length - 2);
    return stops[i].map((value, k) => value + (at - i) * (stops[i + 1][k] - value));
  };
  const still = rgb("#cfc7ba");
  const soilRamp = ["#5d4a3a", "#937354", "#c0a17a", "#dec8a5", "#f4ebda"].map(rgb);
  const fell = ["#f6d9cb", "#f4a582", "#d6604d", "#b2182b", "#67001f"].map(rgb);
  const rose = ["#d6e7f1", "#92c5de", "#4393c3", "#2166ac", "#053061"].map(rgb);
  const changeBounds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];

  const range = (() => {
    let low = Infinity;
    let high = -Infinity;
    let change = 0;
    for (const area of areas) {
      for (const z of area.states) for (const value of z) {
        if (value < low) low = value;
        if (value > high) high = value;
      }
      for (const z of area.states) {
        for (let i = 0; i < z.length; ++i) change = Math.max(change, Math.abs(z[i] - area.states[0][i]) || 0);
      }
    }
    const bands = changeBounds.filter((bound, i) => i === 0 || bound < change);
    return { low, high, bands };
  })();

  const heightColour = (z) => mix(soilRamp, range.high - range.low < 1e-3 ? 0.5 : (z - range.low) / (range.high - range.low));
  // Bands of 1, 2, 5, 10 cm and so on, so that centimetres show beside decimetres.
  const changeColour = (change) => {
    const band = range.bands.filter((bound) => Math.abs(change) >= bound).length;
    if (!(band > 0)) return still;
    return mix(change < 0 ? fell : rose, range.bands.length > 1 ? (band - 1) / (range.bands.length - 1) : 1);
  };

  const css = (colour) => `rgb(${colour.map((value) => Math.round(255 * value)).join(",")})`;

  // ---- View in three dimensions -----------------------------------------------------------------

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
    canvas.addEventListener("focus", () => { controls.enableZoom = true; });
    canvas.addEventListener("blur", () => { controls.enableZoom = false; });
    canvas.addEventListener("touchstart", () => { controls.enableZoom = true; }, { passive: true });

    world.add(new T.HemisphereLight(0xffffff, 0xb8b0a4, 2.0));
    const sun = new T.DirectionalLight(0xffffff, 1.7);
    sun.position.set(-4, -6, 9);
    world.add(sun);
    const tall = new T.Group();  // all that the vertical scale stretches
    world.add(tall);

    // -- Ground
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
        shader.vertexShader = "varying float vHeight;\n" + shader.vertexShader.replace(
          "#include <begin_vertex>", "#include <begin_vertex>\nvHeight = position.z;");
        shader.fragmentShader = "varying float vHeight;\nuniform float contour;\n" + shader.fragmentShader.replace(
          "#include <color_fragment>",
          `#include <color_fragment>
          float level = vHeight / contour + 0.5;
          float slope = fwidth(level);
          float away = abs(fract(level - 0.5) - 0.5) / max(slope, 1e-5);
          float line = (1.0 - smoothstep(0.4, 1.2, away)) * (1.0 - smoothstep(0.25, 0.5, slope));
          diffuseColor.rgb *= 1.0 - 0.3 * line * step(1e-4, slope);`);
      };
      return material;
    };

    const sides = new T.MeshLambertMaterial({ color: 0x8d7355, side: T.DoubleSide });
    const surface = withContours(new T.MeshLambertMaterial({ vertexColors: true, side: T.DoubleSide }));

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
        if ((row === 0 || col === 0 || row === area.rows - 1 || col === area.cols - 1) && !known(i)) ++open;
      }
      const closed = open < 0.1 * (area.rows + area.cols);
      for (let row = 0; row + 1 < area.rows; ++row) {
        for (let col = 0; col + 1 < area.cols; ++col) {
          const a = row * area.cols + col;
          const b = a + 1;
          const c = a + area.cols;
          const d = c + 1;
          if (!(known(a) && known(b) && known(c) && known(d))) continue;
          if ((row + col) % 2) index.push(a, b, d, a, d, c); else index.push(a, b, c, b, d, c);
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

    const kinds = areas.length === 0 ? [] : lastState() > 0 ? ["before", "after", "change"] : ["before"];
    const nameOf = (kind) => (kind === "change" ? kind : areas[0].names[kind === "before" ? 0 : lastState()]);
    const meshes = new Map();  // by kind and state, made when first shown
    const meshesOf = (kind) => {
      const state = kind === "before" ? 0 : lastState();
      const key = `${kind} ${state}`;
      if (!meshes.has(key)) {
        meshes.set(key, areas.map((area) => {
          const z = area.states[state];
          const mesh = groundMesh(area, z);
          paint(mesh, kind === "change" ? (i) => changeColour(z[i] - area.states[0][i]) : (i) => heightColour(z[i]));
          tall.add(mesh);
          return mesh;
        }));
      }
      return meshes.get(key);
    };

    const lines = (points, colour) => {
      const geometry = new T.BufferGeometry();
      geometry.setAttribute("position", new T.BufferAttribute(new Float32Array(points), 3));
      const line = new T.LineSegments(geometry, new T.LineBasicMaterial({ color: colour, transparent: true }));
      tall.add(line);
      return line;
    };

    // A grid of metres where there is no ground, at the level that the machine stands on.
    const level = machine ? 0 : floor;
    const gridPoints = [];
    const bounds = { x0: Math.floor(Math.min(extent.x0, machine ? -3.5 : Infinity)), x1: Math.ceil(extent.x1), y0: Math.floor(extent.y0), y1: Math.ceil(extent.y1) };
    const pitch = Math.max(1, roundStep((bounds.x1 - bounds.x0) / 14));
    const onGround = (x, y) => areas.length && x > extent.x0 && x < extent.x1 && y > extent.y0 && y < extent.y1;
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
    const zoneLines = areas.filter((area) => area.zone).flatMap((area) => scene.zones.map((zone, index) => {
      const z = area.states[area.states.length - 1];
      const points = [];
      const at = (row, col) => [area.x0 + col * area.cell, area.y0 + row * area.cell];
      const height = (x, y) => {
        const here = heightAt(area, z, x, y);
        return (Number.isNaN(here) ? range.low : here) + 0.012;
      };
      const edge = (a, b) => points.push(a[0], a[1], height(...a), b[0], b[1], height(...b));
      const inZone = (row, col) => row >= 0 && col >= 0 && row < area.rows && col < area.cols && area.zone[row * area.cols + col] === index;
      for (let row = 0; row <= area.rows; ++row) {
        for (let col = 0; col <= area.cols; ++col) {
          const here = inZone(row, col);
          if (here !== inZone(row - 1, col)) edge(at(row - 0.5, col - 0.5), at(row - 0.5, col + 0.5));
          if (here !== inZone(row, col - 1)) edge(at(row - 0.5, col - 0.5), at(row + 0.5, col - 0.5));
        }
      }
      return lines(points, zoneColours[zone.kind]);
    }));

    // -- Machine
    const paints = {
      body: new T.MeshLambertMaterial({ color: 0xe6ae34 }),
      dark: new T.MeshLambertMaterial({ color: 0x3a3e44 }),
      steel: new T.MeshLambertMaterial({ color: 0x8b9097, side: T.DoubleSide }),
      rod: new T.MeshLambertMaterial({ color: 0xd5d8dc }),
      glass: new T.MeshLambertMaterial({ color: 0x50687a }),
      soil: new T.MeshLambertMaterial({ color: 0x8d7355, side: T.DoubleSide }),
    };

    // Convex outline around discs (x, z, radius).
    const hull = (discs) => {
      const points = [];
      for (const [x, z, radius] of discs) {
        for (let i = 0; i < 24; ++i) {
          const angle = i * Math.PI / 12;
          points.push([x + radius * Math.cos(angle), z + radius * Math.sin(angle)]);
        }
      }
      points.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
      const half = (list) => {
        const chain = [];
        for (const p of list) {
          while (chain.length > 1) {
            const [a, b] = chain.slice(-2);
            if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
            chain.pop();
          }
          chain.push(p);
        }
        return chain.slice(0, -1);
      };
      return half(points).concat(half(points.reverse()));
    };

    // An outline in (x, z), `width` wide about y.
    const plateGeometry = (outline, width, y = 0) => {
      const shape = new T.Shape();
      outline.forEach((p, i) => (i ? shape.lineTo(p[0], p[1]) : shape.moveTo(p[0], p[1])));
      const geometry = new T.ExtrudeGeometry(shape, { depth: width, bevelEnabled: false });
      geometry.rotateX(Math.PI / 2);
      geometry.translate(0, y + width / 2, 0);
      return geometry;
    };
    const plate = (outline, width, y, material, parent) => {
      const mesh = new T.Mesh(plateGeometry(outline, width, y), material);
      parent.add(mesh);
      return mesh;
    };
    const box = (x0, x1, y0, y1, z0, z1, material, parent) => {
      const mesh = new T.Mesh(new T.BoxGeometry(x1 - x0, y1 - y0, z1 - z0), material);
      mesh.position.set((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2);
      parent.add(mesh);
    };

    // Undercarriage and upper structure in the proportions of an excavator with this boom pin.
    const makeBody = (parent) => {
      const s = machine.track_front_m / 1.8;
      const h = machine.boom_pin_m[1] / 1.424;
      const radius = 0.4 * h;
      const front = machine.track_front_m - radius;
      for (const side of [-1, 1]) {
        plate(hull([[-front, radius, radius], [front, radius, radius]]), 0.5 * s, side * s, paints.dark, parent);
        plate(hull([[-front, radius, 0.26 * h], [front, radius, 0.26 * h]]), 0.52 * s, side * s, paints.steel, parent);
      }
      box(-0.9 * s, 0.9 * s, -0.8 * s, 0.8 * s, 0.35 * h, 0.75 * h, paints.dark, parent);
      const ring = new T.Mesh(new T.CylinderGeometry(0.6 * s, 0.6 * s, 0.2 * h, 40), paints.dark);
      ring.rotation.x = Math.PI / 2;
      ring.position.z = 0.84 * h;
      parent.add(ring);
      box(-1.9 * s, 0.95 * s, -1.2 * s, 1.2 * s, 0.92 * h, 1.12 * h, paints.body, parent);
      box(-1.5 * s, -0.25 * s, -1.2 * s, 1.2 * s, 1.12 * h, 1.95 * h, paints.body, parent);
      box(-0.25 * s, 0.8 * s, -1.2 * s, -0.45 * s, 1.12 * h, 1.7 * h, paints.body, parent);
      const back = hull([[-1.62 * s, 1.14 * h, 0.16 * h], [-1.9 * s, 1.2 * h, 0.2 * h], [-1.92 * s, 1.78 * h, 0.18 * h], [-1.5 * s, 1.88 * h, 0.08 * h]]);
      plate(back, 2.36 * s, 0, paints.dark, parent);
      const cab = [[-0.2 * s, 1.12 * h], [1.0 * s, 1.12 * h], [1.08 * s, 1.75 * h], [0.85 * s, 2.72 * h], [-0.2 * s, 2.72 * h]];
      plate(cab, 0.9 * s, 0.72 * s, paints.body, parent);
      const glass = [[0.0, 1.62 * h], [0.98 * s, 1.62 * h], [1.0 * s, 1.75 * h], [0.8 * s, 2.6 * h], [0.0, 2.6 * h]];
      plate(glass, 0.93 * s, 0.72 * s, paints.glass, parent);
      box(0.97 * s, 1.01 * s, 0.34 * s, 1.1 * s, 1.75 * h, 1.78 * h, paints.dark, parent);
      const foot = hull([[machine.boom_pin_m[0], machine.boom_pin_m[1], 0.2 * h], [-0.2 * s, 1.1 * h, 0.1], [0.65 * s, 1.02 * h, 0.1]]);
      for (const side of [-1, 1]) plate(foot, 0.06, side * 0.27 * s, paints.body, parent);
    };

    const makeBoom = (parent) => {
      const [length] = machine.lengths_m;
      const cylinders = machine.cylinders;
      const knee = cylinders && cylinders[0].rod
        ? along([0, 0], cylinders[0].rod[0], cylinders[0].rod[1]) : [0.42 * length, 0.19 * length];
      const w = length / 4.6;
      const top = [knee[0] + 0.12 * length, knee[1] + 0.02 * length];
      plate(hull([[0, 0, 0.19 * w], [knee[0], knee[1], 0.27 * w]]), 0.38 * w, 0, paints.body, parent);
      plate(hull([[knee[0], knee[1], 0.27 * w], [top[0], top[1], 0.24 * w]]), 0.38 * w, 0, paints.body, parent);
      plate(hull([[top[0], top[1], 0.24 * w], [length, 0, 0.15 * w]]), 0.38 * w, 0, paints.body, parent);
      if (!cylinders) return;
      const foot = pin([length, 0], 0, cylinders[1].foot);
      plate(hull([[foot[0], foot[1], 0.1 * w], [top[0] - 0.2 * w, top[1], 0.1 * w], [top[0] + 0.25 * w, top[1] - 0.12 * w, 0.1 * w]]), 0.2 * w, 0, paints.body, parent);
    };

    const makeArm = (parent) => {
      const length = machine.lengths_m[1];
      const w = length / 2.5;
      const discs = [[0, 0, 0.19 * w], [length, 0, 0.12 * w]];
      if (machine.cylinders) {
        const rod = along([0, 0], machine.cylinders[1].rod ? machine.cylinders[1].rod[0] : 0, machine.cylinders[1].rod ? machine.cylinders[1].rod[1] : 0);
        plate(hull([[rod[0], rod[1], 0.09 * w], [0, 0, 0.19 * w], [0.25 * length, 0.14 * w, 0.18 * w]]), 0.26 * w, 0, paints.body, parent);
        const foot = pin([length, 0], 0, machine.cylinders[2].foot);
        plate(hull([[foot[0], foot[1], 0.09 * w], [foot[0] - 0.3 * w, 0.15 * w, 0.1 * w], [foot[0] + 0.4 * w, 0.15 * w, 0.1 * w]]), 0.16 * w, 0, paints.body, parent);
      }
      discs.push([0.25 * length, 0.12 * w, 0.22 * w]);
      plate(hull(discs), 0.3 * w, 0, paints.body, parent);
    };

    const makeBucket = (parent) => {
      const profile = machine.profile_m;
      const width = machine.width_m;
      const length = machine.lengths_m[2];
      if (profile.length > 2) {
        for (const side of [-1, 1]) plate(profile, 0.03, side * (width - 0.03) / 2, paints.steel, parent);
        const quads = [];
        for (let i = 0; i + 1 < profile.length; ++i) {
          const [a, b] = [profile[i], profile[i + 1]];
          const h = width / 2;
          quads.push(a[0], -h, a[1], b[0], -h, b[1], b[0], h, b[1], a[0], -h, a[1], b[0], h, b[1], a[0], h, a[1]);
        }
        const shell = new T.BufferGeometry();
        shell.setAttribute("position", new T.BufferAttribute(new Float32Array(quads), 3));
        shell.computeVertexNormals();
        parent.add(new T.Mesh(shell, paints.steel));
        const last = profile[profile.length - 1];
        const ear = [[0, 0, 0.1], [last[0], last[1], 0.06], [profile[profile.length - 2][0], profile[profile.length - 2][1] - 0.06, 0.06]];
        const bars = machine.cylinders && machine.cylinders[2].link;
        if (bars) ear.push([...along([0, 0], bars.pin[0], bars.pin[1]), 0.08]);
        for (const side of [-1, 1]) plate(hull(ear), 0.04, side * 0.2, paints.dark, parent);
        const teeth = machine.teeth;
        if (teeth) {
          const [tip, heel] = profile;
          const reach = Math.hypot(heel[0] - tip[0], heel[1] - tip[1]);
          const back = [(heel[0] - tip[0]) / reach, (heel[1] - tip[1]) / reach];
          const root = [tip[0] + back[0] * teeth.length_m, tip[1] + back[1] * teeth.length_m];
          const half = 0.035;
          const wedge = [tip, [root[0] - back[1] * half, root[1] + back[0] * half], [root[0] + back[1] * half, root[1] - back[0] * half]];
          for (let i = 0; i < teeth.count; ++i) {
            const y = (width - teeth.width_m) * ((i + 0.5) / teeth.count - 0.5);
            plate(wedge, teeth.width_m, y, paints.dark, parent);
          }
        }
      }
      const tip = new T.Object3D();
      tip.position.set(length, 0, 0);
      parent.add(tip);
      return tip;
    };

    let links = null;
    let tip = null;
    let soil = null;
    const rods = [];
    const bar = (radius, material, parent) => {
      const mesh = new T.Mesh(new T.CylinderGeometry(radius, radius, 1, 20), material);
      parent.add(mesh);
      return mesh;
    };
    const place = (mesh, a, b, y) => {
      const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
      mesh.position.set((a[0] + b[0]) / 2, y, (a[1] + b[1]) / 2);
      mesh.scale.y = length;
      mesh.rotation.set(Math.PI / 2, 0, 0);
      mesh.rotation.order = "YXZ";
      mesh.rotation.y = Math.PI / 2 - Math.atan2(b[1] - a[1], b[0] - a[0]);
    };

    const makeMachine = () => {
      const whole = new T.Group();
      tall.add(whole);
      makeBody(whole);
      links = [0, 1, 2].map(() => new T.Group());
      links[0].position.set(machine.boom_pin_m[0], 0, machine.boom_pin_m[1]);
      links[1].position.set(machine.lengths_m[0], 0, 0);
      links[2].position.set(machine.lengths_m[1], 0, 0);
      whole.add(links[0]);
      links[0].add(links[1]);
      links[1].add(links[2]);
      makeBoom(links[0]);
      makeArm(links[1]);
      tip = makeBucket(links[2]);
      soil = new T.Mesh(new T.BufferGeometry(), paints.soil);
      links[2].add(soil);
      const w = machine.lengths_m[0] / 4.6;
      (machine.cylinders || []).forEach((cylinder, i) => {
        const places = cylinder.count > 1 ? [-0.29 * w, 0.29 * w] : [0];
        for (const y of places) {
          rods.push({ i, y, kind: "barrel", mesh: bar((i ? 0.08 : 0.085) * w, paints.dark, whole), shortest: cylinder.shortest_m });
          rods.push({ i, y, kind: "rod", mesh: bar(0.045 * w, paints.rod, whole), shortest: cylinder.shortest_m });
        }
        if (!cylinder.rod) for (const n of [0, 1]) for (const y of [-0.13 * w, 0.13 * w]) rods.push({ i, y, kind: "bar", n, mesh: bar(0.045 * w, paints.dark, whole) });
      });
    };
    if (machine) makeMachine();

    let shownFill = -1;
    const pose = (joints, fill) => {
      links.forEach((link, i) => { link.rotation.y = joints[i]; });
      if (machine.cylinders) {
        const ends = cylindersOf(postureOf(joints));
        for (const each of rods) {
          const { foot, rod, bars } = ends[each.i];
          if (each.kind === "bar") { place(each.mesh, ...bars[each.n], each.y); continue; }
          const share = 0.9 * each.shortest / Math.hypot(rod[0] - foot[0], rod[1] - foot[1]);
          const middle = [foot[0] + share * (rod[0] - foot[0]), foot[1] + share * (rod[1] - foot[1])];
          place(each.mesh, ...(each.kind === "barrel" ? [foot, middle] : [middle, rod]), each.y);
        }
      }
      if (Math.abs(fill - shownFill) > 1e-4) {
        shownFill = fill;
        const outline = soilInBucket(fill);
        soil.visible = outline.length > 2;
        soil.geometry.dispose();
        if (soil.visible) soil.geometry = plateGeometry(outline, machine.width_inside_m, 0);
      }
    };

    // -- Path of the tip, in front of everything: two ribbons across each other
    const phaseColours = { approach: 0x8a8a8a, penetrate: 0xd55e00, drag: 0x2a86c8, scoop: 0x009e73, lift: 0xcc79a7 };
    let path = [];
    const ribbons = (stretch) => {
      const half = 0.018;
      const corners = [];
      for (const [a, b] of stretch) {
        const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
        const across = [-(b[1] - a[1]) * half / length, (b[0] - a[0]) * half / length];
        for (const [x, y, z] of [[across[0], 0, across[1]], [0, half, 0]]) {
          const quad = [[a, 1], [b, 1], [b, -1], [a, 1], [b, -1], [a, -1]];
          for (const [p, sign] of quad) corners.push(p[0] + sign * x, sign * y, p[1] + sign * z);
        }
      }
      return new Float32Array(corners);
    };
    const drawPath = () => {
      for (const mesh of path) { tall.remove(mesh); mesh.geometry.dispose(); }
      path = [];
      if (!dig) return;
      const stretches = {};
      for (let i = 1; i < dig.time_s.length; ++i) {
        (stretches[dig.phase[i]] = stretches[dig.phase[i]] || []).push(
          [[dig.tip_x_m[i - 1], dig.tip_z_m[i - 1]], [dig.tip_x_m[i], dig.tip_z_m[i]]]);
      }
      for (const phase in stretches) {
        const geometry = new T.BufferGeometry();
        geometry.setAttribute("position", new T.BufferAttribute(ribbons(stretches[phase]), 3));
        const material = new T.MeshBasicMaterial({ color: phaseColours[phase], side: T.DoubleSide, depthTest: false, transparent: true, opacity: 0.85 });
        const mesh = new T.Mesh(geometry, material);
        mesh.renderOrder = 5;
        tall.add(mesh);
        path.push(mesh);
      }
    };
    drawPath();

    // -- Marks: lengths along the edges, volumes of the zones
    const marks = [];
    const mark = (text, x, y, z, kind) => marks.push({
      node: htmlElement("span", { textContent: text, className: kind || "" }, element("marks")), at: [x, y, z],
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
      const labelled = new Set();
      for (const zone of scene.zones) {
        const [x0, y0, x1, y1] = zone.extent_m;
        if (labelled.has(zone.kind) || zone.kind === "other") continue;
        labelled.add(zone.kind);
        const side = zone.kind === "spill" ? y1 + 0.2 : (y0 + y1) / 2;
        mark(`${names[zone.kind]} ${zone.volume}`, (x0 + x1) / 2, side, range.high + 0.25, "zone");
      }
    };
    makeMarks();

    const projected = new T.Vector3();
    const placeMarks = () => {
      const taken = [];
      for (const { node, at } of marks) {
        projected.set(at[0], at[1], at[2] * tall.scale.z).project(camera);
        const visible = Math.abs(projected.x) < 0.98 && Math.abs(projected.y) < 0.96 && projected.z < 1;
        node.style.visibility = visible ? "visible" : "hidden";
        const x = (projected.x + 1) / 2 * stage.clientWidth;
        let y = (1 - projected.y) / 2 * stage.clientHeight;
        if (node.className === "zone") {
          while (taken.some((other) => Math.abs(other[0] - x) < 190 && Math.abs(other[1] - y) < 22)) y -= 4;
          taken.push([x, y]);
        }
        node.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
      }
    };

    // -- Camera
    const home = () => {
      const corners = [];
      const addBox = (x0, x1, y0, y1, z0, z1) => {
        for (const x of [x0, x1]) for (const y of [y0, y1]) for (const z of [z0, z1]) corners.push(new T.Vector3(x, y, z * tall.scale.z));
      };
      addBox(extent.x0, extent.x1, extent.y0, extent.y1, floor, areas.length ? range.high : 0);
      if (machine) {
        const s = machine.track_front_m / 1.8;
        const h = machine.boom_pin_m[1] / 1.424;
        addBox(-2.2 * s, s, -1.3 * s, 1.3 * s, 0, 2.8 * h);
        addBox(s, machine.boom_pin_m[0] + 0.9 * machine.lengths_m[0], 0, 0, 0, machine.boom_pin_m[1] + 0.55 * machine.lengths_m[0]);
      }
      const box = new T.Box3().setFromPoints(corners);
      box.getCenter(controls.target);
      // The longer side across; of ground that lies across, what the operator sees.
      const across = !machine && extent.y1 - extent.y0 > extent.x1 - extent.x0;
      const direction = new T.Vector3(...(across ? [-1, -0.35, 0.8] : [0.42, -1, machine ? 0.5 : 0.8])).normalize();
      // As near as all corners of the box allow.
      const half = Math.tan(camera.fov / 2 / degrees);
      const ahead = direction.clone().negate();
      const right = new T.Vector3().crossVectors(ahead, camera.up).normalize();
      const up = new T.Vector3().crossVectors(right, ahead);
      // The middle of what is seen, then the distance.
      const seen = { right: [Infinity, -Infinity], up: [Infinity, -Infinity] };
      for (const [name, axis] of [["right", right], ["up", up]]) {
        for (const corner of corners) {
          const at = corner.clone().sub(controls.target).dot(axis);
          seen[name] = [Math.min(seen[name][0], at), Math.max(seen[name][1], at)];
        }
      }
      controls.target.addScaledVector(right, (seen.right[0] + seen.right[1]) / 2).addScaledVector(up, (seen.up[0] + seen.up[1]) / 2);
      let distance = 0;
      for (const corner of corners) {
        const from = corner.clone().sub(controls.target);
        distance = Math.max(distance,
          -from.dot(ahead) + Math.abs(from.dot(up)) / half,
          -from.dot(ahead) + Math.abs(from.dot(right)) / (half * camera.aspect));
      }
      camera.position.copy(controls.target).addScaledVector(direction, distance * 1.05);
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
      htmlElement("div", { textContent: name === "change" ? "height change [cm]" : "height [m]" }, node);
      const ramp = htmlElement("div", { className: "ramp" }, node);
      const strip = htmlElement("i", {}, ramp);
      const texts = htmlElement("div", {}, ramp);
      if (name === "change") {
        const list = [...range.bands.slice().reverse().map((b) => [b, 1]), ...range.bands.map((b) => [b, -1])];
        const colours = [...range.bands.slice().reverse().map((b) => css(changeColour(b * 1.001))), css(still),
          ...range.bands.map((b) => css(changeColour(-b * 1.001)))];
        const share = (i) => `${(100 * i / colours.length).toFixed(2)}%`;
        strip.style.setProperty("--stops", colours.map((c, i) => `${c} ${share(i)}, ${c} ${share(i + 1)}`).join(","));
        ramp.style.setProperty("--length", `${colours.length * 15}px`);
        texts.className = "between";
        for (const [bound, sign] of list) htmlElement("span", { textContent: `${sign > 0 ? "+" : "−"}${+(bound * 100).toFixed(0)}` }, texts);
      } else {
        strip.style.setProperty("--stops", [4, 3, 2, 1, 0].map((i) => css(soilRamp[i])).join(","));
        for (const share of [1, 0.5, 0]) htmlElement("span", { textContent: signed(range.low + share * (range.high - range.low), 2) }, texts);
        htmlElement("div", { textContent: `lines every ${+contourStep.toFixed(2)} m` }, node);
      }
      if (areas.some((area) => area.states[0].some(Number.isNaN))) htmlElement("div", { textContent: "gaps: not seen" }, node);
      if (areas.some((area) => area.coarse)) htmlElement("div", { textContent: "drawn coarser than surveyed" }, node);
    };

    let shown = kinds[Math.min(1, kinds.length - 1)];
    const show = (kind) => {
      shown = kind;
      for (const list of meshes.values()) list.forEach((mesh) => { mesh.visible = false; });
      meshesOf(kind).forEach((mesh) => { mesh.visible = true; });
      zoneLines.forEach((line) => { line.visible = kind !== "before"; });
      legend(kind);
      for (const button of element("states").children) {
        button.setAttribute("aria-pressed", String(button.dataset.state === kind));
        button.textContent = nameOf(button.dataset.state);
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
    element("reset").addEventListener("click", () => { home(); ask(); });

    const turn = (around, tilt) => {
      const offset = camera.position.clone().sub(controls.target);
      const radius = offset.length();
      const azimuth = Math.atan2(offset.y, offset.x) + around;
      const polar = Math.min(Math.max(Math.acos(offset.z / radius) + tilt, 0.05), controls.maxPolarAngle);
      offset.set(Math.sin(polar) * Math.cos(azimuth), Math.sin(polar) * Math.sin(azimuth), Math.cos(polar));
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
      ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), ArrowUp: () => turn(0, -0.08), ArrowDown: () => turn(0, 0.08),
      "+": () => zoom(1 / 1.15), "=": () => zoom(1 / 1.15), "-": () => zoom(1.15), r: () => { home(); ask(); }, R: () => { home(); ask(); },
    };
    canvas.addEventListener("keydown", (event) => {
      if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
      keys[event.key]();
      event.preventDefault();
    });

    element("view").hidden = false;  // or it has no size
    resize();
    home();
    if (shown) show(shown); else legend("");
    new ResizeObserver(resize).observe(stage);
    return {
      pose: (joints, fill) => { pose(joints, fill); ask(); },
      changed: () => { drawPath(); if (shown) show(shown); },
      // Where the tip is drawn, x and z in metres.
      tip: () => {
        tip.updateWorldMatrix(true, false);
        const at = new T.Vector3().setFromMatrixPosition(tip.matrixWorld);
        return [at.x, at.z / tall.scale.z];
      },
    };
  };

  // ---- Section in the boom plane ----------------------------------------------------------------

  const makeSection = () => {
    const svg = element("profile");
    let draw = null;  // places of what moves

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
      const beside = stage.clientWidth > 0 && stage.clientWidth < 0.8 * element("scene").clientWidth && !printing;
      if (beside) box.z1 = Math.max(box.z1, box.z0 + (stage.clientHeight - bottom - 14) / scale);
      const height = Math.round(scale * (box.z1 - box.z0) + bottom + 12);
      const X = (x) => left + scale * (x - box.x0);
      const Z = (z) => 12 + scale * (box.z1 - z);
      svg.replaceChildren();
      svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
      svg.style.height = `${height}px`;
      const clip = svgElement("clipPath", { id: "inside" }, svgElement("defs", {}, svg));
      svgElement("rect", { x: left, y: 12, width: width - left - 14, height: height - bottom - 12 }, clip);
      const xs = ticks(box.x0, box.x1, Math.min(12, width / 50));
      const zs = ticks(box.z0, box.z1, Math.max(3, Math.min(9, height / 40)));
      const line = (x0, y0, x1, y1) => svgElement("line", { x1: x0, y1: y0, x2: x1, y2: y1, stroke: "var(--line)" }, svg);
      for (const x of xs.list) {
        line(X(x), 12, X(x), height - bottom);
        svgElement("text", { x: X(x), y: height - bottom + 15, "text-anchor": "middle" }, svg).textContent = signed(x, xs.digits);
      }
      for (const z of zs.list) {
        line(left, Z(z), width - 14, Z(z));
        svgElement("text", { x: left - 6, y: Z(z) + 4, "text-anchor": "end" }, svg).textContent = signed(z, zs.digits);
      }
      svgElement("text", { x: (left + width) / 2, y: height - 6, "text-anchor": "middle" }, svg).textContent = "x, from the swing axis [m]";
      svgElement("text", { x: 12, y: 10 + (height - bottom) / 2, "text-anchor": "middle", transform: `rotate(-90 12 ${10 + (height - bottom) / 2})` }, svg).textContent = "z [m]";
      const inside = svgElement("g", { "clip-path": "url(#inside)" }, svg);

      const soil = (state, fill, edge, thick) => {
        const height0 = profileOf(state);
        let stretch = [];
        const close = () => {
          if (stretch.length > 1) {
            const top = stretch.map(([x, z]) => `${X(x).toFixed(1)},${Z(z).toFixed(1)}`).join(" ");
            const base = Z(box.z0).toFixed(1);
            svgElement("polygon", { points: `${X(stretch[0][0]).toFixed(1)},${base} ${top} ${X(stretch[stretch.length - 1][0]).toFixed(1)},${base}`, fill: `var(--${fill})`, stroke: "none" }, inside);
            svgElement("polyline", { points: top, fill: "none", stroke: `var(--${edge})`, "stroke-width": thick }, inside);
          }
          stretch = [];
        };
        for (let i = 0; i <= 500; ++i) {
          const x = box.x0 + (box.x1 - box.x0) * i / 500;
          const z = height0(x);
          if (Number.isNaN(z)) close(); else stretch.push([x, z]);
        }
        close();
      };
      if (areas.length) soil(0, "soil-before", "edge-before", 1.2);
      if (lastState() > 0) soil(lastState(), "soil-after", "edge-after", 1.8);

      let stretch = [];
      const flush = (phase) => {
        svgElement("polyline", { points: stretch.join(" "), fill: "none", stroke: `var(--${phase})`, "stroke-width": 2.2, "stroke-linejoin": "round" }, inside);
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
        X, Z,
        links: svgElement("polyline", { fill: "none", stroke: "var(--steel)", "stroke-width": Math.max(4, 0.12 * scale), "stroke-linecap": "round", "stroke-linejoin": "round", opacity: 0.45 }, inside),
        soil: svgElement("polygon", { fill: "var(--soil-after)", stroke: "var(--edge-after)", "stroke-width": 1 }, inside),
        bucket: svgElement("polyline", { id: "bucket", fill: "none", stroke: "var(--ink)", "stroke-width": 2.4, "stroke-linejoin": "round" }, inside),
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
      const points = (list) => list.map((p) => `${X(p[0]).toFixed(2)},${Z(p[1]).toFixed(2)}`).join(" ");
      draw.links.setAttribute("points", points([posture.boomPin, posture.armPin, posture.bucketPin]));
      draw.bucket.setAttribute("points", points(machine.profile_m.length ? machine.profile_m.map((p) => bucketPoint(posture, p)) : [posture.bucketPin, posture.tip]));
      draw.soil.setAttribute("points", points(soilInBucket(fill).map((p) => bucketPoint(posture, p))));
      draw.tip.setAttribute("cx", X(posture.tip[0]).toFixed(2));
      draw.tip.setAttribute("cy", Z(posture.tip[1]).toFixed(2));
      draw.tip.dataset.x = posture.tip[0];
      draw.tip.dataset.z = posture.tip[1];
      element("tip-text").textContent = `tip at x ${signed(posture.tip[0], 2)} m, z ${signed(posture.tip[1], 2)} m`
        + (fill > 0 ? `; ${signed(fill, 3)} m³ in the bucket` : "");
    };

    return { lay: () => { lay(); key(); }, pose };
  };

  // ---- Charts -----------------------------------------------------------------------------------

  const chartsOf = () => {
    const joints = (lists, factor) => ["boom", "arm", "bucket"].map((name, i) => ({ name, colour: name, values: lists[i].map((v) => v * factor) }));
    const list = [
      { title: "Joint angles", unit: "°", digits: 1, times: dig.time_s, series: joints(dig.joints_rad, degrees) },
      { title: "Joint rates", unit: "°/s", digits: 1, times: dig.time_s, series: joints(dig.rates_rad_per_s, degrees) },
    ];
    const loads = dig.loads;
    if (!loads) return list;
    const size = loads.soil_x_kn.map((x, i) => Math.hypot(x, loads.soil_z_kn[i]));
    list.push(
      { title: "Joint torques", unit: "kN m", digits: 1, times: loads.time_s, series: joints(loads.torque_kn_m, 1) },
      { title: "Force of the soil on the bucket", unit: "kN", digits: 1, times: loads.time_s, series: [
        { name: "size", colour: "total", values: size },
        { name: "forward", colour: "boom", values: loads.soil_x_kn },
        { name: "up", colour: "arm", values: loads.soil_z_kn }] },
      { title: "Power of the joints", unit: "kW", digits: 1, times: loads.time_s, series: [{ name: "power", colour: "total", values: loads.power_kw }] },
      { title: "Energy of the dig so far", unit: "kJ", digits: 1, times: loads.energy_time_s, series: [{ name: "energy", colour: "total", values: loads.energy_kj }] },
      { title: "Soil in the bucket", unit: "m³", digits: 3, times: loads.time_s, series: [{ name: "loose volume", colour: "total", values: loads.fill_m3 }] });
    return list;
  };

  const makeCharts = (timeOf, setTime) => {
    const uPlot = globalThis.excavplanVendor.uPlot;
    let charts = [];

    const phases = () => {
      const list = [];
      dig.phase.forEach((phase, i) => {
        if (!list.length || list[list.length - 1].phase !== phase) list.push({ phase, from: dig.time_s[Math.max(0, i - 1)] });
        list[list.length - 1].to = dig.time_s[i];
      });
      return list;
    };

    const drawBands = (plot) => {
      const { ctx, bbox } = plot;
      ctx.save();
      ctx.fillStyle = theme().band;
      phases().forEach(({ from, to }, i) => {
        if (i % 2 === 0) return;
        const x0 = plot.valToPos(from, "x", true);
        ctx.fillRect(x0, bbox.top, plot.valToPos(to, "x", true) - x0, bbox.height);
      });
      ctx.restore();
    };
    const drawTime = (plot) => {
      const { ctx, bbox } = plot;
      const x = Math.round(plot.valToPos(timeOf(), "x", true)) + 0.5;
      ctx.save();
      ctx.strokeStyle = theme().ink;
      ctx.lineWidth = Math.max(1, devicePixelRatio || 1);
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      ctx.restore();
    };

    const make = (chart, node, width) => {
      const colours = theme();
      const axis = {
        stroke: colours.soft, font: "11px system-ui, sans-serif", labelFont: "11px system-ui, sans-serif",
        grid: { stroke: colours.line, width: 1 }, ticks: { stroke: colours.line, width: 1, size: 4 }, gap: 3,
      };
      const plot = new uPlot({
        width, height: 168, legend: { show: false },
        cursor: { y: false, points: { show: false }, drag: { setScale: false, x: false, y: false } },
        scales: { x: { time: false, range: () => [0, dig.time_s[dig.time_s.length - 1]] } },
        axes: [{ ...axis, size: 26, values: (_, list) => list.map((t) => `${t} s`) }, { ...axis, size: 44 }],
        series: [{}, ...chart.series.map((series) => ({ stroke: colours[series.colour], width: 1.8, points: { show: false } }))],
        hooks: { drawClear: [drawBands], draw: [drawTime] },
      }, [chart.times, ...chart.series.map((series) => series.values)], node);
      const take = (event) => setTime(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x"));
      plot.over.addEventListener("pointerdown", take);
      plot.over.addEventListener("pointermove", (event) => { if (event.buttons) take(event); });
      plot.over.style.touchAction = "pan-y";
      return plot;
    };

    const build = (width) => {
      const parent = element("charts");
      for (const { plot } of charts) plot.destroy();
      parent.replaceChildren();
      charts = chartsOf().map((chart) => {
        const card = htmlElement("div", { className: "chart" }, parent);
        const title = htmlElement("h3", { textContent: chart.title + " " }, card);
        htmlElement("small", { textContent: `[${chart.unit}]` }, title);
        const key = htmlElement("p", { className: "key" }, card);
        const texts = chart.series.map((series) => {
          const item = htmlElement("span", {}, key);
          htmlElement("i", {}, item).style.background = `var(--${series.colour})`;
          item.append(series.name + " ");
          return htmlElement("b", {}, item);
        });
        return { ...chart, card, texts, box: htmlElement("div", {}, card) };
      });
      for (const chart of charts) chart.plot = make(chart, chart.box, width || Math.max(200, chart.card.clientWidth - 24));
    };

    const update = () => {
      for (const chart of charts) {
        chart.plot.redraw(false, false);
        chart.series.forEach((series, i) => {
          const time = timeOf();
          const beyond = time > chart.times[chart.times.length - 1] + 0.2 || time < chart.times[0] - 0.2;
          chart.texts[i].textContent = beyond ? "–" : signed(valueAt(chart.times, series.values, time), chart.digits);
        });
      }
    };
    return { build, update, fit: () => charts.forEach((chart) => chart.plot.setSize({ width: Math.max(200, chart.card.clientWidth - 24), height: 168 })) };
  };

  // ---- Time -------------------------------------------------------------------------------------

  const playable = machine && dig && dig.time_s.length > 1;
  element("scene").classList.toggle("played", Boolean(playable));

  const view = makeView();
  document.body.classList.toggle("drawn", view !== null);
  element("view").hidden = view === null;
  element("no-view").hidden = view !== null;
  if (!machine) element("view-title").textContent = "Ground";

  let time = 0;

  const jointsAt = (t) => dig.joints_rad.map((list) => valueAt(dig.time_s, list, t));
  const fillAt = (t) => (dig.loads && dig.loads.time_s.length ? (t < dig.loads.time_s[0] ? 0 : valueAt(dig.loads.time_s, dig.loads.fill_m3, t)) : 0);

  const play = () => {
    const slider = element("time");
    const section = makeSection();
    let frame = 0;
    let charts = null;

    const show = () => {
      const joints = jointsAt(time);
      const fill = fillAt(time);
      if (view) view.pose(joints, fill);
      section.pose(joints, fill);
      charts.update();
      const [, at] = placeOf(dig.time_s, time);
      const text = `${time.toFixed(2)} s of ${dig.time_s[dig.time_s.length - 1].toFixed(2)} s`;
      element("now").textContent = `${text} · ${dig.phase[at]}`;
      slider.value = time;
      slider.setAttribute("aria-valuetext", `${text}, ${dig.phase[at]}`);
    };
    const setTime = (value) => {
      time = Math.min(Math.max(value, 0), dig.time_s[dig.time_s.length - 1]);
      show();
    };
    charts = makeCharts(() => time, setTime);

    const stop = () => {
      cancelAnimationFrame(frame);
      frame = 0;
      element("play").textContent = "▶";
      element("play").setAttribute("aria-label", "Play");
    };
    const start = () => {
      if (time >= dig.time_s[dig.time_s.length - 1] - 1e-6) setTime(0);
      element("play").textContent = "❚❚";
      element("play").setAttribute("aria-label", "Pause");
      let last = performance.now();
      const step = (now) => {
        setTime(time + Math.min(now - last, 100) / 1000);
        last = now;
        if (time >= dig.time_s[dig.time_s.length - 1]) stop(); else frame = requestAnimationFrame(step);
      };
      frame = requestAnimationFrame(step);
    };
    const toggle = () => (frame ? stop() : start());

    element("play").addEventListener("click", toggle);
    slider.addEventListener("input", () => { stop(); setTime(Number(slider.value)); });
    document.addEventListener("keydown", (event) => {
      if (event.key !== " " || event.target.closest("button, summary, select, a, textarea")) return;
      event.preventDefault();
      toggle();
    });

    const choose = () => {
      slider.max = dig.time_s[dig.time_s.length - 1];
      section.lay();
      charts.build();
      setTime(Math.min(time, dig.time_s[dig.time_s.length - 1]));
    };
    if (scene.digs.length > 1) {
      const list = element("dig");
      scene.digs.forEach((each, i) => htmlElement("option", { value: i, textContent: each.name }, list));
      element("dig-choice").hidden = false;
      list.addEventListener("change", () => {
        dig = scene.digs[Number(list.value)];
        if (view) view.changed();
        choose();
      });
    }
    for (const id of ["section", "charts", "player"]) element(id).hidden = false;
    choose();

    let width = 0;
    new ResizeObserver(() => {
      if (printing || element("scene").clientWidth === width) return;
      width = element("scene").clientWidth;
      section.lay();
      charts.fit();
      show();
    }).observe(element("scene"));
    return {
      redraw: (paperWidth) => { section.lay(); charts.build(paperWidth); show(); },
      setTime,
    };
  };
  const player = playable ? play() : null;
  if (!playable && view && machine && !dig) view.pose([-0.4, 1.5, 1.2], 0);

  // ---- Page -------------------------------------------------------------------------------------

  dark.addEventListener("change", () => { if (player) player.redraw(); });
  // On paper the view is the picture that is on the screen, scaled: a canvas drawn anew is not yet
  // there when the browser prints.
  const fitPaper = () => {
    const stage = element("stage");
    const [width, height] = [stage.clientWidth, stage.clientHeight];
    const scale = 650 / width;
    Object.assign(stage.style, { width: "650px", height: `${height * scale}px` });
    Object.assign(element("marks").style, {
      width: `${width}px`, height: `${height}px`, transformOrigin: "0 0", transform: `scale(${scale})`,
    });
  };
  addEventListener("beforeprint", () => {
    printing = true;
    if (view) fitPaper();
    if (player) player.redraw(285);
  });
  addEventListener("afterprint", () => {
    printing = false;
    for (const id of ["stage", "marks"]) element(id).removeAttribute("style");
    if (player) player.redraw();
  });

  element("copy").addEventListener("click", () => {
    const range = document.createRange();
    range.selectNodeContents(element("result"));
    getSelection().removeAllRanges();
    getSelection().addRange(range);
    element("copy").textContent = document.execCommand("copy") ? "Copied" : "Selected: copy with Ctrl+C";
  });

  requestAnimationFrame(() => requestAnimationFrame(() => {
    document.documentElement.dataset.drawnAfterMs = Math.round(performance.now());
  }));

  // For tests and for the console of the browser.
  globalThis.excavplanReport = { setTime: player && player.setTime, tip: view && player ? view.tip : null, time: () => time };
})();
