// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/error.hpp"
#include "pfv/io.hpp"
#include "support/packings.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace io_test {
namespace {

namespace fs = std::filesystem;

/// An empty folder for each test.
class InputOutput : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "pfv_io_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string file(const std::string& content) const {
    std::ofstream(path("packing"), std::ios::binary) << content;
    return path("packing");
  }

  pfv::PackingArrays read(const std::string& content) const {
    return pfv::read_packing(file(content));
  }

  std::string refusal(const std::string& content) const {
    try {
      read(content);
    } catch (const pfv::InputError& error) {
      return error.what();
    }
    ADD_FAILURE() << "was read: " << content;
    return {};
  }

  /// The message names file and line `place` and says `what`, in one line.
  void expect_refusal(const std::string& content, const std::string& place,
                      const std::string& what) const {
    const std::string message = refusal(content);
    EXPECT_NE(message.find(path("packing") + place), std::string::npos) << message;
    EXPECT_NE(message.find(what), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }

  std::string text(const std::string& name) const {
    std::ifstream stream(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

const std::string header = "id,x,y,z,radius\n";

TEST_F(InputOutput, CsvKeepsIdsOrderAndEveryDigit) {
  const pfv::PackingArrays packing =
      read(header + "7,0.1,-2e-3,3,0.13571773785611730\n-2,4.9e-324,1e300,+.5,5.\n");
  ASSERT_EQ(packing.ids.size(), 2);
  EXPECT_EQ(packing.ids[0], 7);
  EXPECT_EQ(packing.ids[1], -2);
  EXPECT_EQ(packing.positions.col(0), Eigen::Vector3d(0.1, -2e-3, 3));
  EXPECT_EQ(packing.positions.col(1), Eigen::Vector3d(4.9e-324, 1e300, 0.5));
  EXPECT_EQ(packing.radii[0], 0.13571773785611730);
  EXPECT_EQ(packing.radii[1], 5);
  EXPECT_EQ(packing.velocities.cols(), 0);
}

TEST_F(InputOutput, CsvTakesAnyColumnOrderBlanksCarriageReturnsAndByteOrderMark) {
  const pfv::PackingArrays packing =
      read("\xEF\xBB\xBF vz, radius ,colour,x, id ,y,z,vx,vy\r\n"
           "9, 0.5 ,red,1,3,2,4,7,8\r\n\r\n \n");
  ASSERT_EQ(packing.ids.size(), 1);
  EXPECT_EQ(packing.ids[0], 3);
  EXPECT_EQ(packing.radii[0], 0.5);
  EXPECT_EQ(packing.positions.col(0), Eigen::Vector3d(1, 2, 4));
  EXPECT_EQ(packing.velocities.col(0), Eigen::Vector3d(7, 8, 9));
}

TEST_F(InputOutput, CsvNeedsNoNewlineAtItsEnd) {
  EXPECT_EQ(read(header + "1,0,0,0,1").ids.size(), 1);
}

TEST_F(InputOutput, CsvRefusalsNameFileLineAndField) {
  const std::string good = "1,0,0,0,1\n";
  expect_refusal("", "", "empty");
  expect_refusal("\n \n", "", "empty");
  expect_refusal(header, "", "no spheres");
  expect_refusal(good, ":1: ", "5 numbers where the names of the columns");
  expect_refusal("id,x,y,radius\n", ":1: ", "column z is missing");
  expect_refusal("id,x,y,z,radius,vx,vz\n", ":1: ", "column vy is missing");
  expect_refusal("id,x,y,z,radius,x\n", ":1: ", "column x is named twice");
  expect_refusal(header + good + "2,0,0,0\n", ":3: ", "4 fields instead of 5");
  expect_refusal(header + good + "\n2,0,0,0,1,1\n", ":4: ", "6 fields instead of 5");
  expect_refusal(header + "1.5,0,0,0,1\n", ":2: ", "id is '1.5'");
  expect_refusal(header + ",0,0,0,1\n", ":2: ", "id is ''");
  expect_refusal(header + "99999999999999999999,0,0,0,1\n", ":2: ", "id is '9999");
  expect_refusal(header + good + "1,1,1,1,1\n", ":3: ", "id 1 stands in line 2");
  expect_refusal(header + "1,0,nan,0,1\n", ":2: ", "y is 'nan'");
  expect_refusal(header + "1,0,0,-inf,1\n", ":2: ", "z is '-inf'");
  expect_refusal(header + "1,0,0,1e999,1\n", ":2: ", "z is '1e999'");
  expect_refusal(header + "1,1abc,0,0,1\n", ":2: ", "x is '1abc'");
  expect_refusal(header + "1,0,0,0,0\n", ":2: ", "radius is '0'");
  expect_refusal(header + "1,0,0,0,-1\n", ":2: ", "radius is '-1'");
  expect_refusal(std::string("\x7f" "ELF\0\x01\x02", 7), ":1: ", "is binary");
}

TEST_F(InputOutput, AMissingPackingOrAFolderIsRefused) {
  EXPECT_THROW(pfv::read_packing(path("none")), pfv::InputError);
  EXPECT_THROW(pfv::read_packing(folder_.string()), pfv::InputError);
}

TEST_F(InputOutput, ReadsTheDensePackingsOfTheTests) {
  const pfv::PackingArrays packing = support::data_packing("packing_500.csv");
  ASSERT_EQ(packing.ids.size(), 500);
  EXPECT_GT(packing.radii.minCoeff(), 0);
  EXPECT_GE(packing.positions.minCoeff(), 0);
  EXPECT_LE(packing.positions.maxCoeff(), 1);
}

std::string snapshot(int timestep, const std::string& columns, const std::string& atoms) {
  return "ITEM: TIMESTEP\n" + std::to_string(timestep) +
         "\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\nITEM: ATOMS " +
         columns + "\n" + atoms;
}
const std::string plain_columns = "id type x y z radius ";  // LIGGGHTS ends lines with a blank
const std::string two_atoms = "5 1 0.1 0.2 0.3 0.05 \n4 1 0.6 0.7 0.8 0.06 \n";

TEST_F(InputOutput, DumpGivesItsLastSnapshotWithColumnsByName) {
  const pfv::PackingArrays packing =
      read(snapshot(0, plain_columns, two_atoms) +
           snapshot(100, "vx vy vz radius z y x type id ",
                    "1 2 3 0.05 0.3 0.2 0.1 1 8 \n4 5 6 0.06 0.8 0.7 0.6 1 9 \n"));
  ASSERT_EQ(packing.ids.size(), 2);
  EXPECT_EQ(packing.ids[0], 8);
  EXPECT_EQ(packing.positions.col(1), Eigen::Vector3d(0.6, 0.7, 0.8));
  EXPECT_EQ(packing.radii[0], 0.05);
  EXPECT_EQ(packing.velocities.col(1), Eigen::Vector3d(4, 5, 6));
}

TEST_F(InputOutput, DumpThatIsCutOffIsRefusedWhereverTheCutIs) {
  const std::string whole = snapshot(0, plain_columns, two_atoms);
  EXPECT_EQ(read(whole).ids.size(), 2);
  for (const std::size_t length :
       {whole.find("ITEM: NUMBER"), whole.find("2\nITEM: BOX"), whole.find("ITEM: ATOMS"),
        whole.find("5 1 0.1"), whole.find("4 1 0.6")})
    expect_refusal(whole.substr(0, length), ":", "cut off");
  expect_refusal(whole + "ITEM: TIM", ":12: ", "cut off");
  expect_refusal(whole + snapshot(1, plain_columns, "5 1 0.1 0.2 0.3 0.05 \n"), ":21: ",
                 "after 1 of 2 atoms");
  expect_refusal(whole + snapshot(1, plain_columns, "5 1 0.1 0.2"), ":21: ", "after 4 of 6 fields");
}

TEST_F(InputOutput, DumpRefusalsNameLineAndField) {
  expect_refusal(snapshot(0, "id x y z ", "1 0 0 0\n2 1 1 1\n"), ":9: ",
                 "column radius is missing");
  expect_refusal(snapshot(0, plain_columns, two_atoms + "6 1 0 0 0 1\n"), ":12: ", "more lines");
  expect_refusal(snapshot(0, plain_columns, "5 1 0 0 0 1 \n5 1 1 0 0 1 \n"), ":11: ",
                 "id 5 stands in line 10");
  std::string many = snapshot(0, plain_columns, two_atoms);
  many.replace(many.find("\n2\n"), 3, "\n4000000000000000000\n");
  expect_refusal(many, ":", "cut off");
  expect_refusal("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\nmany\n", ":4: ", "'many'");
  expect_refusal("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n0\nITEM: ATOMS id x y z radius\n",
                 "", "of step 0 has no atoms");
}

pfv::PackingArrays two_spheres() {
  pfv::PackingArrays packing;
  packing.ids = Eigen::Matrix<std::int64_t, 2, 1>(12, 3);
  packing.positions = Eigen::Matrix<double, 3, 2>::Constant(0.5);
  packing.radii = Eigen::Vector2d(0.1, 0.2);
  return packing;
}

pfv::Forces forces_on_two_spheres() {
  pfv::Forces forces;
  forces.total.resize(3, 2);
  forces.total << 0.1, 1e-300, -0.0, 1.0 / 3.0, 2, -5;
  forces.pressure = 0.5 * forces.total;
  forces.viscous = forces.total - forces.pressure;
  return forces;
}

TEST_F(InputOutput, ForcesAreWrittenInInputOrderAndReadBackToTheLastBit) {
  const pfv::PackingArrays packing = two_spheres();
  pfv::write_forces(path("forces.csv"), packing.view(), forces_on_two_spheres());
  EXPECT_EQ(text("forces.csv"),
            "id,fx,fy,fz,fpx,fpy,fpz,fvx,fvy,fvz\n"
            "12,0.1,0,2,0.05,0,1,0.05,0,1\n"
            "3,1e-300,0.3333333333333333,-5,5e-301,0.16666666666666666,-2.5,"
            "5e-301,0.16666666666666666,-2.5\n");
}

TEST_F(InputOutput, ForcesWithoutTheirPartsOrNotFiniteAreRefused) {
  const pfv::PackingArrays packing = two_spheres();
  pfv::Forces forces = forces_on_two_spheres();
  forces.viscous.resize(3, 0);
  EXPECT_THROW(pfv::write_forces(path("f"), packing.view(), forces), pfv::InputError);
  forces = forces_on_two_spheres();
  forces.total(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(pfv::write_forces(path("f"), packing.view(), forces), pfv::SolverError);
  EXPECT_EQ(files(), 0u);
}

TEST_F(InputOutput, ReportHoldsNullForWhatHasNoMeaning) {
  pfv::Report report;
  report.spheres = 100;
  report.mass_error = std::numeric_limits<double>::quiet_NaN();
  report.solver = "supernodal";
  report.faces.resize(1);
  report.faces[0].name = "zhi";
  report.faces[0].flux = -0.25;
  report.seconds.step = 0.5;
  pfv::write_report(path("report.json"), report);
  const auto json = nlohmann::json::parse(text("report.json"));
  EXPECT_EQ(json.at("spheres"), 100);
  EXPECT_TRUE(json.at("permeability").is_null());
  EXPECT_TRUE(json.at("mass_error").is_null());
  EXPECT_EQ(json.at("solver"), "supernodal");
  EXPECT_EQ(json.at("faces").at("zhi").at("flux"), -0.25);
  EXPECT_EQ(json.at("seconds").at("step"), 0.5);
  EXPECT_TRUE(json.at("wall_seconds").at("step").is_null());
}

TEST_F(InputOutput, AWriterReplacesAFileAndLeavesNothingElseBehind) {
  std::ofstream(path("report.json")) << "old";
  pfv::write_report(path("report.json"), {});
  EXPECT_EQ(text("report.json").front(), '{');
  EXPECT_EQ(files(), 1u);
}

TEST_F(InputOutput, AWriterFollowsASymbolicLink) {
  fs::create_directory(path("there"));
  std::ofstream(path("there/target")) << "old";
  fs::create_symlink(path("there/target"), path("link"));
  pfv::write_report(path("link"), {});
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(text("there/target").front(), '{');
}

TEST_F(InputOutput, AFullDiskOrAMissingFolderIsAFileError) {
  EXPECT_THROW(pfv::write_report("/dev/full", {}), pfv::FileError);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_THROW(pfv::write_report(path("none/report.json"), {}), pfv::FileError);
  fs::create_directory(path("folder"));
  EXPECT_THROW(pfv::write_report(path("folder"), {}), pfv::FileError);
  EXPECT_EQ(files(), 1u);
}

TEST_F(InputOutput, OutputFoldersAreCheckedBeforehand) {
  EXPECT_NO_THROW(pfv::require_folder_of(path("new.csv")));
  EXPECT_NO_THROW(pfv::require_folder_of("in_the_present_folder.csv"));
  EXPECT_NO_THROW(pfv::require_folder_of("/dev/null"));
  EXPECT_THROW(pfv::require_folder_of(""), pfv::InputError);
  EXPECT_THROW(pfv::require_folder_of(folder_.string()), pfv::InputError);
  EXPECT_THROW(pfv::require_folder_of(path("new/")), pfv::InputError);
  EXPECT_THROW(pfv::require_folder_of(path("none/new.csv")), pfv::InputError);
  std::ofstream(path("file")) << "x";
  EXPECT_THROW(pfv::require_folder_of(path("file/new.csv")), pfv::InputError);
}

TEST_F(InputOutput, ACollectionNamesTimePartAndEscapedFile) {
  pfv::write_collection(path("run.pvd"), {{0.0, 0, "a&b.vtu"}, {1e-5, 1, "grains.vtu"}});
  const std::string xml = text("run.pvd");
  EXPECT_NE(xml.find("<DataSet timestep=\"0\" part=\"0\" file=\"a&amp;b.vtu\"/>"),
            std::string::npos);
  EXPECT_NE(xml.find("<DataSet timestep=\"1e-05\" part=\"1\" file=\"grains.vtu\"/>"),
            std::string::npos);
}

}  // namespace
}  // namespace io_test
