// The class Simulation of Python.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "weft/simulation.h"

namespace weft::python {

namespace py = pybind11;

// A simulation has stopped itself; Python's SimulationError.
struct Stopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A simulation, and the lock that its callers take one after the other: while one steps without the
// interpreter's lock, other threads of Python may call as well.
class Shared {
 public:
  Shared(Scene scene, const Options& options, std::vector<std::string> notes)
      : simulation_(std::move(scene), options), notes_(std::move(notes)) {}

  // Calls work(simulation) without the interpreter's lock; work must not touch Python.
  template <class Work>
  auto call(const Work& work) {
    const py::gil_scoped_release free;
    return call_free(work);
  }
  // The same where the caller has let go of the interpreter's lock.
  template <class Work>
  auto call_free(const Work& work) {
    const std::lock_guard hold(mutex_);
    return work(simulation_);
  }
  const std::vector<std::string>& notes() const { return notes_; }  // on how the scene was read

 private:
  std::mutex mutex_;
  Simulation simulation_;
  std::vector<std::string> notes_;
};

// Reads the scene and builds it. `threads` and `seed` as Options have them, `simd` by its name.
std::shared_ptr<Shared> build(const py::object& scene, const py::dict& values, int threads,
                              std::uint64_t seed, const std::string& simd, bool follow_strain);

// Why it stopped itself: "frame 12, ...".
std::string reason(const Status& status);

// An array of Python that owns the values.
template <class T>
py::array array_of(std::vector<T>&& values, std::vector<py::ssize_t> shape) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  T* const data = kept->data();
  const py::capsule owner(kept.release(), [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(std::move(shape), data, owner);
}

void register_simulation(py::module_& module);
void register_batch(py::module_& module);

}  // namespace weft::python
