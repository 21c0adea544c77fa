// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// Postures of the machine, in the convention of include/excavplan/machine/machine.hpp, and the soil
// in its bucket.

const along = (from, length, angle) => [
  from[0] + length * Math.cos(angle),
  from[1] + length * Math.sin(angle),
];

const postureOf = (joints) => {
  const phi = [-joints[0], -joints[0] - joints[1], -joints[0] - joints[1] - joints[2]];
  const boomPin = machine.boom_pin_m;
  const armPin = along(boomPin, machine.lengths_m[0], phi[0]);
  const bucketPin = along(armPin, machine.lengths_m[1], phi[1]);
  return { phi, boomPin, armPin, bucketPin, tip: along(bucketPin, machine.lengths_m[2], phi[2]) };
};

const bucketPoint = (posture, point) =>
  along(along(posture.bucketPin, point[0], posture.phi[2]), point[1], posture.phi[2] + Math.PI / 2);

const pin = (at, direction, polar) => along(at, polar[0], direction + polar[1]);

// Where two bars from `a` and `b` meet, on the other side of the line between them than `away`.
const joinOf = (a, lengthA, b, lengthB, away) => {
  const dx = b[0] - a[0];
  const dy = b[1] - a[1];
  const distance = Math.hypot(dx, dy);
  const foot = (distance * distance + lengthA * lengthA - lengthB * lengthB) / (2 * distance);
  const height = Math.sqrt(Math.max(0, lengthA * lengthA - foot * foot));
  const side = dx * (away[1] - a[1]) - dy * (away[0] - a[0]) > 0 ? -1 : 1;
  return [
    a[0] + (foot * dx - side * height * dy) / distance,
    a[1] + (foot * dy + side * height * dx) / distance,
  ];
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
    return {
      foot,
      rod,
      bars: [
        [rocker, rod],
        [link, rod],
      ],
    };
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
      if (a * b < 0)
        cut.push([p[0] + ((q[0] - p[0]) * a) / (a - b), p[1] + ((q[1] - p[1]) * a) / (a - b)]);
    });
    return cut;
  };
  const sizeOf = (polygon) =>
    Math.abs(
      polygon.reduce((sum, p, i) => {
        const q = polygon[(i + 1) % polygon.length];
        return sum + (p[0] * q[1] - q[0] * p[1]) / 2;
      }, 0),
    );
  const struck = sizeOf(profile);
  if (area >= struck) {
    const height = Math.min((2 * (area - struck)) / length, length / 2);
    const top = [0.35, 0.65].map((share) => [
      last[0] + share * (first[0] - last[0]) - inside * normal[0] * height * 0.75,
      last[1] + share * (first[1] - last[1]) - inside * normal[1] * height * 0.75,
    ]);
    return profile.concat(top);
  }
  let low = 0;
  let high = Math.max(...profile.map((p) => inside * depth(p)));
  for (let i = 0; i < 30; ++i) {
    const middle = (low + high) / 2;
    if (sizeOf(below(middle)) > area) low = middle;
    else high = middle;
  }
  return below((low + high) / 2);
};
