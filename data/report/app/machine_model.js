// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The excavator in three dimensions, from the numbers of the machine.

const makeMachineModel = (T, parent) => {
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
        const angle = (i * Math.PI) / 12;
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
      plate(
        hull([
          [-front, radius, radius],
          [front, radius, radius],
        ]),
        0.5 * s,
        side * s,
        paints.dark,
        parent,
      );
      plate(
        hull([
          [-front, radius, 0.26 * h],
          [front, radius, 0.26 * h],
        ]),
        0.52 * s,
        side * s,
        paints.steel,
        parent,
      );
    }
    box(-0.9 * s, 0.9 * s, -0.8 * s, 0.8 * s, 0.35 * h, 0.75 * h, paints.dark, parent);
    const ring = new T.Mesh(new T.CylinderGeometry(0.6 * s, 0.6 * s, 0.2 * h, 40), paints.dark);
    ring.rotation.x = Math.PI / 2;
    ring.position.z = 0.84 * h;
    parent.add(ring);
    box(-1.9 * s, 0.95 * s, -1.2 * s, 1.2 * s, 0.92 * h, 1.12 * h, paints.body, parent);
    box(-1.5 * s, -0.25 * s, -1.2 * s, 1.2 * s, 1.12 * h, 1.95 * h, paints.body, parent);
    box(-0.25 * s, 0.8 * s, -1.2 * s, -0.45 * s, 1.12 * h, 1.7 * h, paints.body, parent);
    const back = hull([
      [-1.62 * s, 1.14 * h, 0.16 * h],
      [-1.9 * s, 1.2 * h, 0.2 * h],
      [-1.92 * s, 1.78 * h, 0.18 * h],
      [-1.5 * s, 1.88 * h, 0.08 * h],
    ]);
    plate(back, 2.36 * s, 0, paints.dark, parent);
    const cab = [
      [-0.2 * s, 1.12 * h],
      [1.0 * s, 1.12 * h],
      [1.08 * s, 1.75 * h],
      [0.85 * s, 2.72 * h],
      [-0.2 * s, 2.72 * h],
    ];
    plate(cab, 0.9 * s, 0.72 * s, paints.body, parent);
    const glass = [
      [0.0, 1.62 * h],
      [0.98 * s, 1.62 * h],
      [1.0 * s, 1.75 * h],
      [0.8 * s, 2.6 * h],
      [0.0, 2.6 * h],
    ];
    plate(glass, 0.93 * s, 0.72 * s, paints.glass, parent);
    box(0.97 * s, 1.01 * s, 0.34 * s, 1.1 * s, 1.75 * h, 1.78 * h, paints.dark, parent);
    const foot = hull([
      [machine.boom_pin_m[0], machine.boom_pin_m[1], 0.2 * h],
      [-0.2 * s, 1.1 * h, 0.1],
      [0.65 * s, 1.02 * h, 0.1],
    ]);
    for (const side of [-1, 1]) plate(foot, 0.06, side * 0.27 * s, paints.body, parent);
  };

  const makeBoom = (parent) => {
    const [length] = machine.lengths_m;
    const cylinders = machine.cylinders;
    const knee =
      cylinders && cylinders[0].rod
        ? along([0, 0], cylinders[0].rod[0], cylinders[0].rod[1])
        : [0.42 * length, 0.19 * length];
    const w = length / 4.6;
    const top = [knee[0] + 0.12 * length, knee[1] + 0.02 * length];
    plate(
      hull([
        [0, 0, 0.19 * w],
        [knee[0], knee[1], 0.27 * w],
      ]),
      0.38 * w,
      0,
      paints.body,
      parent,
    );
    plate(
      hull([
        [knee[0], knee[1], 0.27 * w],
        [top[0], top[1], 0.24 * w],
      ]),
      0.38 * w,
      0,
      paints.body,
      parent,
    );
    plate(
      hull([
        [top[0], top[1], 0.24 * w],
        [length, 0, 0.15 * w],
      ]),
      0.38 * w,
      0,
      paints.body,
      parent,
    );
    if (!cylinders) return;
    const foot = pin([length, 0], 0, cylinders[1].foot);
    plate(
      hull([
        [foot[0], foot[1], 0.1 * w],
        [top[0] - 0.2 * w, top[1], 0.1 * w],
        [top[0] + 0.25 * w, top[1] - 0.12 * w, 0.1 * w],
      ]),
      0.2 * w,
      0,
      paints.body,
      parent,
    );
  };

  const makeArm = (parent) => {
    const length = machine.lengths_m[1];
    const w = length / 2.5;
    const discs = [
      [0, 0, 0.19 * w],
      [length, 0, 0.12 * w],
    ];
    if (machine.cylinders) {
      const rod = along(
        [0, 0],
        machine.cylinders[1].rod ? machine.cylinders[1].rod[0] : 0,
        machine.cylinders[1].rod ? machine.cylinders[1].rod[1] : 0,
      );
      plate(
        hull([
          [rod[0], rod[1], 0.09 * w],
          [0, 0, 0.19 * w],
          [0.25 * length, 0.14 * w, 0.18 * w],
        ]),
        0.26 * w,
        0,
        paints.body,
        parent,
      );
      const foot = pin([length, 0], 0, machine.cylinders[2].foot);
      plate(
        hull([
          [foot[0], foot[1], 0.09 * w],
          [foot[0] - 0.3 * w, 0.15 * w, 0.1 * w],
          [foot[0] + 0.4 * w, 0.15 * w, 0.1 * w],
        ]),
        0.16 * w,
        0,
        paints.body,
        parent,
      );
    }
    discs.push([0.25 * length, 0.12 * w, 0.22 * w]);
    plate(hull(discs), 0.3 * w, 0, paints.body, parent);
  };

  const makeBucket = (parent) => {
    const profile = machine.profile_m;
    const width = machine.width_m;
    const length = machine.lengths_m[2];
    if (profile.length > 2) {
      for (const side of [-1, 1])
        plate(profile, 0.03, (side * (width - 0.03)) / 2, paints.steel, parent);
      const quads = [];
      for (let i = 0; i + 1 < profile.length; ++i) {
        const [a, b] = [profile[i], profile[i + 1]];
        const h = width / 2;
        quads.push(
          a[0],
          -h,
          a[1],
          b[0],
          -h,
          b[1],
          b[0],
          h,
          b[1],
          a[0],
          -h,
          a[1],
          b[0],
          h,
          b[1],
          a[0],
          h,
          a[1],
        );
      }
      const shell = new T.BufferGeometry();
      shell.setAttribute("position", new T.BufferAttribute(new Float32Array(quads), 3));
      shell.computeVertexNormals();
      parent.add(new T.Mesh(shell, paints.steel));
      const last = profile[profile.length - 1];
      const ear = [
        [0, 0, 0.1],
        [last[0], last[1], 0.06],
        [profile[profile.length - 2][0], profile[profile.length - 2][1] - 0.06, 0.06],
      ];
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
        const wedge = [
          tip,
          [root[0] - back[1] * half, root[1] + back[0] * half],
          [root[0] + back[1] * half, root[1] - back[0] * half],
        ];
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
    parent.add(whole);
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
        rods.push({
          i,
          y,
          kind: "barrel",
          mesh: bar((i ? 0.08 : 0.085) * w, paints.dark, whole),
          shortest: cylinder.shortest_m,
        });
        rods.push({
          i,
          y,
          kind: "rod",
          mesh: bar(0.045 * w, paints.rod, whole),
          shortest: cylinder.shortest_m,
        });
      }
      if (!cylinder.rod)
        for (const n of [0, 1])
          for (const y of [-0.13 * w, 0.13 * w])
            rods.push({ i, y, kind: "bar", n, mesh: bar(0.045 * w, paints.dark, whole) });
    });
  };
  makeMachine();

  let shownFill = -1;
  const pose = (joints, fill) => {
    links.forEach((link, i) => {
      link.rotation.y = joints[i];
    });
    if (machine.cylinders) {
      const ends = cylindersOf(postureOf(joints));
      for (const each of rods) {
        const { foot, rod, bars } = ends[each.i];
        if (each.kind === "bar") {
          place(each.mesh, ...bars[each.n], each.y);
          continue;
        }
        const share = (0.9 * each.shortest) / Math.hypot(rod[0] - foot[0], rod[1] - foot[1]);
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

  return { pose, tip };
};
