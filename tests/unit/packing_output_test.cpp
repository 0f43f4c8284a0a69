// SPDX-License-Identifier: GPL-3.0-or-later
// Spheres that are written and read again: each format gives back what it holds bit by bit, and says what it does not.
#include "pfv/error.hpp"
#include "pfv/packing_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace packing_output_test {
namespace {

namespace fs = std::filesystem;
using pfv::PackingFile;
using Remarks = std::vector<std::string>;

class PackingOutputs : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "pfv_outputs_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  PackingFile again(const std::string& name, const PackingFile& file) {
    remarks_ = pfv::write_packing_file(path(name), file);
    return pfv::read_packing_file(path(name));
  }

  fs::path folder_;
  Remarks remarks_;
};

/// Two spheres with numbers that no short text holds, in a room that is periodic along y.
PackingFile two(bool moving = true) {
  PackingFile file;
  file.packing.ids.resize(2);
  file.packing.ids << 9, 7;
  file.packing.positions = Eigen::Matrix3Xd::Zero(3, 2);
  file.packing.positions << 1.0 / 3.0, 0.1, 2e-17, 0.7, -1e300, 0.123456789012345678;
  file.packing.radii = Eigen::Vector2d(1.0 / 7.0, 5e-310);
  if (moving) {
    file.packing.velocities = 1e-5 * file.packing.positions.array().sin();
    file.packing.angular_velocities = -3.0 * file.packing.velocities;
  }
  file.bounds = pfv::PackingBounds{{-0.1, 1.0 / 3.0, 0.0}, {1.0, 2.0, 1e-3}, {false, true, false}};
  file.step = 12000;
  return file;
}

void expect_same_places(const PackingFile& read, const PackingFile& written) {
  EXPECT_EQ(read.packing.positions, written.packing.positions);
  EXPECT_EQ(read.packing.radii, written.packing.radii);
}

void expect_same_spheres(const PackingFile& read, const PackingFile& written) {
  expect_same_places(read, written);
  EXPECT_EQ(read.packing.ids, written.packing.ids);
  EXPECT_EQ(read.packing.velocities, written.packing.velocities);
  EXPECT_EQ(read.packing.angular_velocities, written.packing.angular_velocities);
}

const std::string step_lost = "lost: the time step 12000";
const std::string bounds_lost = "lost: the bounds of the simulation box and which sides are periodic";

TEST_F(PackingOutputs, DumpHoldsAll) {
  for (const bool moving : {true, false}) {
    const PackingFile read = again("a.dump", two(moving));
    expect_same_spheres(read, two(moving));
    EXPECT_EQ(read.step, 12000);
    EXPECT_EQ(read.bounds->lower, two().bounds->lower);
    EXPECT_EQ(read.bounds->upper, two().bounds->upper);
    EXPECT_EQ(read.bounds->periodic, two().bounds->periodic);
    EXPECT_EQ(remarks_, Remarks{});
    EXPECT_EQ(read.remarks, Remarks{});
  }
}

TEST_F(PackingOutputs, TableAndPointsHoldSpheresButNoRoom) {
  for (const char* name : {"a.csv", "a.vtu"})
    for (const bool moving : {true, false}) {
      const PackingFile read = again(name, two(moving));
      expect_same_spheres(read, two(moving));
      EXPECT_FALSE(read.bounds);
      EXPECT_EQ(remarks_, (Remarks{step_lost, bounds_lost})) << name;
    }
}

TEST_F(PackingOutputs, DataFileHoldsBoundsButNoPeriodicSides) {
  for (const bool moving : {true, false}) {
    const PackingFile read = again("a.data", two(moving));
    expect_same_spheres(read, two(moving));
    EXPECT_EQ(read.bounds->lower, two().bounds->lower);
    EXPECT_EQ(read.bounds->upper, two().bounds->upper);
    EXPECT_EQ(remarks_, (Remarks{step_lost, "lost: which sides of the simulation box are periodic; `boundary` of the script says so",
                                 "assumed: a density of 2500 kg/m3, which the option density changes"}));
  }
}

TEST_F(PackingOutputs, YadeTextHoldsPlacesAndRadiiAlone) {
  const PackingFile read = again("a.txt", two());
  expect_same_places(read, two());
  EXPECT_EQ(read.packing.ids[1], 2);
  EXPECT_EQ(remarks_, (Remarks{step_lost, bounds_lost, "lost: velocities",
                               "lost: ids; the spheres count from 1 (in YADE from 0) in their order"}));
  PackingFile plain = two(false);
  plain.packing.ids << 1, 2;
  plain.bounds.reset();
  plain.step.reset();
  again("b.txt", plain);
  EXPECT_EQ(remarks_, Remarks{});
}

TEST_F(PackingOutputs, FromFormatToFormatTheSpheresStay) {
  PackingFile file = two();
  for (const char* name : {"a.vtu", "b.data", "c.csv", "d.lammpstrj", "e.vtu"}) file = again(name, file);
  expect_same_spheres(file, two());
}

TEST_F(PackingOutputs, WhereNoRoomIsKnownItsExtentIsAssumed) {
  PackingFile file = two();
  file.packing.positions.setConstant(0.5);
  file.packing.radii.setConstant(0.25);
  file.bounds.reset();
  const PackingFile read = again("a.dump", file);
  EXPECT_EQ(read.bounds->lower, Eigen::Vector3d::Constant(0.25));
  EXPECT_EQ(read.bounds->upper, Eigen::Vector3d::Constant(0.75));
  EXPECT_FALSE(read.bounds->any_periodic());
  EXPECT_EQ(remarks_, Remarks{"assumed: a simulation box of the extent of the spheres, without periodic sides"});
}

TEST_F(PackingOutputs, TiltedRooms) {
  PackingFile file = two();
  file.bounds = pfv::PackingBounds{{0, 0, 0}, {1, 2, 4}, {true, true, true}, {0.25, -0.5, 0.125}};
  const PackingFile dump = again("a.dump", file);
  EXPECT_EQ(dump.bounds->lower, file.bounds->lower);
  EXPECT_EQ(dump.bounds->upper, file.bounds->upper);
  EXPECT_EQ(dump.bounds->tilt, file.bounds->tilt);
  const PackingFile data = again("a.data", file);
  expect_same_spheres(data, file);
  EXPECT_FALSE(data.bounds);  // whose walls would be tilted
}

TEST_F(PackingOutputs, AnEndingWithoutAFormatIsRefused) {
  for (const char* name : {"a", "a.stl", "a.csv.gz", "b.d/a"}) {
    SCOPED_TRACE(name);
    EXPECT_THROW(pfv::write_packing_file(path(name), two()), pfv::InputError);
  }
  EXPECT_THROW(pfv::write_packing_file(path("none/a.csv"), two()), pfv::InputError);
  EXPECT_THROW(pfv::write_packing_file(path("a.csv"), two(), {{}, 2600.0}), pfv::InputError);
  EXPECT_TRUE(fs::is_empty(folder_));
  pfv::write_packing_file(path("a"), two(), {pfv::PackingFormat::data, 2600.0});
  std::ifstream file(path("a"));
  const std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_NE(text.find("9 1 0.2857142857142857 2600 "), std::string::npos) << text;
}

}  // namespace
}  // namespace packing_output_test
