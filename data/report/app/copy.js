// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The button that copies the JSON.

element("copy").addEventListener("click", () => {
  const range = document.createRange();
  range.selectNodeContents(element("result"));
  getSelection().removeAllRanges();
  getSelection().addRange(range);
  element("copy").textContent = document.execCommand("copy")
    ? "Copied"
    : "Selected: copy with Ctrl+C";
});
