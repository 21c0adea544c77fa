// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// Ground of an area as a mesh, with walls down to the floor and lines of equal height.

const makeGroundMesher = (T, floor, contourStep) => {
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

  const mesh = (area, z) => {
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
    const top = new T.Mesh(geometry, surface);
    const border = new T.BufferGeometry();
    border.setAttribute("position", new T.BufferAttribute(new Float32Array(skirt), 3));
    border.computeVertexNormals();
    top.add(new T.Mesh(border, sides));
    return top;
  };

  const linear = new T.Color();
  const paint = (top, colours) => {
    const attribute = top.geometry.getAttribute("color");
    for (let i = 0; i < attribute.count; ++i) {
      const c = colours(i);
      linear.setRGB(c[0], c[1], c[2], "srgb");
      attribute.setXYZ(i, linear.r, linear.g, linear.b);
    }
    attribute.needsUpdate = true;
  };

  return { mesh, paint };
};
