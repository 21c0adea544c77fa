// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "pictures.hpp"

#include <array>

#include <excavplan/base/error.hpp>

#include "texts.hpp"
#include "words.hpp"

namespace excavplan::python {
namespace {

using py::arg;

ImageFormat format_of(const std::string& file) {
  const std::array<std::pair<const char*, ImageFormat>, 3> endings = {
      {{".svg", ImageFormat::svg}, {".png", ImageFormat::png}, {".pdf", ImageFormat::pdf}}};
  for (const auto& [ending, format] : endings) {
    const std::size_t start = file.size() - std::min<std::size_t>(file.size(), 4);
    const std::string own = py::str(text(file.substr(start)).attr("lower")());
    if (own == ending) return format;
  }
  throw Error(ErrorKind::bad_input, "the file " + file + " ends in none of .svg, .png, .pdf");
}

}  // namespace

void write_bytes(const File& file, const std::string& content) {
  const py::object stream = py::module_::import("io").attr("open")(py::bytes(file.path), "wb");
  stream.attr("write")(py::bytes(content));
  stream.attr("close")();
}

Picture plotted(Call& call, const std::optional<File>& file,
                const std::function<std::string(ImageFormat)>& draw) {
  const ImageFormat format = file ? format_of(file->path) : ImageFormat::svg;
  const Picture picture = {call.run([&] { return draw(ImageFormat::svg); })};
  if (!file) return picture;
  const bool is_same = format == ImageFormat::svg;
  write_bytes(*file, is_same ? picture.svg : call.run([&] { return draw(format); }));
  return picture;
}

Picture plotted(const std::optional<File>& file,
                const std::function<std::string(ImageFormat)>& draw) {
  Call own;
  return plotted(own, file, draw);
}

DigImage dig_image_of(const std::string& word) {
  return of_word<DigImage>("the plot", word,
                           {{"section", DigImage::section},
                            {"forces", DigImage::forces},
                            {"torques", DigImage::torques},
                            {"power", DigImage::power},
                            {"cylinders", DigImage::cylinders}});
}

void bind_pictures(py::module_& module) {
  py::class_<Picture>(module, "Picture", "A figure of a result, which a notebook shows.")
      .def_property_readonly(
          "svg", [](const Picture& picture) { return text(picture.svg); }, "The image as text.")
      .def(
          "save", [](const Picture& picture, const File& file) { write_bytes(file, picture.svg); },
          arg("file"), "Writes an .svg file; plot(file=...) of the result also .png and .pdf.")
      .def("_repr_svg_", [](const Picture& picture) { return text(picture.svg); })
      .def("__repr__", [](const Picture& picture) {
        return "<Picture: SVG of " + std::to_string(picture.svg.size()) + " bytes>";
      });
}

}  // namespace excavplan::python
