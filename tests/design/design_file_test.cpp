// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/design/design_file.hpp>

#include <cmath>
#include <filesystem>

#include <excavplan/design/cut_and_fill.hpp>

#include "design_files.hpp"
#include "support/errors.hpp"

namespace excavplan::test {
namespace {

using std::string;

struct Written {
  const char* format;
  string ending;
  string content;
  bool tells_unit;
};

std::vector<Written> meshes(const PlainMesh& metres, const FileUnit& unit) {
  const PlainMesh mesh = scaled(metres, 1.0 / unit.length);
  return {{"LandXML", "xml", land_xml(mesh, unit), true},
          {"3DFACE", "dxf", dxf(dxf_faces(mesh), unit.dxf), true},
          {"polyface", "dxf", dxf(dxf_polyface(mesh), unit.dxf), true},
          {"PLY text", "ply", ply_text(mesh), false},
          {"PLY binary", "ply", ply_binary(mesh), false},
          {"OBJ", "obj", obj(mesh), false},
          {"STL text", "stl", stl_text(mesh), false}};
}

DesignSurface read_written(const Written& written, const FileUnit& unit) {
  const DesignFile file(written.ending, written.content);
  DesignFileOptions options;
  if (!written.tells_unit) options.unit = unit.length;
  return read_design(file.path(), options);
}

/// Ground at 0 around a place.
HeightMap level_ground(const Eigen::Vector2d& at, double cell) {
  return flat_ground({at.x() - 3.0, at.y() - 3.0, at.x() + 18.0, at.y() + 8.0}, cell);
}

double cut_of(const DesignSurface& design, const HeightMap& ground) {
  const CutAndFill volumes = cut_and_fill(design, ground);
  EXPECT_NEAR(volumes.fill.value, 0.0, 1e-5);
  return volumes.cut.value;
}

TEST(DesignFile, ATrenchHasTheSameCutInAllFormatsAndUnits) {
  const Eigen::Vector2d at(2.3, -1.7);
  const HeightMap ground = level_ground(at, 0.05);
  for (const FileUnit& unit : file_units) {
    for (const Written& written : meshes(battered_trench(at), unit)) {
      const DesignSurface design = read_written(written, unit);
      EXPECT_NEAR(cut_of(design, ground) / trench_volume, 1.0, 1e-9)
          << written.format << " in " << unit.name;
    }
    const PlainMesh mesh = scaled(battered_trench(at), 1.0 / unit.length);
    const Written floats = {"STL binary", "stl", stl_binary(mesh), false};
    EXPECT_NEAR(cut_of(read_written(floats, unit), ground) / trench_volume, 1.0, 1e-5) << unit.name;
  }
}

TEST(DesignFile, FarFromTheOriginNothingIsLost) {
  const Eigen::Vector2d at(512345.125, 5412345.5);
  const HeightMap ground = level_ground(at, 0.05);
  for (const FileUnit& unit : file_units) {
    for (const Written& written : meshes(battered_trench(at), unit)) {
      EXPECT_NEAR(cut_of(read_written(written, unit), ground) / trench_volume, 1.0, 1e-8)
          << written.format << " in " << unit.name;
    }
  }
}

TEST(DesignFile, RastersOfItCutTheSameToAPercent) {
  const Eigen::Vector2d at(2.3, -1.7);
  const HeightMap ground = level_ground(at, 0.05);
  const Written tin = meshes(battered_trench(at), file_units[0])[0];
  HeightMap grid = level_ground(at, 0.04);
  const DesignCover cover = cover_of(read_written(tin, file_units[0]), grid);
  grid.z = (cover.share >= 0.5).select(cover.height, std::nan(""));
  for (const FileUnit& unit : file_units) {
    for (const string ending : {"asc", "tif"}) {
      const DesignFile file(ending, raster(grid, ending, unit.length));
      DesignFileOptions options;
      options.unit = unit.length;
      EXPECT_NEAR(cut_of(read_design(file.path(), options), ground) / trench_volume, 1.0, 0.01)
          << ending << " in " << unit.name;
    }
  }
}

TEST(DesignFile, APointOfLandXmlIsNorthingBeforeEasting) {
  const PlainMesh mesh = {{{10, 20, 1}, {11, 20, 1}, {10, 22, 1}}, {{0, 1, 2}}};
  const DesignFile file("xml", land_xml(mesh, file_units[0]));
  const Rectangle all = extent_of(read_design(file.path()));
  EXPECT_DOUBLE_EQ(all.x_min, 10.0);
  EXPECT_DOUBLE_EQ(all.x_max, 11.0);
  EXPECT_DOUBLE_EQ(all.y_max, 22.0);
}

string replaced(string text, const string& from, const string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

string good_land_xml() { return land_xml(battered_trench({0, 0}), file_units[0]); }

string land_xml_error(const string& content, const DesignFileOptions& options = {}) {
  const DesignFile file("xml", content);
  return error_about([&] { read_design(file.path(), options); }, file.path());
}

TEST(LandXml, InvisibleFacesAreLeftOut) {
  const DesignFile whole("xml", good_land_xml());
  const DesignFile part("tin.xml", replaced(good_land_xml(), "<F>", "<F i=\"1\">"));
  const DesignSurface design = read_design(part.path());
  EXPECT_NEAR(area_in_plan(read_design(whole.path())) - area_in_plan(design), 7.5, 1e-9);
  ASSERT_EQ(design.notes.size(), 1u);
  EXPECT_EQ(design.notes[0], "1 invisible faces were left out");
}

TEST(LandXml, PointsOfTheSurfaceItselfAreRead) {
  string text = replaced(good_land_xml(), "<Definition surfType=\"TIN\">", "");
  const DesignFile file("xml", replaced(text, "</Definition>", ""));
  EXPECT_NEAR(area_in_plan(read_design(file.path())), 15.5 * 1.5, 1e-9);
}

TEST(LandXml, FacesMayHaveFourCornersAndSeveralLists) {
  string text = replaced(good_land_xml(), "<F>10 17 24</F>\n<F>10 24 31</F>",
                         "<F>10 17 24 31</F></Faces><Faces>");
  const DesignFile file("xml", text);
  EXPECT_NEAR(area_in_plan(read_design(file.path())), 15.5 * 1.5, 1e-9);
}

TEST(LandXml, OfSeveralSurfacesOneIsNamed) {
  const string good = good_land_xml();
  const std::size_t begin = good.find("<Surface name"), end = good.find("</Surfaces>");
  const string other = replaced(good.substr(begin, end - begin), "trench", "other");
  const string two = replaced(good, "</Surfaces>", other + "</Surfaces>");
  EXPECT_EQ(land_xml_error(two),
            "line 59: found 2 surfaces that may be the design, expected one: name it, of 'trench', "
            "'other'");
  DesignFileOptions options;
  options.surface = "other";
  const DesignFile file("xml", two);
  EXPECT_EQ(read_design(file.path(), options).name, "other");
  options.surface = "none";
  EXPECT_NE(land_xml_error(two, options).find("found no surface 'none', only 'trench', 'other'"),
            string::npos);
  const DesignFile existing("xml", replaced(two, "name=\"other\"", "name=\"ExistingGround\""));
  EXPECT_EQ(read_design(existing.path()).name, "trench");
}

TEST(LandXml, WhatItMustSayIsAskedFor) {
  const string good = good_land_xml();
  const std::vector<std::pair<string, string>> cases = {
      {replaced(good, file_units[0].land_xml, ""), "found no units"},
      {replaced(good, "linearUnit=\"meter\"", "linearUnit=\"foot\""),
       "the linearUnit 'foot' of Metric"},
      {replaced(good, "<Units>", "<Units><Imperial linearUnit=\"foot\"/>"),
       "a second list of units"},
      {replaced(good, "<?xml version=\"1.0\"?>",
                "<?xml version=\"1.0\"?><!DOCTYPE x [<!ENTITY a \"b\">]>"),
       "line 1: found a document type"},
      {replaced(good, "<P id=\"10\">", "<P id=\"0\">"), "line 8: found a point with the id '0'"},
      {replaced(good, "<P id=\"10\">", "<P id=\"17\">"),
       "line 9: found a second point with the id 17"},
      {replaced(good, "<F>10 17 24", "<F>10 17 25"), "a face with the point 25"},
      {replaced(good, "<F>10 17 24", "<F>10 17"), "found 2 ids, expected three or four"},
      {replaced(good, "</Pnts>", "<P id=\"9\">1 2</P></Pnts>"),
       "expected northing, easting and elevation"},
      {replaced(good, "<P id=\"10\">", "<P id=\"10\" pntRef=\"1\">"),
       "a point that refers to another"},
      {replaced(good, "</LandXML>", ""), "found XML that is not well formed"}};
  for (const auto& [content, expected] : cases) {
    const string error = land_xml_error(content);
    EXPECT_NE(error.find(expected), string::npos) << error;
    EXPECT_EQ(error.rfind("line ", 0), 0u) << error;
  }
}

TEST(LandXml, BreaklinesAloneAreNoSurface) {
  const string text =
      "<LandXML><Units><Metric linearUnit=\"meter\"/></Units><Surfaces><Surface name=\"a\">"
      "<SourceData><Breaklines><Breakline><PntList3D>1 2 3 4 5 6</PntList3D></Breakline>"
      "</Breaklines></SourceData></Surface></Surfaces></LandXML>";
  EXPECT_NE(land_xml_error(text).find("export it with its triangles"), string::npos);
}

/// A square of one unit at a place, as a block.
string block(const string& name, const Eigen::Vector3d& base, const string& inside) {
  return group(0, "BLOCK") + group(2, name) + dxf_place(base, 0) + inside + group(0, "ENDBLK");
}
const PlainMesh unit_square = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                               {{0, 1, 2}, {0, 2, 3}}};

TEST(Dxf, BlocksAreTurnedScaledRepeatedAndNested) {
  const string inner = block("inner", {1, 0, 0}, dxf_faces(unit_square));
  const string outer =
      block("outer", {0, 0, 0},
            group(0, "INSERT") + group(2, "inner") + dxf_place({10, 0, 0}, 0) + group(41, "2"));
  const string insert = group(0, "INSERT") + group(2, "outer") + dxf_place({100, 0, 5}, 0) +
                        group(50, "90") + group(70, "3") + group(44, "50");
  const DesignFile file("dxf", dxf(insert, 6, inner + outer));
  const DesignSurface design = read_design(file.path());
  EXPECT_NEAR(area_in_plan(design), 3 * 2.0, 1e-12);
  const Rectangle all = extent_of(design);
  EXPECT_NEAR(all.x_min, 99.0, 1e-9);
  EXPECT_NEAR(all.x_max, 100.0, 1e-9);
  EXPECT_NEAR(all.y_min, 8.0, 1e-9);
  EXPECT_NEAR(all.y_max, 110.0, 1e-9);
}

// Flat drawings leave z out.
TEST(Dxf, ACoordinateThatIsNotToldIsNought) {
  const auto flat = [](const string& place) { return place.substr(0, place.find(" 30\n") - 1); };
  string inside = group(0, "POLYLINE") + group(8, "0") + group(70, "64");
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 5), {1, 0, 5}, {0, 1, 5}}) {
    inside += group(0, "VERTEX") + dxf_place(p, 0) + group(70, "192");
  }
  inside += group(0, "VERTEX") + flat(dxf_place({1, 1, 0}, 0)) + group(70, "192");
  inside += group(0, "VERTEX") + group(70, "128") + group(71, "2") + group(72, "4") +
            group(73, "3") + group(0, "SEQEND");
  const string insert = group(0, "INSERT") + group(2, "b") + flat(dxf_place({100, 0, 0}, 0));
  const DesignFile file("dxf", dxf(insert, 6, block("b", {0, 0, 0}, inside)));
  const DesignSurface design = read_design(file.path());
  const auto& tin = std::get<Tin>(design.shape);
  EXPECT_EQ(tin.origin, Eigen::Vector3d(101, 0, 5));
  EXPECT_EQ(tin.points.at(1), Eigen::Vector3d(0, 1, -5));
}

