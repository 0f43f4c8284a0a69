// SPDX-License-Identifier: GPL-3.0-or-later
// Several ranks that read a packing file together have its spheres, and say of it, what one does.
#include "pfv/error.hpp"
#include "pfv/packing_file.hpp"
#include "support/thread_ranks.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace shared_reading_test {
namespace {

namespace fs = std::filesystem;

/// What comes of a file: numbers of all spheres one after the other and what is said, or why it is refused.
struct Outcome {
  std::vector<double> values;
  std::vector<std::int64_t> ids;
  std::string said, refusal;
};

void add(Outcome& outcome, const pfv::PackingFile& file) {
  const pfv::PackingArrays& packing = file.packing;
  outcome.ids.insert(outcome.ids.end(), packing.ids.begin(), packing.ids.end());
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) {
    for (const Eigen::Matrix3Xd* columns : {&packing.positions, &packing.velocities, &packing.angular_velocities})
      for (int i = 0; i < 3 && columns->cols() > 0; ++i) outcome.values.push_back((*columns)(i, k));
    outcome.values.push_back(packing.radii[k]);
  }
  outcome.said.clear();
  for (const std::string& remark : file.remarks) outcome.said += remark + "\n";
  if (file.step) outcome.said += "step " + std::to_string(*file.step);
  if (file.bounds)
    for (int axis = 0; axis < 3; ++axis)
      outcome.said += ' ' + std::to_string(file.bounds->lower[axis]) + ' ' + std::to_string(file.bounds->upper[axis]) +
                      ' ' + std::to_string(file.bounds->tilt[axis]) + (file.bounds->periodic[axis] ? "p" : "f");
}

class SharedReading : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "pfv_shared_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path() const { return (folder_ / "spheres").string(); }
  void write(const std::string& content) const { std::ofstream(path(), std::ios::binary) << content; }
  void write_packed(const std::string& content) const {
    const gzFile file = gzopen(path().c_str(), "wb1");
    gzwrite(file, content.data(), static_cast<unsigned>(content.size()));
    gzclose(file);
  }

  Outcome alone(const std::string& snapshot) const {
    Outcome outcome;
    try {
      add(outcome, pfv::read_packing_file(path(), {snapshot, 1.0}));
    } catch (const pfv::InputError& error) {
      outcome.refusal = error.what();
    }
    return outcome;
  }

  /// That they have the same, evenly divided, or all say the same.
  void expect_as_alone(int count, const std::string& snapshot = "last") const {
    std::vector<pfv::PackingFile> files(count);
    std::vector<std::string> refusals(count);
    support::on_threads(count, [&](const pfv::Ranks& ranks) {
      try {
        files[ranks.own()] = pfv::read_packing_file(path(), {snapshot, 1.0}, &ranks);
      } catch (const std::exception& error) {
        refusals[ranks.own()] = error.what();
      }
    });
    const Outcome expected = alone(snapshot);
    Outcome found;
    for (int r = 0; r < count; ++r) {
      EXPECT_EQ(refusals[r], expected.refusal) << r << " of " << count;
      add(found, files[r]);
      EXPECT_EQ(found.said, expected.said) << r << " of " << count;
      EXPECT_EQ(found.ids.size(), expected.ids.size() * (r + 1) / count);
    }
    EXPECT_EQ(found.ids, expected.ids);
    EXPECT_EQ(found.values, expected.values);
  }

  fs::path folder_;
};

const std::string rows = "12,0.1,0.2,0.3,0.05\n9,0.6,0.7,0.8,0.1\n-4,1e-3,2.5,0.125,0.0625\n1000000007,3,4,5,0.5\n8,1,1,2,0.3\n";
const std::string table = "id,x,y,z,radius\n" + rows;

std::string with(std::string text, char from, char to) {
  for (char& c : text)
    if (c == from) c = to;
  return text;
}

std::string snapshot(int step, const std::string& names, const std::string& atoms) {
  return "ITEM: TIMESTEP\n" + std::to_string(step) + "\nITEM: NUMBER OF ATOMS\n" +
         std::to_string(std::count(atoms.begin(), atoms.end(), '\n')) +
         "\nITEM: BOX BOUNDS pp ff pp\n0 4\n-1 5.5\n0 2\nITEM: ATOMS " + names + "\n" + atoms;
}

const std::string moving = "3 1.1 2 3 0.5 1 2 3 \n5 4 5 6 0.25 -1 0 1 \n4 7 8 9 0.125 0 0 1e-3 \n";
const std::string dump = "ITEM: UNITS\nsi\nITEM: TIME\n0.1\n" + snapshot(100, "id x y z radius vx vy vz", moving) +
                         "ITEM: TIME\n0.2\n" + snapshot(200, "xu yu zu id diameter v_x", "5 1 1 1 0.5 7\n-3 1 1 2 0.5 7\n");

