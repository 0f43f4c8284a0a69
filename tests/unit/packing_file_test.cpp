// SPDX-License-Identifier: GPL-3.0-or-later
// Files of spheres as people have them: each variant is read to the same spheres, or refused with its cause.
#include "pfv/error.hpp"
#include "pfv/packing_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

namespace packing_file_test {
namespace {

namespace fs = std::filesystem;

class PackingFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "pfv_files_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file(const std::string& content) const {
    const std::string path = (folder_ / "spheres").string();
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }

  fs::path folder_;
};

/// Two spheres, written in each way: 7 at (0.1, 0.2, 0.3) of radius 0.05, 9 at (0.6, 0.7, 0.8) of radius 0.1.
void expect_two(const pfv::PackingFile& file, bool ids = true) {
  const pfv::PackingArrays& packing = file.packing;
  ASSERT_EQ(packing.ids.size(), 2);
  EXPECT_EQ(packing.ids[0], ids ? 7 : 1);
  EXPECT_EQ(packing.ids[1], ids ? 9 : 2);
  EXPECT_LT((packing.positions.col(0) - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-15);
  EXPECT_LT((packing.positions.col(1) - Eigen::Vector3d(0.6, 0.7, 0.8)).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(packing.radii[0], 0.05);
  EXPECT_DOUBLE_EQ(packing.radii[1], 0.1);
}

const std::string commas = "id,x,y,z,radius\n7,0.1,0.2,0.3,0.05\n9,0.6,0.7,0.8,0.1\n";

std::string with(std::string text, char from, char to) {
  for (char& c : text)
    if (c == from) c = to;
  return text;
}

TEST_F(PackingFiles, TablesWithAnySeparatorQuotesCommentsAndNames) {
  const std::vector<std::string> tables{
      commas,
      with(commas, ',', ';'),
      with(commas, ',', '\t'),
      with(commas, ',', ' '),
      "\xEF\xBB\xBF" + commas,
      with(commas, '\n', '\r') == commas ? commas : "id , x, y , z,radius \r\n7, 0.1 ,0.2,0.3,0.05\r\n9,0.6,0.7,0.8,0.1\r\n",
      "\"id\",\"x\",\"y\",\"z\",\"radius\"\n\"7\",\"0.1\",\"0.2\",\"0.3\",\"0.05\"\n9,0.6,0.7,0.8,0.1\n",
      "# written by hand\n# in metres\n" + commas + "# the end\n",
      "ID,X,Y,Z,Radius\n" + commas.substr(commas.find('\n') + 1),
      "id,x [m],y [m],z [m],radius (m)\n" + commas.substr(commas.find('\n') + 1),
      "tag,pos_x,pos_y,pos_z,r\n" + commas.substr(commas.find('\n') + 1),
      "id,Points:0,Points:1,Points:2,radii\n" + commas.substr(commas.find('\n') + 1),
      "Points_0;Points_1;Points_2;diameter;id\n0.1;0.2;0.3;0.1;7\n0.6;0.7;0.8;0.2;9\n",
      "# id x y z radius\n7 0.1 0.2 0.3 0.05\n9 0.6 0.7 0.8 0.1\n",
      "#format id_x_y_z_r\n7 0.1 0.2 0.3 0.05\n9 0.6 0.7 0.8 0.1\n",
      "id   x\ty z   radius\n7   0.1 0.2\t0.3 0.05\n9 0.6 0.7 0.8 0.1",
      "id,x,y,z,radius,r,material\n7,0.1,0.2,0.3,0.05,1,2\n9,0.6,0.7,0.8,0.1,1,2\n"};
  for (const std::string& table : tables) {
    SCOPED_TRACE(table);
    expect_two(pfv::read_packing_file(file(table)));
  }
}

TEST_F(PackingFiles, WithoutIdsTheyAreNumberedAndThatIsSaid) {
  for (const std::string table : {"x,y,z,radius\n0.1,0.2,0.3,0.05\n0.6,0.7,0.8,0.1\n",
                                  "#format x_y_z_r\n0.1\t0.2\t0.3\t0.05\n0.6\t0.7\t0.8\t0.1\n",
                                  "#format x_y_z_r_matId\n0.1\t0.2\t0.3\t0.05\t0\n0.6\t0.7\t0.8\t0.1\t0\n",
                                  "0.1 0.2 0.3 0.05\n0.6 0.7 0.8 0.1\n"}) {
    SCOPED_TRACE(table);
    const pfv::PackingFile read = pfv::read_packing_file(file(table));
    expect_two(read, false);
    EXPECT_NE(read.remarks.back().find("numbered from 1"), std::string::npos);
  }
}

std::string dump(const std::string& columns, const std::string& atoms, const std::string& bounds = "ff ff ff",
                 const std::string& edges = "0 1\n0 1\n0 1\n", int step = 100) {
  return "ITEM: TIMESTEP\n" + std::to_string(step) + "\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS " + bounds + "\n" +
         edges + "ITEM: ATOMS " + columns + "\n" + atoms;
}
const std::string plain = "7 1 0.1 0.2 0.3 0.05 \n9 1 0.6 0.7 0.8 0.1 \n";

TEST_F(PackingFiles, DumpsWithScaledUnwrappedCoordinatesDiametersUnitsAndTimes) {
  const std::string two = "0 2\n0 2\n0 2\n";
  const std::vector<std::string> dumps{
      dump("id type x y z radius ", plain),
      dump("id type x y z diameter ", "7 1 0.1 0.2 0.3 0.1 \n9 1 0.6 0.7 0.8 0.2 \n"),
      dump("id type xs ys zs radius ", "7 1 0.05 0.1 0.15 0.05 \n9 1 0.3 0.35 0.4 0.1 \n", "ff ff ff", two),
      dump("id type xu yu zu radius ", "7 1 0.1 0.2 0.3 0.05 \n9 1 1.6 -0.3 0.8 0.1 \n", "pp pp ff"),
      dump("id type xsu ysu zsu radius ", "7 1 0.1 0.2 0.3 0.05 \n9 1 1.6 -0.3 2.8 0.1 \n", "pp pp pp"),
      dump("id type x y z xs ys zs radius ", "7 1 0.1 0.2 0.3 9 9 9 0.05 \n9 1 0.6 0.7 0.8 9 9 9 0.1 \n"),
      "ITEM: UNITS\nsi\nITEM: TIME\n0.5\n" + dump("id type x y z radius ", plain),
      dump("id type x y z radius c_cn vx vy vz", "7 1 0.1 0.2 0.3 0.05 6 1 2 3\n9 1 0.6 0.7 0.8 0.1 5 4 5 6\n"),
      dump("id type x y z radius ", plain, "xy xz yz ff ff ff", "0 1 0.1\n0 1 0\n0 1 0\n")};
  for (const std::string& one : dumps) {
    SCOPED_TRACE(one);
    expect_two(pfv::read_packing_file(file(one)));
  }
  const pfv::PackingFile periodic = pfv::read_packing_file(file(dumps[3]));
  EXPECT_EQ(periodic.bounds->periodic, (std::array<bool, 3>{true, true, false}));
  EXPECT_EQ(pfv::read_packing_file(file(dumps[2])).bounds->upper, Eigen::Vector3d(2.0, 2.0, 2.0));
}

TEST_F(PackingFiles, SnapshotsAreChosenByStepNumberOrTime) {
  const auto at = [](double x, int step, double time) {
    const std::string place = std::to_string(x);
    return "ITEM: TIME\n" + std::to_string(time) + "\n" +
           dump("id type x y z radius ", "7 1 " + place + " 0 0 1 \n9 1 0 0 9 1 \n", "ff ff ff", "0 1\n0 1\n0 1\n", step);
  };
  const std::string path = file("ITEM: UNITS\nsi\n" + at(1.0, 0, 0.0) + at(2.0, 500, 0.5) + at(3.0, 1000, 1.0));
  const auto x = [&](const std::string& name) { return pfv::read_packing_file(path, {name, 1.0}).packing.positions(0, 0); };
  EXPECT_EQ(x("last"), 3.0);
  EXPECT_EQ(x("0"), 1.0);
  EXPECT_EQ(x("500"), 2.0);
  EXPECT_EQ(x("2"), 2.0);  // no such step: the second
  EXPECT_EQ(x("time=1"), 3.0);
  for (const char* none : {"4", "-1", "time=0.7", "first", "time=x"}) {
    try {
      x(none);
      ADD_FAILURE() << none;
    } catch (const pfv::InputError& error) {
      EXPECT_NE(std::string(error.what()).find("3 snapshots, of steps 0 500 1000"), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(pfv::read_packing_file(path, {"500", 1.0}).remarks.back(), "the snapshot is that of step 500, number 2 of 3");
}

TEST_F(PackingFiles, ADumpWhoseLastSnapshotIsCutOffStillHasTheOthers) {
  const std::string whole = dump("id type x y z radius ", plain);
  const std::string path = file(whole + dump("id type x y z radius ", "7 1 0 0 0 1\n", "ff ff ff", "0 1\n0 1\n0 1\n", 200));
  EXPECT_THROW(pfv::read_packing_file(path), pfv::InputError);
  expect_two(pfv::read_packing_file(path, {"100", 1.0}));
}

const std::string data_file =
    "LIGGGHTS data file via write_data, timestep = 100\n\n2 atoms\n1 atom types\n\n0 1 xlo xhi\n0 2 ylo yhi\n0 3 zlo zhi\n\n"
    "Atoms\n\n9 1 0.2 2500 0.6 0.7 0.8 0 0 0\n7 1 0.1 2500 0.1 0.2 0.3 0 1 0\n";

TEST_F(PackingFiles, DataFilesWithAndWithoutVelocities) {
  const auto ordered = [&](const std::string& text) {
    pfv::PackingFile read = pfv::read_packing_file(file(text));
    EXPECT_EQ(read.packing.ids[0], 9);
    read.packing.ids.reverseInPlace();
    read.packing.positions.rowwise().reverseInPlace();
    read.packing.radii.reverseInPlace();
    return read;
  };
  expect_two(ordered(data_file));
  std::string named = data_file;
  named.replace(named.find("Atoms"), 5, "Atoms  # granular");
  expect_two(ordered(named));
  const pfv::PackingFile moving = ordered(data_file + "\nVelocities\n\n7 1 2 3 4 5 6\n9 0 0 0 0 0 0\n");
  expect_two(moving);
  EXPECT_EQ(moving.packing.velocities.col(1), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(moving.packing.angular_velocities.col(1), Eigen::Vector3d(4.0, 5.0, 6.0));
  EXPECT_EQ(moving.bounds->upper, Eigen::Vector3d(1.0, 2.0, 3.0));
}

const std::string legacy =
    "# vtk DataFile Version 2.0\nGenerated by LIGGGHTS\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0.1 0.2 0.3 0.6 0.7 0.8\n"
    "VERTICES 2 4\n1 0 1 1\nPOINT_DATA 2\nVECTORS v float\n1 2 3 4 5 6\nSCALARS radius float 1\nLOOKUP_TABLE default\n"
    "0.05 0.1\nFIELD FieldData 1\nid 1 2 int\n7 9\n";
const std::string vtu =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
    "<Piece NumberOfPoints=\"2\" NumberOfCells=\"0\">\n<PointData>\n<DataArray type=\"Int64\" Name=\"id\" format=\"ascii\">7 9</DataArray>\n"
    "<DataArray type=\"Float64\" Name=\"diameter\" format=\"ascii\">0.1\n0.2</DataArray>\n</PointData>\n<Points>\n"
    "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0.1 0.2 0.3\n0.6 0.7 0.8</DataArray>\n</Points>\n"
    "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";

TEST_F(PackingFiles, PointsOfVtkFiles) {
  const pfv::PackingFile old = pfv::read_packing_file(file(legacy));
  expect_two(old);
  EXPECT_EQ(old.packing.velocities.col(1), Eigen::Vector3d(4.0, 5.0, 6.0));
  expect_two(pfv::read_packing_file(file(vtu)));
  std::string lines;  // as other systems end them, and an empty piece first, as parallel writers have it
  for (const char c : vtu) lines += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expect_two(pfv::read_packing_file(file(lines)));
  std::string pieces = vtu;
  pieces.insert(pieces.find("<Piece"), "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"></Piece>\n");
  expect_two(pfv::read_packing_file(file(pieces)));
}

TEST_F(PackingFiles, PackedWithGzip) {
  const std::string path = (folder_ / "spheres.csv.gz").string();
  gzFile packed = gzopen(path.c_str(), "wb");
  gzwrite(packed, commas.data(), static_cast<unsigned>(commas.size()));
  gzclose(packed);
  expect_two(pfv::read_packing_file(path));
  fs::resize_file(path, fs::file_size(path) / 2);
  try {
    pfv::read_packing_file(path);
    FAIL();
  } catch (const pfv::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("the packed file is cut off"), std::string::npos) << error.what();
  }
}

TEST_F(PackingFiles, AUnitOfLength) {
  const pfv::PackingFile read = pfv::read_packing_file(
      file(dump("id type x y z radius vx vy vz", "7 1 100 200 300 50 1000 0 0\n9 1 600 700 800 100 0 0 0\n", "pp pp pp",
                "0 1000\n0 1000\n0 1000\n")),
      {"last", 1e-3});
  expect_two(read);
  EXPECT_EQ(read.packing.velocities(0, 0), 1.0);
  EXPECT_EQ(read.bounds->upper, Eigen::Vector3d::Ones());
}

struct Refused {
  std::string content, cause;
};

// The file has the bounds of the box around the tilted one.
TEST_F(PackingFiles, ATiltedRoomHasItsOwnBoundsAndItsTilt) {
  const pfv::PackingFile read = pfv::read_packing_file(
      file(dump("id type x y z radius ", plain, "xy xz yz pp pp pp", "-0.2 1.1 0.1\n0 1.3 -0.2\n0 1 0.3\n")));
  expect_two(read);
  ASSERT_TRUE(read.bounds);
  EXPECT_LT((read.bounds->lower - Eigen::Vector3d(0.0, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_LT((read.bounds->upper - Eigen::Vector3d(1.0, 1.0, 1.0)).norm(), 1e-15);
  EXPECT_EQ(read.bounds->tilt, Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(read.bounds->periodic, (std::array<bool, 3>{true, true, true}));
}

TEST_F(PackingFiles, WhatIsNotReadIsRefusedWithItsCause) {
  const std::string named_mm = "id,x [mm],y [mm],z [mm],radius [mm]\n7,1,2,3,4\n";
  const std::vector<Refused> all{
      {"7,0.1,0.2,0.3,0.05\n9,0.6,0.7,0.8,0.1\n", ":1: has 5 numbers where the names of the columns are expected"},
      {"id;x;y;z;radius\n7;0,1;0,2;0,3;0,05\n", ":2: x is '0,1': a number with a comma"},
      {named_mm, ":1: column 'x [mm]' is not in m: give the file's unit with --length-unit"},
      {"id,x,y,z\n7,1,2,3\n", ":1: column radius is missing"},
      {"id,x,y,z,radius\n7;1;2;3;4\n", ":2: is separated by semicolons, and the names of the columns by commas"},
      {commas.substr(0, commas.size() - 5), ":3: the file is cut off inside this line, after 4 of 5 fields"},
      {"id,x,y,z,radius\n7,1,2,3,4\n7,2,2,3,4\n", ":3: id 7 stands in line 2 too"},
      {dump("id type x y z radius ", plain).substr(0, dump("id type x y z radius ", plain).size() - 2),
       ":11: the dump ends inside this line"},
      {dump("id type xs ys zs radius ", plain, "xy xz yz ff ff ff", "0 1 0.1\n0 1 0\n0 1 0\n"), "coordinates are scaled"},
      {dump("id type xs ys zs radius ", plain, "xy xz yz pp pp pp", "0 1 0.1\n0 1 0\n0 1 0\n"), "room is tilted"},
      {"ITEM: UNITS\nlj\n" + dump("id type x y z radius ", plain), ":2: its units are 'lj', not si"},
      {dump("id type x y z ", "7 1 0 0 0\n9 1 1 1 1\n"), ":9: column radius is missing"},
      {"BZh91AY&SY", "packed with bzip2"},
      {"\xFD" "7zXZ", "packed with xz"},
      {"PK\x03\x04zip", "zip archive or a spreadsheet"},
      {"\x28\xB5\x2F\xFD", "packed with zstd"},
      {std::string("\xFF\xFE" "i\0d\0", 6), "UTF-16"},
      {"\x93NUMPY\x01", "NumPy array"},
      {"\x89HDF\r\n", "HDF5"},
      {"solid plate\nfacet normal 0 0 1\n", "STL mesh"},
      {"LIGGGHTS (Version LIGGGHTS-PUBLIC 3.8.0)\n", "log of LIGGGHTS"},
      {"{\"spheres\": []}", "JSON"},
      {"<!DOCTYPE html><html>", "web page"},
      {std::string("\x01\0\0\0\x02", 5), "is binary"},
      {std::string("\x7f" "ELF\0\x01\x02", 7), "is binary"},
      {"# vtk DataFile Version 2.0\nt\nBINARY\nDATASET POLYDATA\n", ":3: is a binary legacy VTK file"},
      {legacy.substr(0, legacy.find("SCALARS")), "no radius or diameter; there are v"},
      {legacy.substr(0, legacy.find("0.05 0.1") + 4), "cut off"},
      {vtu.substr(0, vtu.size() / 2), "is no whole XML file"},
      {[] { std::string s = vtu; s.replace(s.find("Unstr"), 16, "ImageData"); return s; }(), "of type 'ImageData'"},
      {[] { std::string s = vtu; s.replace(s.find("7 9"), 3, "7 7"); return s; }(), "id 7 comes twice"},
      {[] { std::string s = vtu; s.replace(s.find("0.2</D"), 3, "-.2"); return s; }(), "point 2 has"},
      {[] { std::string s = data_file; s.replace(s.find("Atoms"), 5, "Atoms # ellipsoid"); return s; }(), "style 'ellipsoid'"},
      {data_file.substr(0, data_file.rfind("\n7 1") + 1), "cut off after 1 of 2 atoms"},
      {data_file.substr(0, data_file.size() - 2), ":13: the file is cut off inside this line, after 9 of 10 fields"},
      {"title\n\n2 atoms\n\nMasses\n\n1 1\n", "no section Atoms"},
      {"id,x [m],y [m],z [m],radius [m],vx [mm/s],vy [mm/s],vz [mm/s]\n7,1,2,3,4,5,6,7\n", "'vx [mm/s]' is not in m"},
      {dump("id type x y z radius ", plain, "xy xz yz pp pp pp", "0 1 zzz\n0 1 0\n0 1 0\n"), "the tilt is 'zzz'"},
      {dump("id type x y z radius ", plain, "abc origin pp pp pp", "1 0 0 0\n0 1 0 0\n0 0 1 0\n"), "general triclinic"},
      {[] { std::string s = vtu; s.replace(s.find("7 9"), 3, "7 1e300"); return s; }(), "the id of point 2 is no whole number"},
      {[] { std::string s = vtu; s.replace(s.find("0.1\n0.2<"), 7, "0.1"); return s; }(), "its field diameter has 1 values for 2 points"},
      {"<VTKFile>" + [] { std::string s; for (int k = 0; k < 60000; ++k) s += "<a>"; return s; }(), "nested too deeply"},
      {[] {  // two packed blocks whose sizes add up to a small one
         std::string s = vtu;
         s.replace(s.find("LittleEndian\""), 13, "LittleEndian\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"");
         s.replace(s.find("\"ascii\">0.1\n0.2"), 15, "\"binary\">AgAAAAAAAAAQAAAAAAAAAAAAAAAAAAAAAAAAAAAAAIAIAAAAAAAAgA==AAAAAAAAAAA=");
         return s;
       }(),
       "cut off or garbled"},
      {"", "is empty"},
      {"# only a comment\n", "is empty"}};
  for (const Refused& one : all) {
    SCOPED_TRACE(one.content);
    try {
      pfv::read_packing_file(file(one.content));
      ADD_FAILURE() << "was read";
    } catch (const pfv::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(one.cause), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  try {
    pfv::read_packing_file(file(commas), {"3", 1.0});
    FAIL();
  } catch (const pfv::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("is no dump"), std::string::npos);
  }
  EXPECT_EQ(pfv::read_packing_file(file(named_mm), {"last", 1e-3}).packing.radii[0], 4e-3);
  EXPECT_THROW(pfv::read_packing_file(file("id,x [mm],y [mm],z [mm],radius [mm],vx [m/s],vy [m/s],vz [m/s]\n7,1,2,3,4,5,6,7\n"),
                                      {"last", 1e-3}),
               pfv::InputError);
}

TEST_F(PackingFiles, RadiiWinOverDiametersThatAgreeAndNoOthers) {
  expect_two(pfv::read_packing_file(file("d,id,x,y,z,r\n0.1,7,0.1,0.2,0.3,0.05\n0.2,9,0.6,0.7,0.8,0.1\n")));
  expect_two(pfv::read_packing_file(file("id,x,y,z,radius,diameter\n7,0.1,0.2,0.3,0.05,0.1\n9,0.6,0.7,0.8,0.1,0.20001\n")));
  for (const char* names : {"id,x,y,z,r,d", "id,x,y,z,radius,diameter", "id,x,y,z,radii,diam"}) {
    const std::string path = file(std::string(names) + "\n7,0.1,0.2,0.3,0.05,0.1\n9,0.6,0.7,0.8,0.1,0.02\n");
    try {
      pfv::read_packing_file(path);
      ADD_FAILURE() << names;
    } catch (const pfv::InputError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(":3: radius is '0.1' and diameter is '0.02'"), std::string::npos) << message;
    }
  }
}

std::string snapshot_of(int step, const std::string& names, const std::string& values) {
  return "ITEM: TIMESTEP\n" + std::to_string(step) +
         "\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\nITEM: ATOMS " + names + '\n' + values + '\n';
}

TEST_F(PackingFiles, VariablesOfADumpAreNoVelocities) {
  const std::string names = "id x y z radius v_x v_y v_z", values = "1 0.5 0.5 0.5 0.1 7 8 9";
  const pfv::PackingFile none = pfv::read_packing_file(file(snapshot_of(5, names, values)));
  EXPECT_EQ(none.packing.velocities.cols(), 0);
  ASSERT_EQ(none.remarks.size(), 1u);
  EXPECT_NE(none.remarks[0].find("v_x"), std::string::npos);
  const pfv::PackingFile both = pfv::read_packing_file(file(snapshot_of(5, names + " vx vy vz", values + " 1 2 3")));
  EXPECT_EQ(both.packing.velocities.col(0), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_TRUE(both.remarks.empty());
}

TEST_F(PackingFiles, OfAStepThatADumpHasTwiceTheLastIsTaken) {
  pfv::PackingChoice choice;
  choice.snapshot = "5";
  const std::string names = "id x y z radius";
  const pfv::PackingFile found = pfv::read_packing_file(
      file(snapshot_of(5, names, "1 0.5 0.5 0.5 0.1") + snapshot_of(5, names, "1 0.5 0.5 0.5 0.2")), choice);
  EXPECT_EQ(found.packing.radii[0], 0.2);
  EXPECT_NE(found.remarks.back().find("2 times"), std::string::npos);
}

}  // namespace
}  // namespace packing_file_test