TEST(Dxf, LayersAreChosenAndOfABlockItIsThatOfItsPlace) {
  const string faces = dxf_faces(unit_square);
  const string insert =
      group(0, "INSERT") + group(8, "design") + group(2, "b") + dxf_place({0, 0, 0}, 0);
  const DesignFile file("dxf", dxf(faces + insert, 6, block("b", {0, 0, 0}, faces)));
  DesignFileOptions options;
  options.layers = {"design"};
  EXPECT_NEAR(area_in_plan(read_design(file.path(), options)), 1.0, 1e-12);
  EXPECT_NEAR(area_in_plan(read_design(file.path())), 2.0, 1e-12);
}

TEST(Dxf, ABlockInItselfIsRefused) {
  const string insert = group(0, "INSERT") + group(2, "b") + dxf_place({0, 0, 0}, 0);
  const DesignFile file("dxf", dxf(insert, 6, block("b", {0, 0, 0}, insert)));
  const string error = error_about([&] { read_design(file.path()); }, file.path());
  EXPECT_NE(error.find("in more than 16 levels of blocks"), string::npos) << error;
}

TEST(Obj, AFaceOfTwoCornersIsRefused) {
  const DesignFile file("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n");
  const string error = error_about([&] { read_design(file.path()); }, file.path());
  EXPECT_NE(error.find("2 corners"), string::npos) << error;
}

