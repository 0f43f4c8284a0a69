// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "support/data_file.hpp"

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// Reference results of tests/data.
namespace support {

/// One row of a CSV file with a header: column name -> text.
using Row = std::map<std::string, std::string>;

inline std::ifstream open_data(const std::string& name) {
  std::ifstream file(data_file(name));
  if (!file) throw std::runtime_error("no test data " + name);
  return file;
}

inline std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream text(line);
  for (std::string field; std::getline(text, field, ',');) result.push_back(field);
  return result;
}

inline std::vector<Row> table(const std::string& name) {
  std::ifstream file = open_data(name);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> header = fields(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> values = fields(line);
    Row row;
    for (std::size_t i = 0; i < header.size(); ++i) row[header[i]] = values.at(i);
    rows.push_back(row);
  }
  return rows;
}

inline double number(const Row& row, const std::string& column) {
  return std::stod(row.at(column));
}

inline nlohmann::json json(const std::string& name) {
  std::ifstream file = open_data(name);
  return nlohmann::json::parse(file);
}

}  // namespace support
