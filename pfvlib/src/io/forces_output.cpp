// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/atomic_file.hpp"
#include "text/number_text.hpp"
#include "pfv/error.hpp"
#include "pfv/io.hpp"

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

}  // namespace

void write_forces(const std::string& path, const Packing& packing, const Forces& forces) {
  require_complete(packing, forces);
  std::string text = "id,fx,fy,fz,fpx,fpy,fpz,fvx,fvy,fvz\n";
  text.reserve(text.size() + static_cast<std::size_t>(packing.size()) * 200);
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    text += std::to_string(packing.ids[k]);
    append_vector(text, forces.total.col(k));
    append_vector(text, forces.pressure.col(k));
    append_vector(text, forces.viscous.col(k));
    text += '\n';
  }
  detail::write_file(path, text);
}

}  // namespace pfv
