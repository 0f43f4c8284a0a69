// SPDX-License-Identifier: GPL-3.0-or-later
#include "keywords.hpp"

#include <algorithm>
#include <pybind11/stl.h>
#include <sstream>

namespace pfv::python {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool is_truth_value(py::handle value) {
  return PyBool_Check(value.ptr()) || py::str(py::type::of(value).attr("__name__")).cast<std::string>() == "bool_";
}

bool has_length(py::handle value) {
  const bool has = PyObject_Size(value.ptr()) >= 0;
  PyErr_Clear();
  return has;
}

bool is_numpy_integer(py::handle value) {
  return PyIndex_Check(value.ptr()) && py::hasattr(value, "dtype") &&
         py::str(value.attr("dtype").attr("kind")).cast<std::string>() != "f";
}

/// As a command line would write it; a float in the digits that give it back.
void append_words(const std::string& name, py::handle value, std::vector<std::string>& words) {
  if (is_truth_value(value)) {
    words.push_back(value.cast<bool>() ? "yes" : "no");
  } else if (py::isinstance<py::str>(value)) {
    std::istringstream text(value.cast<std::string>());
    for (std::string word; text >> word;) words.push_back(word);
  } else if (has_length(value)) {
    for (const py::handle part : value) append_words(name, part, words);
  } else if (PyLong_Check(value.ptr()) || is_numpy_integer(value)) {
    words.push_back(py::str(value));
  } else if (PyNumber_Check(value.ptr())) {
    words.push_back(py::repr(py::float_(py::reinterpret_borrow<py::object>(value))));
  } else {
    throw py::type_error(name + " is " + std::string(py::repr(value)) +
                         ": give a number, a text, True or False, or several of them");
  }
}

void read_keyword(const Setting& setting, py::handle value, Settings& settings) {
  static const Settings defaults;
  const bool is_left_out = value.is_none() && setting.text(defaults) == "none";
  if (is_left_out) return;
  std::vector<std::string> texts;
  append_words(setting.name, value, texts);
  Words words(texts, setting.name);
  read(setting, words, settings);
  if (!words.done()) words.fail("too many values: give " + setting.values);
}

py::list models_of(const Setting& setting) {
  py::list models;
  for (const Model model : setting.models) models.append(name_of(model));
  return models;
}

}  // namespace

std::vector<std::string> fluid_keywords() { return {"viscosity", "density", "gravity", "bulk_modulus"}; }

std::vector<std::string> all_keywords() {
  std::vector<std::string> names;
  for (const Setting& setting : all_settings())
    if (setting.hosts.python) names.emplace_back(setting.name);
  return names;
}

void require_known(const std::string& function, const std::string& keyword, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), keyword) != names.end()) return;
  const std::string meant = meant_by(keyword, names);
  throw py::type_error(function + " has no keyword '" + keyword + "'" +
                       (meant.empty() ? ": it has " : meant + " It has ") + joined(names));
}

void read_keywords(const std::string& function, const py::kwargs& keywords, const std::vector<std::string>& names,
                   Settings& settings) {
  for (const auto& [key, value] : keywords) {
    const auto keyword = key.cast<std::string>();
    require_known(function, keyword, names);
    read_keyword(*setting_named(keyword), value, settings);
  }
}

py::list table_of_settings() {
  using namespace py::literals;
  py::list table;
  for (const Setting& setting : all_settings())
    if (setting.hosts.python)
      table.append(py::dict("name"_a = setting.name, "group"_a = setting.group, "values"_a = setting.values,
                            "unit"_a = setting.unit, "default"_a = setting.text(Settings{}),
                            "models"_a = models_of(setting), "help"_a = setting.help));
  return table;
}

std::string help_of(const std::vector<std::string>& names) {
  std::string help;
  for (const std::string& name : names) {
    const Setting& setting = *setting_named(name);
    const std::string unit = setting.unit;
    help += "\n    " + name + " = " + setting.values + (unit.empty() ? "" : " (" + unit + ")") + ": " + setting.help +
            setting.lacks + " (default " + setting.text(Settings{}) + ")";
  }
  return help;
}

}  // namespace pfv::python
