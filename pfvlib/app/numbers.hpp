// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace pfv::app {

// The whole of `text` as a number; throw InputError that names `option`.

double number(const std::string& option, const std::string& text);    ///< finite
double positive(const std::string& option, const std::string& text);  ///< > 0
int whole_number(const std::string& option, const std::string& text, int least = 1,
                 int most = std::numeric_limits<int>::max());

/// Of one value or more; of an even number of them the mean of the middle two.
double median(std::vector<double> values);

}  // namespace pfv::app
