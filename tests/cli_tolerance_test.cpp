// `weft run --tolerance`: what it picks keeps the error that it promises, measured against a run of
// many times the substeps; and what it says where it promises nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "program.h"

namespace weft {
namespace {

void swinging_sheet(const Folder& folder, double stiffness) {
  folder.write("sheet.json", R"({"weft": 1, "name": "sheet", "time": {"seconds": 0.25},
    "cloths": [{"grid": {"points": [12, 12]}, "stiffness": {"structural": )" +
                                 std::to_string(stiffness) + R"(, "shear": )" +
                                 std::to_string(stiffness) + R"(, "bend": 0},
    "pins": [[0, 0], [11, 0]]}]})");
}

std::vector<double> dumped(const Folder& folder, const std::string& name) {
  const std::string bytes = folder.read(name);
  std::vector<double> values(bytes.size() / sizeof(double));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
  return values;
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(3 * sum / double(a.size()));
}

TEST(CliTolerance, KeepsTheErrorThatItPromises) {
  for (const double stiffness : {300.0, 1e5}) {
    const Folder folder;
    swinging_sheet(folder, stiffness);
    const std::string fine = stiffness > 1e4 ? "2000" : "400";
    ASSERT_EQ(
        run_weft(folder, "run sheet.json --dump truth.f64 --set /time/substeps=" + fine).exit_code,
        0);
    const std::vector<double> truth = dumped(folder, "truth.f64");
    for (const std::string tolerance : {"0.03", "0.003"}) {
      const Outcome outcome =
          run_weft(folder, "run sheet.json --dump picked.f64 --tolerance " + tolerance);
      ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
      EXPECT_NE(outcome.out.find("\n* "), std::string::npos) << outcome.out;
      const double error = rms(dumped(folder, "picked.f64"), truth);
      std::printf("%g N/m, tolerance %s m: error %.2e m\n%s", stiffness, tolerance.c_str(), error,
                  outcome.out.substr(0, outcome.out.find("scene")).c_str());
      EXPECT_LT(error, 1.5 * std::stod(tolerance)) << outcome.out;
    }
  }
}

TEST(CliTolerance, PicksAnotherMethodForStiffCloth) {
  const Folder folder;
  swinging_sheet(folder, 1e7);
  const Outcome outcome = run_weft(folder, "run sheet.json --tolerance 0.05");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("* compliant"), std::string::npos) << outcome.out;
}

TEST(CliTolerance, PicksGridsAndSaysWhich) {
  const Folder folder;
  folder.write("side.json", R"({"weft": 1, "name": "side", "time": {"seconds": 0.3},
    "cloths": [{"grid": {"points": [17, 9], "u": [1, 0, 0], "v": [0, 0, 0.5]}, "bending": 1e-3, "drag": 1,
    "stiffness": {"structural": 1000, "shear": 500, "bend": 0},
    "pins": [{"box": [[-0.01, -1, -1], [0.01, 1, 1]]}]}]})");
  const Outcome outcome = run_weft(
      folder, "run side.json --tolerance 0.01 --resolution auto --dump p.f64 --report r.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  int nx = 0, ny = 0;
  const std::size_t at = outcome.out.find("--tolerance: ");
  ASSERT_NE(at, std::string::npos) << outcome.out;
  const std::string note = outcome.out.substr(at, outcome.out.find('\n', at) - at);
  const std::size_t points = note.find(", ", note.rfind(" x ") - 6);
  ASSERT_EQ(std::sscanf(note.c_str() + points + 2, "%d x %d points", &nx, &ny), 2) << note;
  EXPECT_EQ(nx, 2 * ny - 1) << note;
  EXPECT_EQ(dumped(folder, "p.f64").size(), std::size_t(3 * nx * ny)) << note;
  EXPECT_NE(folder.read("r.json").find(note), std::string::npos);
  EXPECT_EQ(outcome.out.find("not promised"), std::string::npos) << outcome.out;

  const Outcome without = run_weft(
      folder, "run side.json --tolerance 0.01 --resolution auto --set /cloths/0/bending=0");
  EXPECT_EQ(without.exit_code, 0) << without.err;
  EXPECT_NE(without.out.find("has no bending"), std::string::npos) << without.out;
}

TEST(CliTolerance, RefusesWhatConvergesToNothing) {
  const Folder folder;
  swinging_sheet(folder, 300);
  const Outcome outcome =
      run_weft(folder, "run sheet.json --tolerance 0.01 --set /solver/method=positional");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("--tolerance: method positional"), std::string::npos) << outcome.err;
  EXPECT_EQ(run_weft(folder, "run sheet.json --tolerance 0").exit_code, 2);
  EXPECT_EQ(run_weft(folder, "run sheet.json --resolution auto").exit_code, 2);
  EXPECT_EQ(run_weft(folder, "run sheet.json --tolerance 0.01 --resolution fine").exit_code, 2);
  const Outcome mesh = run_weft(folder, "run bag --tolerance 0.01 --resolution auto");
  EXPECT_EQ(mesh.exit_code, 2);
  EXPECT_NE(mesh.err.find("--tolerance: a cloth is a mesh"), std::string::npos) << mesh.err;
}

}  // namespace
}  // namespace weft
