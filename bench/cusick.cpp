// The drape coefficients of the fabrics by the test of Cusick (tests/cusick.h), the mean of three specimens with other
// waves about the rim, on meshes of the rings that are asked for (20 and 40 unless told), and of the first specimen on
// the first of them turned against warp and waves. Folds are counted, and the greatest speed tells how far the disc is from rest.
#include "../tests/cusick.h"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "weft/fabric.h"

namespace {

using namespace weft;

double told(const std::string& fabric, const cusick::Disc& disc) {
  const cusick::Drape d = cusick::drape(cusick::scene_of(fabric, disc));
  std::printf("%-8s %5d %6.0f %7.1f %9.1f %6d %9.1e\n", fabric.c_str(), disc.rings, disc.turn,
              disc.phase, d.coefficient, d.folds, d.speed);
  std::fflush(stdout);
  return d.coefficient;
}

}  // namespace

int main(int count, char** words) {
  std::vector<int> sizes;
  for (int k = 1; k < count; ++k) sizes.push_back(std::atoi(words[k]));
  if (sizes.empty()) sizes = {20, 40};
  std::printf("fabric   rings   turn   waves  drape [%%]  folds  speed [m/s]\n");
  for (const Fabric& fabric : fabrics()) {
    const std::string name(fabric.name);
    for (const int rings : sizes) {
      double sum = 0;
      for (const double phase : {2.4, 1.7, 0.9})
        sum += told(name, {.rings = rings, .phase = phase});
      std::printf("%-8s %5d %23.1f  mean\n", name.c_str(), rings, sum / 3);
    }
    for (const double turn : {15.0, 30.0}) told(name, {.rings = sizes[0], .turn = turn});
  }
}
