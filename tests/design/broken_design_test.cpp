// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>
#include <set>

#include <excavplan/base/error.hpp>
#include <excavplan/design/cut_and_fill.hpp>

#include "design_files.hpp"
#include "support/errors.hpp"

namespace excavplan::test {
namespace {

using std::string;

struct Good {
  string ending;
  string content;
};

std::vector<Good> good_files() {
  const PlainMesh mesh = battered_trench({2.3, -1.7});
  HeightMap grid = flat_ground({0, 0, 2, 1}, 0.25, 1.5);
  return {{"xml", land_xml(mesh, file_units[0])},
          {"dxf", dxf(dxf_faces(mesh), 6)},
          {"dxf", dxf(dxf_polyface(mesh), 6)},
          {"ply", ply_text(mesh)},
          {"ply", ply_binary(mesh)},
          {"obj", obj(mesh)},
          {"stl", stl_text(mesh)},
          {"stl", stl_binary(mesh)},
          {"asc", raster(grid, "asc", 1.0)},
          {"tif", raster(grid, "tif", 1.0)}};
}

/// A break of a file that makes another one of it, or the same where it finds no place.
string broken(const string& good, unsigned how, std::mt19937& random) {
  string text = good;
  const auto place = [&](std::size_t size) { return size == 0 ? 0 : random() % size; };
  const auto number_at = [&text](std::size_t from) {
    return text.find_first_of("0123456789", from);
  };
  const std::size_t at = place(text.size());
  switch (how) {
    case 0:  // ends early
      text.resize(at);
      break;
    case 1:  // a number becomes a word
      if (const std::size_t n = number_at(at); n != text.npos) text.replace(n, 1, "x");
      break;
    case 2:  // a part is missing
      text.erase(at, 1 + place(40));
      break;
    case 3:  // a part is there twice
      text.insert(at, text.substr(at, 1 + place(40)));
      break;
    case 4:  // an index or number is far too large
      if (const std::size_t n = number_at(at); n != text.npos) text.insert(n, "99999999999999");
      break;
    case 5:  // damaged bytes
      for (int i = 0; i < 4; ++i) text[place(text.size())] = static_cast<char>(random());
      break;
    case 6:  // a number is none
      if (const std::size_t n = number_at(at); n != text.npos) text.replace(n, 1, "nan");
      break;
    default:  // another file follows
      text += text.substr(0, at);
      break;
  }
  return text;
}

/// File, then a line, byte, tag, face or point, or the design as a whole.
bool names_place(const string& error, const string& path) {
  if (error.rfind(path + ": ", 0) != 0) return false;
  for (const char* place : {"line ", "byte ", "face ", "point ", "is empty"}) {
    if (error.find(place, path.size()) != error.npos) return true;
  }
  return false;
}

TEST(BrokenDesigns, EachGivesAnErrorWithItsPlaceOrASurface) {
  std::mt19937 random(20);
  int refused = 0, read = 0;
  for (const Good& good : good_files()) {
    for (int i = 0; i < 160; ++i) {
      const DesignFile file(good.ending,
                            broken(good.content, static_cast<unsigned>(i % 8), random));
      try {
        const DesignSurface design = read_design(file.path());
        EXPECT_TRUE(std::isfinite(area_in_plan(design)));
        ++read;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_file);
        EXPECT_TRUE(names_place(error.what(), file.path())) << error.what();
        ++refused;
      }
    }
  }
  // Damage that leaves a valid file, as of the digits of a number, cannot be told.
  EXPECT_GT(refused, 600);
  EXPECT_GT(read, 0);
}

/// Breaks that always leave no valid file.
std::vector<Good> hopeless(const Good& good) {
  std::vector<Good> list;
  for (std::size_t share = 0; share < 12; ++share) {  // cut off, down to nothing
    list.push_back({good.ending, good.content.substr(0, good.content.size() * share / 16)});
  }
  list.push_back({good.ending, string(100, '\0')});
  list.push_back({good.ending, "<html><body>404</body></html>"});
  list.push_back({good.ending, "1 2 3\n4 5 6\n"});
  list.push_back({good.ending, "PK\x03\x04" + good.content});
  list.push_back({good.ending, "{\"format\": \"design\"}"});
  list.push_back({good.ending, "\xFF\xFE" + good.content});
  list.push_back({good.ending, "\x89PNG\r\n\x1a\n" + good.content});
  list.push_back({good.ending, "ply\n" + good.content});
  return list;
}

TEST(BrokenDesigns, TwoHundredHopelessFilesAreAllRefused) {
  int files = 0;
  for (const Good& good : good_files()) {
    for (const Good& bad : hopeless(good)) {
      // An ASCII grid and OBJ or STL text that end within a line are refused by what is missing.
      if (good.ending == "obj" && bad.content.size() > 200 &&
          good.content.rfind(bad.content, 0) == 0) {
        continue;  // a shorter list of faces is a good one
      }
      const DesignFile file(bad.ending, bad.content);
      const string error = error_of([&] { read_design(file.path()); }, ErrorKind::bad_file);
      EXPECT_TRUE(names_place(error, file.path()))
          << good.ending << ", " << bad.content.size() << " bytes: " << error;
      ++files;
    }
  }
  EXPECT_GE(files, 190);
}

TEST(BrokenDesigns, PointsOfATinThatAreNotThere) {
  string text = land_xml(battered_trench({0, 0}), file_units[0]);
  const std::size_t begin = text.find("<Pnts>"), end = text.find("</Pnts>");
  text.erase(begin + 6, end - begin - 6);
  const DesignFile file("xml", text);
  const string error = error_of([&] { read_design(file.path()); }, ErrorKind::bad_file);
  EXPECT_NE(error.find("a face with the point 10, which the surface 'trench' does not have"),
            string::npos)
      << error;
}

TEST(BrokenDesigns, EntitiesThatGrowAreNotExpanded) {
  const DesignFile file(
      "xml",
      "<?xml version=\"1.0\"?><!DOCTYPE LandXML [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;&a;\">]>"
      "<LandXML>&b;</LandXML>");
  EXPECT_NE(error_of([&] { read_design(file.path()); }, ErrorKind::bad_file)
                .find("line 1: found a document type"),
            string::npos);
}

}  // namespace
}  // namespace excavplan::test