TEST(DesignFile, TheUnitThatWasTakenIsTold) {
  const PlainMesh mesh = battered_trench({0, 0});
  const DesignFile ply("ply", ply_text(mesh));
  EXPECT_EQ(read_design(ply.path()).unit_told_by, "nothing: metres taken");
  const DesignFile drawing("dxf", dxf(dxf_faces(mesh), 2));
  EXPECT_EQ(read_design(drawing.path()).unit_told_by, "$INSUNITS 2: foot");
  DesignFileOptions options;
  options.unit = 1.0;
  EXPECT_NEAR(area_in_plan(read_design(drawing.path(), options)), 15.5 * 1.5, 1e-9);
}

TEST(Dxf, YardsAreReadAndLightYearsRefused) {
  const PlainMesh mesh = battered_trench({0, 0});
  const DesignFile yards("dxf", dxf(dxf_faces(mesh), 10));
  EXPECT_EQ(read_design(yards.path()).unit, 0.9144);
  const DesignFile none("dxf", dxf(dxf_faces(mesh), 0));
  EXPECT_EQ(read_design(none.path()).notes.front(), "the drawing tells no unit: metres were taken");
  const DesignFile far("dxf", dxf(dxf_faces(mesh), 19));
  EXPECT_NE(error_about([&] { read_design(far.path()); }, far.path()).find("$INSUNITS is 19"),
            string::npos);
  DesignFileOptions options;
  options.unit = 1.0;
  EXPECT_EQ(read_design(far.path(), options).unit, 1.0);
}

