// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "flow_host.hpp"

namespace pfv::python {

/// What a flow answers from its last step.
void add_results(py::class_<FlowHost>& flow);

}  // namespace pfv::python