const std::string data = "made by hand\n\n3 atoms\n1 atom types\n0 1 xlo xhi\n0 2 ylo yhi\n0 3 zlo zhi\n\nAtoms\n\n"
                         "4 1 0.1 2600 0.1 0.2 0.3\n2 1 0.2 2600 0.5 0.5 0.5\n9 1 0.3 2600 0.5 1.5 0.5\n\n"
                         "Velocities\n\n9 1 2 3 4 5 6\n2 0 0 1 0 0 0\n4 0 0 0 0 0 1\n";

const std::string points = "# vtk DataFile Version 3.0\nof grains\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 1 0 1 1 1 1 2\n"
                           "POINT_DATA 3\nSCALARS radius float\nLOOKUP_TABLE default\n0.1 0.2 0.3\n";

const std::vector<std::string> texts{
    table,
    "\xEF\xBB\xBF" + with("# of a run\n\n" + table, '\n', '\r'),
    "# x y z r\n" + with("0.1,0.2,0.3,0.05\n\n# one more\n0.6,0.7,0.8,0.1\n1,2,3,4", ',', ' '),
    "x;y;z;d;vx;vy;vz;\r\n0.1;0.2;0.3;0.05;1;2;3;\r\n 0.1;0.2;0.3;0.05;1;2;3;\r\n",
    dump, data, points};

TEST_F(SharedReading, GivesEachItsShareOfTheSameSpheres) {
  for (const std::string& text : texts) {
    write(text);
    ASSERT_EQ(alone("last").refusal, "") << text;
    for (const int count : {1, 2, 3, 5, 8}) expect_as_alone(count);
    write_packed(text);
    for (const int count : {2, 3}) expect_as_alone(count);
  }
  for (const char* name : {"100", "2", "time=0.1", "7", "last"}) {
    write(dump);
    expect_as_alone(3, name);
    write_packed(dump);
    expect_as_alone(3, name);
  }
}

TEST_F(SharedReading, SaysOfCutAndGarbledFilesWhatOneRankSays) {
  for (const std::string& text : texts)
    for (std::size_t k = 0; k < text.size(); k += 5) {
      SCOPED_TRACE(text.substr(0, k));
      write(text.substr(0, k));
      expect_as_alone(3);
      std::string other = text;
      other[k] = "x\n,- 9"[k % 6];
      write(other);
      expect_as_alone(4);
    }
  for (const std::string& more : {rows.substr(0, 22), rows + "3,-1,2\n", std::string("7,a,0,0,1\n7,0,0,0,1\n6,0,0,0\n")}) {
    write(table + more);
    for (const int count : {2, 3, 7}) expect_as_alone(count);
  }
  fs::remove(path());
  expect_as_alone(3);
  fs::create_directory(path());
  expect_as_alone(3);
}

/// It can be read once only.
TEST_F(SharedReading, NoPipe) {
  fs::create_symlink("/dev/null", path());
  support::on_threads(2, [&](const pfv::Ranks& ranks) {
    std::string refusal;
    try {
      pfv::read_packing_file(path(), {}, &ranks);
    } catch (const pfv::InputError& error) {
      refusal = error.what();
    }
    EXPECT_NE(refusal.find("this is a pipe or a device"), std::string::npos) << refusal;
  });
  EXPECT_NE(alone("last").refusal.find("is empty"), std::string::npos);
}

/// Of many blocks, with places and lines that are known.
TEST_F(SharedReading, LongFiles) {
  constexpr int many = 16000;
  std::string atoms;
  for (int k = 1; k <= many; ++k)
    atoms += std::to_string(k) + " 0." + std::to_string(k) + " 1.00000000000000000000 " + std::to_string(k % 7) + " 0.5\n";
  const auto line_of = [&](int k) { return atoms.find("\n" + std::to_string(k) + " ") + 1; };
  write("# grains\nid x y z radius\n" + atoms);
  const pfv::PackingArrays read = pfv::read_packing_file(path()).packing;
  ASSERT_EQ(read.ids.size(), many);
  for (int k = 1; k <= many; ++k)
    ASSERT_EQ(read.positions.col(k - 1), Eigen::Vector3d(std::stod("0." + std::to_string(k)), 1.0, k % 7)) << k;
  EXPECT_EQ(read.ids, pfv::Packing::Ids::LinSpaced(many, 1, many));
  expect_as_alone(3);

  const std::string names = "id x y z radius";
  const std::string dumps = snapshot(1, names, atoms) + snapshot(2, names, atoms.substr(0, line_of(9000))) + snapshot(3, names, atoms);
  write(dumps);
  for (const char* name : {"1", "2", "last"}) expect_as_alone(4, name);
  write_packed(dumps);
  for (const char* name : {"2", "last"}) expect_as_alone(2, name);

  std::string twice = atoms;
  twice[line_of(12000) + 1] = '1';
  write("# grains\nid x y z radius\n" + twice);
  EXPECT_EQ(alone("last").refusal, path() + ":12002: id 11000 stands in line 11002 too: give each sphere its own");
  expect_as_alone(5);
  twice[line_of(15000) + 8] = 'x';
  write(snapshot(1, names, twice));
  EXPECT_EQ(alone("last").refusal, path() + ":15009: x is '0.x5000': give a finite number");
  expect_as_alone(5);
}

}  // namespace
}  // namespace shared_reading_test
