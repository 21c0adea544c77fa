// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// Numbers of cells from their codes, as src/job/cell_codes.hpp says.

const unknownHeight = -(2 ** 30);

const numbersOf = (codes, count) => {
  const bytes = bytesOf(codes);
  const numbers = new Float64Array(count);
  let at = 0;
  const next = () => {
    let number = 0;
    for (let factor = 1; ; factor *= 128) {
      const byte = bytes[at++];
      number += (byte & 127) * factor;
      if (byte < 128) return number;
    }
  };
  for (let i = 0; i < count; ++i) {
    const code = next();
    numbers[i] = code % 2 ? -(code + 1) / 2 : code / 2;
    if (code === 0) i += next();
  }
  return numbers;
};

// Each number was coded less the one before it.
const summedNumbersOf = (codes, count) => {
  const numbers = numbersOf(codes, count);
  for (let i = 1; i < count; ++i) numbers[i] += numbers[i - 1];
  return numbers;
};

const metresOf = (millimetres) =>
  millimetres.map((height) => (height === unknownHeight ? NaN : height / 1000));
