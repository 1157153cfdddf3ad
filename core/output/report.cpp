// The report as JSON, in the order and with the names of the contract.
#include "weft/report.h"

#include <nlohmann/json.hpp>

#include "output/hex.h"

namespace weft {

namespace {

using Json = nlohmann::ordered_json;

Json stages_json(const std::vector<StageTime>& stages) {
  Json list = Json::array();
  for (const StageTime& stage : stages) {
    list.push_back({{"name", stage.name}, {"ms", stage.ms}, {"calls", stage.calls}});
  }
  return list;
}

Json skipped_json(const std::vector<SkippedStage>& skipped) {
  Json list = Json::array();
  for (const SkippedStage& stage : skipped) {
    list.push_back({{"name", stage.name}, {"why", stage.why}});
  }
  return list;
}

// What was simulated, and how.
void add_run(Json& json, const Report& report) {
  json["scene"] = report.scene;
  json["version"] = report.version;
  json["build"] = {{"compiler", report.compiler}, {"simd", report.simd}};
  json["particles"] = report.particles;
  json["constraints"] = {{"structural", report.constraints.structural},
                         {"shear", report.constraints.shear},
                         {"bend", report.constraints.bend}};
  json["frames"] = report.frames;
  json["substeps"] = report.substeps;
  json["dt"] = report.dt;
  json["sim_seconds"] = report.sim_seconds;
  json["threads"] = report.threads;
  json["wall_ms"] = {{"total", report.wall_ms.total},
                     {"frame_min", report.wall_ms.frame_min},
                     {"frame_median", report.wall_ms.frame_median},
                     {"frame_p99", report.wall_ms.frame_p99},
                     {"frame_max", report.wall_ms.frame_max}};
  json["stages"] = stages_json(report.stages);
  json["skipped"] = skipped_json(report.skipped);
  json["notes"] = report.notes;
}

// What came of it.
void add_outcome(Json& json, const Report& report) {
  json["hash"] = hex16(report.hash);
  json["energy"] = {{"kinetic", report.energy.kinetic},
                    {"elastic", report.energy.elastic},
                    {"gravity", report.energy.gravity},
                    {"total", report.energy.total}};
  json["membrane_energy"] = report.membrane_energy;
  json["bending_energy"] = report.bending_energy;
  json["momentum"] = report.momentum;
  json["angular_momentum"] = report.angular_momentum;
  const std::optional<double>& of_frames = report.strain.max_of_frames;
  json["strain"] = {{"max", report.strain.max},
                    {"mean", report.strain.mean},
                    {"max_of_frames", of_frames ? Json(*of_frames) : Json(nullptr)}};
  json["penetration"] = {{"collider_max", report.penetration.collider_max},
                         {"self_pairs", report.penetration.self_pairs},
                         {"self_max", report.penetration.self_max},
                         {"crossings", report.penetration.crossings}};
  json["contact"] = {{"contacts", report.contact.contacts},
                     {"energy_taken", report.contact.energy_taken},
                     {"greatest_clamp", report.contact.greatest_clamp},
                     {"least_distance", report.contact.least_distance}};
  json["torn"] = report.torn;
  json["asleep"] = report.asleep;
  json["finite"] = report.finite;
  json["status"] = report.status.ok ? "ok" : report.status.text;
}

}  // namespace

std::string to_json(const Report& report) {
  Json json;
  add_run(json, report);
  add_outcome(json, report);
  // A scene's name may hold any bytes; what is not UTF-8 must not cost the report.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace weft
