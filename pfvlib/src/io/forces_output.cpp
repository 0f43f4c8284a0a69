// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/atomic_file.hpp"
#include "parallel/ranks.hpp"
#include "text/number_text.hpp"
#include "pfv/error.hpp"
#include "pfv/io.hpp"

#include <memory>

namespace pfv {
namespace {

void append_vector(std::string& text, const Eigen::Vector3d& vector) {
  for (const double component : vector) {
    text += ',';
    detail::append_number(text, component);
  }
}

void require_complete(const Packing& packing, const Forces& forces) {
  const Eigen::Index n = packing.size();
  if (forces.total.cols() != n || forces.pressure.cols() != n || forces.viscous.cols() != n)
    throw InputError("a forces file needs pressure and viscous parts of all " +
                     std::to_string(n) + " spheres: switch on Options::split_forces");
  for (Eigen::Index k = 0; k < n; ++k)
    if (!forces.total.col(k).allFinite() || !forces.pressure.col(k).allFinite() ||
        !forces.viscous.col(k).allFinite())
      throw SolverError("the force on sphere " + std::to_string(packing.ids[k]) +
                        " is not finite: check its radius and its neighbours");
}

std::string rows_of(const Packing& packing, const Forces& forces) {
  require_complete(packing, forces);
  std::string text;
  text.reserve(static_cast<std::size_t>(packing.size()) * 200);
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    text += std::to_string(packing.ids[k]);
    append_vector(text, forces.total.col(k));
    append_vector(text, forces.pressure.col(k));
    append_vector(text, forces.viscous.col(k));
    text += '\n';
  }
  return text;
}

/// What each rank has, one after the other, into a file of rank 0.
void write_in_turn(const std::string& path, const std::string& header, const std::string& own, const Ranks& ranks) {
  std::unique_ptr<detail::AtomicFile> file;
  const auto by_first = [&](const auto& write) {
    ranks.together([&] {
      if (ranks.own() == 0) write();
    });
  };
  by_first([&] {
    file = std::make_unique<detail::AtomicFile>(path);
    file->put(header);
  });
  for (int r = 0; r < ranks.count(); ++r) {
    std::vector<Ranks::Bytes> to(ranks.count());
    if (ranks.own() == r) to[0].assign(own.begin(), own.end());
    const Ranks::Bytes part = ranks.hand_over(to)[r];
    by_first([&] { file->put({part.data(), part.size()}); });
  }
  by_first([&] { file->finish(); });
}

}  // namespace

void write_forces(const std::string& path, const Packing& packing, const Forces& forces, const Ranks* ranks) {
  const std::string header = "id,fx,fy,fz,fpx,fpy,fpz,fvx,fvy,fvz\n";
  if (!ranks) {
    detail::write_file(path, header + rows_of(packing, forces));
    return;
  }
  std::string text;
  ranks->together([&] { text = rows_of(packing, forces); });
  write_in_turn(path, header, text, *ranks);
}

}  // namespace pfv
