// `weft run --tolerance`: what it picks keeps the error that it promises, measured against a run of
// many times the substeps.
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

TEST(CliTolerance, RefusesWhatConvergesToNothing) {
  const Folder folder;
  swinging_sheet(folder, 300);
  const Outcome outcome =
      run_weft(folder, "run sheet.json --tolerance 0.01 --set /solver/method=positional");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("--tolerance: method positional"), std::string::npos) << outcome.err;
  EXPECT_EQ(run_weft(folder, "run sheet.json --tolerance 0").exit_code, 2);
}

}  // namespace
}  // namespace weft
