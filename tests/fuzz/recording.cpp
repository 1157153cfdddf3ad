// Recordings: any bytes are read or refused with a reason; short ones that are read are replayed.
#include "weft/recording.h"

#include "target.h"

namespace {

constexpr std::size_t kMostEvents = 4;
constexpr int kMostParticles = 64;
constexpr int kMostSubsteps = 20;

bool small(const weft::Scene& scene) {
  int particles = 0;
  for (const weft::Cloth& c : scene.cloths) {
    if (c.grid.nx > kMostParticles || c.grid.ny > kMostParticles) return false;
    particles += c.grid.nx * c.grid.ny;
  }
  return particles <= kMostParticles && scene.time.substeps > 0 &&
         scene.time.substeps <= kMostSubsteps && scene.solver.iterations <= kMostSubsteps;
}

void replay(const weft::Recording& recording) {
  weft::Options options;
  options.threads = 1;
  options.seed = recording.seed;
  weft::Simulation simulation(recording.scene, options);
  for (std::size_t next = 0; next < recording.events.size();) {
    while (const weft::Input* input = next_input(recording, next, simulation)) {
      if (input->scene && !small(*input->scene)) return;
      apply(*input, simulation);
    }
    if (next >= recording.events.size()) return;
    simulation.advance_frame();
    compare_hash(recording, next, simulation);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(fuzz::text_of(data, size));
  try {
    const weft::Recording recording = weft::read_recording(file.path());
    if (recording.events.size() <= kMostEvents && small(recording.scene)) replay(recording);
  } catch (const weft::RecordingError& error) {
    fuzz::require(error.what()[0] != '\0');
  } catch (const std::logic_error& error) {  // an input for a particle that is not there
    fuzz::require(error.what()[0] != '\0');
  }
  return 0;
}
