// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/network.hpp"

#include <string>
#include <vector>

namespace pfv::python {

/// A network of Python's own, its places in the coordinates of the packing.
class NetworkArrays {
 public:
  NetworkArrays(PoreNetwork network, std::vector<std::string> walls);
  const PoreNetwork& get() const { return network_; }
  const std::vector<std::string>& walls() const { return walls_; }

 private:
  PoreNetwork network_;
  std::vector<std::string> walls_;
};

}  // namespace pfv::python
