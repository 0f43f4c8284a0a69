// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/atomic_file.hpp"
#include "pfv/io.hpp"
#include "pfv/version.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace pfv {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(double value) { return std::isfinite(value) ? Json(value + 0.0) : Json(nullptr); }
Json json_of(std::int64_t value) { return value; }
Json json_of(int value) { return value; }
Json json_of(const std::string& value) { return value; }
Json json_of(const std::vector<std::string>& value) { return value; }
Json json_of(const Eigen::Vector3d& value) {
  return Json::array({json_of(value[0]), json_of(value[1]), json_of(value[2])});
}
Json json_of(const Eigen::Matrix3d& tensor) {
  return {json_of(Eigen::Vector3d(tensor.row(0))), json_of(Eigen::Vector3d(tensor.row(1))),
          json_of(Eigen::Vector3d(tensor.row(2)))};
}
template <class Value>
Json json_of(const std::optional<Value>& value) {
  return value ? json_of(*value) : Json(nullptr);
}

Json json_of(const std::vector<FaceResult>& faces) {
  Json json;
  for (const FaceResult& face : faces)
    json[face.name] = {{"flux", json_of(face.flux)},
                       {"force_pressure", json_of(face.force_pressure)},
                       {"force_viscous", json_of(face.force_viscous)},
                       {"moment", json_of(face.moment)}};
  return json;
}

Json json_of(const std::vector<ObstacleResult>& obstacles) {
  Json list = Json::array();
  for (const ObstacleResult& one : obstacles)
    list.push_back({{"name", one.name},
                    {"spheres", one.spheres},
                    {"volume", one.volume},
                    {"union_volume", one.union_volume},
                    {"recess", one.recess},
                    {"protrusion", one.protrusion},
                    {"centre", json_of(one.centre)},
                    {"force", json_of(one.force)},
                    {"moment", json_of(one.moment)}});
  return list;
}

Json json_of(const std::vector<OpeningResult>& openings) {
  Json json = Json::array();
  for (const OpeningResult& opening : openings)
    json.push_back({{"name", opening.name},
                    {"pores", opening.pores},
                    {"flux", json_of(opening.flux)},
                    {"pressure", json_of(opening.pressure)}});
  return json;
}

template <class Part>
void add_entries(const Part& part, Json& json);

Json json_of(const Counts& counts) { Json json; add_entries(counts, json); return json; }
Json json_of(const Seconds& seconds) { Json json; add_entries(seconds, json); return json; }
Json json_of(const WallSeconds& seconds) { Json json; add_entries(seconds, json); return json; }

template <class Part>
void add_entries(const Part& part, Json& json) {
  for_each_entry(part, [&json](const char* name, const auto& value) { json[name] = json_of(value); });
}

}  // namespace

std::string json_of(const Report& report) {
  Json json{{"version", version}};
  add_entries(report, json);
  return json.dump(2) + "\n";
}

void write_report(const std::string& path, const Report& report) {
  detail::write_file(path, json_of(report));
}

}  // namespace pfv