TEST(Dxf, ASurfaceIsALayer) {
  const DesignFile drawing("dxf", dxf(dxf_faces(battered_trench({0, 0})), 6));
  DesignFileOptions options;
  options.surface = "0";
  EXPECT_GT(area_in_plan(read_design(drawing.path(), options)), 0.0);
  options.surface = "elsewhere";
  EXPECT_NE(error_about([&] { read_design(drawing.path(), options); }, drawing.path())
                .find("of these layers"),
            string::npos);
}

TEST(DesignFile, ItIsMovedIntoTheSite) {
  const DesignFile file("obj", obj(battered_trench({500000, 5000000})));
  DesignFileOptions options;
  options.site_from_design(0, 3) = -500000;
  options.site_from_design(1, 3) = -5000000;
  EXPECT_NEAR(cut_of(read_design(file.path(), options), level_ground({0, 0}, 0.05)), trench_volume,
              1e-8);
  options.site_from_design(2, 2) = -1.0;
  EXPECT_NE(error_of([&] { read_design(file.path(), options); }).find("turns about z alone"),
            string::npos);
}

/// The designs of other programs, where they are.
string shared_design(const string& name) {
  return string(EXCAVPLAN_SHARED_DATA) + "/designs/" + name;
}
bool has_shared_designs() { return std::filesystem::exists(shared_design("abrman-S5.xml")); }

double area_of_shared(const string& name, const string& surface, double unit) {
  DesignFileOptions options;
  options.surface = surface;
  const DesignSurface design = read_design(shared_design(name), options);
  EXPECT_NEAR(design.unit, unit, 1e-12);
  return area_in_plan(design) / (unit * unit);
}

// To the four digits after the point that these programs cut off: 1e-11.
TEST(ForeignDesigns, AreasAreThoseTheirProgramsState) {
  if (!has_shared_designs()) GTEST_SKIP() << "no designs in " << EXCAVPLAN_SHARED_DATA;
  EXPECT_NEAR(area_of_shared("subdivision-1.1.xml", "EG", 0.3048), 9742293.9521, 1e-4);
  EXPECT_NEAR(area_of_shared("subdivision-1.1.xml", "FG", 0.3048), 2768515.7662, 1e-4);
  EXPECT_NEAR(area_of_shared("subdivision-2.0.xml", "EG", 0.3048), 9742293.9521, 1e-4);
}

TEST(ForeignDesigns, AllAreReadOrSayWhyNot) {
  if (!has_shared_designs()) GTEST_SKIP() << "no designs in " << EXCAVPLAN_SHARED_DATA;
  for (const string name : {"abrman-S1.xml", "abrman-S2.xml", "abrman-S5.xml", "own-trench-1.2.xml",
                            "ezdxf-3dface.dxf", "ezdxf-uncommon.dxf", "gdal-nodata_nan.asc"}) {
    EXPECT_GT(area_in_plan(read_design(shared_design(name))), 0.0) << name;
  }
  const string road = shared_design("road_sample-mac999.xml");
  EXPECT_NE(error_about([&] { read_design(road); }, road).find("alignments alone are none"),
            string::npos);
}

}  // namespace
}  // namespace excavplan::test
