// The report's JSON against the contract, and the plan's text.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "weft/report.h"

namespace weft {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [name, value] : object.items()) names.push_back(name);
  return names;
}

using Names = std::vector<std::string>;

TEST(Report, HasTheContractsKeysInTheContractsOrder) {
  const Json json = Json::parse(to_json(Report{}));
  EXPECT_EQ(keys(json), (Names{"scene",           "version",        "build",    "particles",
                               "constraints",     "frames",         "substeps", "dt",
                               "sim_seconds",     "threads",        "wall_ms",  "stages",
                               "skipped",         "notes",          "hash",     "energy",
                               "membrane_energy", "bending_energy", "momentum", "angular_momentum",
                               "strain",          "penetration",    "contact",  "torn",
                               "asleep",          "finite",         "status"}));
  EXPECT_EQ(keys(json["build"]), (Names{"compiler", "simd"}));
  EXPECT_EQ(keys(json["constraints"]), (Names{"structural", "shear", "bend"}));
  EXPECT_EQ(keys(json["wall_ms"]),
            (Names{"total", "frame_min", "frame_median", "frame_p99", "frame_max"}));
  EXPECT_EQ(keys(json["energy"]), (Names{"kinetic", "elastic", "gravity", "total"}));
  EXPECT_EQ(keys(json["strain"]), (Names{"max", "mean", "max_of_frames"}));
  EXPECT_EQ(keys(json["penetration"]),
            (Names{"collider_max", "self_pairs", "self_max", "crossings"}));
}

TEST(Report, CarriesItsValues) {
  Report report;
  report.scene = "swing";
  report.particles = 1024;
  report.constraints.shear = 1922;
  report.dt = 8.333e-4;
  report.stages = {{"integrate", 1.5, 600}};
  report.skipped = {{"self_collision", "off in the scene"}};
  report.hash = 0x00ab;
  report.momentum = {1, 2, 3};
  report.torn = 7;
  report.notes = {"a note"};
  report.membrane_energy = 2;
  report.bending_energy = 3;
  const Json json = Json::parse(to_json(report));
  EXPECT_EQ(json["scene"], "swing");
  EXPECT_EQ(json["particles"], 1024);
  EXPECT_EQ(json["notes"], Json({"a note"}));
  EXPECT_EQ(json["membrane_energy"], 2);
  EXPECT_EQ(json["bending_energy"], 3);
  EXPECT_TRUE(json["strain"]["max_of_frames"].is_null());
  report.strain.max_of_frames = 0.5;
  EXPECT_EQ(Json::parse(to_json(report))["strain"]["max_of_frames"], 0.5);
  EXPECT_EQ(json["constraints"]["shear"], 1922);
  EXPECT_EQ(json["dt"], 8.333e-4);
  EXPECT_EQ(keys(json["stages"][0]), (Names{"name", "ms", "calls"}));
  EXPECT_EQ(json["stages"][0]["ms"], 1.5);
  EXPECT_EQ(keys(json["skipped"][0]), (Names{"name", "why"}));
  EXPECT_EQ(json["hash"], "00000000000000ab");
  EXPECT_EQ(json["momentum"], Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(json["torn"], 7);
}

TEST(Report, StatusIsOkOrTheReason) {
  Report report;
  EXPECT_EQ(Json::parse(to_json(report))["status"], "ok");
  report.status.ok = false;
  report.status.text = "a position is not finite";
  EXPECT_EQ(Json::parse(to_json(report))["status"], "a position is not finite");
}

TEST(Report, StaysJsonWhateverItHolds) {
  Report report;
  report.scene = "\xff \"quoted\"\n";
  report.energy.total = std::nan("");
  const Json json = Json::parse(to_json(report));
  EXPECT_TRUE(json["energy"]["total"].is_null());
  EXPECT_EQ(to_json(report).back(), '\n');
}

TEST(Plan, ShowsStagesInOrderAndWhatWasLeftOut) {
  Plan plan;
  plan.stages = {{"forces", "structural, shear", 20, 3906, "constraints"},
                 {"colliders", "", 20, 1024, "particles"}};
  plan.skipped = {{"self_collision", "off in the scene"}};
  plan.notes = {"substeps from the stability limit"};
  plan.substeps = 20;
  plan.dt = 1e-3;
  plan.dt_limit = 2e-3;
  EXPECT_EQ(to_text(plan),
            "20 substeps a frame of 1 ms (stable below 2 ms)\n"
            "\n"
            "runs, in this order:\n"
            "     stage      times a frame  items             what\n"
            "  1  forces                20  3906 constraints  structural, shear\n"
            "  2  colliders             20  1024 particles\n"
            "\n"
            "left out:\n"
            "     self_collision  off in the scene\n"
            "\n"
            "notes:\n"
            "     substeps from the stability limit\n");
}

TEST(Plan, SaysNothingOfALimitThatIsNot) {
  Plan plan;
  plan.substeps = 1;
  EXPECT_EQ(to_text(plan).find("stable"), std::string::npos);
  EXPECT_EQ(to_text(plan).find("notes"), std::string::npos);
}

}  // namespace
}  // namespace weft
