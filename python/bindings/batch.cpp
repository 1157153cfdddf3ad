// weft.Batch: many simulations stepped side by side.
#include <pybind11/stl.h>

#include "scenes.h"
#include "simulation.h"
#include "study/jobs.h"
#include "surface.h"

namespace weft::python {

namespace {

class Batch {
 public:
  Batch(const py::iterable& scenes, const py::object& seeds, int threads)
      : threads_(thread_count(checked(threads))) {
    if (py::isinstance<py::dict>(scenes) || py::isinstance<py::str>(scenes))
      throw py::type_error("scenes: a list of scenes is needed, not one scene");
    const py::list list(scenes);
    if (list.empty()) throw py::value_error("scenes: at least one is needed");
    const std::vector<std::uint64_t> seed = seeds_of(seeds, list.size());
    const int each = threads_for_each(threads_, list.size());
    for (std::size_t k = 0; k < list.size(); ++k) {
      all_.push_back(build(list[k], py::dict(), each, seed[k], "best", false));
      require_equal(k);
    }
  }

  std::size_t size() const { return all_.size(); }
  std::shared_ptr<Shared> at(std::int64_t k) const {
    const auto size = std::int64_t(all_.size());
    if (k < -size || k >= size)
      throw py::index_error("there is no simulation " + std::to_string(k) + " (allowed: " +
                            std::to_string(-size) + " to " + std::to_string(size - 1) + ")");
    return all_[std::size_t(k < 0 ? k + size : k)];
  }

  void advance(std::int64_t frames) {
    require_frames(frames);
    each([&](std::size_t, Simulation& s) {
      for (std::int64_t n = 0; n < frames && s.status().ok; ++n) s.advance_frame();
    });
    refuse_stopped();
  }

  // (simulations, samples, particles, 3) float32
  py::array record(std::int64_t frames, std::int64_t every) {
    require_frames(frames);
    if (every < 1) throw py::value_error("every is " + std::to_string(every) + " (allowed: >= 1)");
    const std::int64_t samples = frames / every;
    py::array_t<float> array(
        {py::ssize_t(size()), py::ssize_t(samples), py::ssize_t(particles_), py::ssize_t(3)});
    const auto values = std::size_t(3 * particles_);
    float* const data = array.mutable_data();
    std::fill_n(data, array.size(), std::numeric_limits<float>::quiet_NaN());
    each([&](std::size_t k, Simulation& s) {
      float* to = data + k * std::size_t(samples) * values;
      for (std::int64_t n = 1; n <= frames && s.status().ok; ++n) {
        s.advance_frame();
        if (n % every != 0 || !s.status().ok) continue;
        for (const double x : s.positions()) *to++ = float(x);
      }
    });
    refuse_stopped();
    return array;
  }

  // The same function of every simulation, 3 numbers a particle: (simulations, particles, 3).
  py::array stacked(std::vector<double> (Simulation::*values)() const) {
    py::array_t<double> array({py::ssize_t(size()), py::ssize_t(particles_), py::ssize_t(3)});
    double* const data = array.mutable_data();
    each([&](std::size_t k, Simulation& s) {
      const std::vector<double> one = (s.*values)();
      if (one.size() != std::size_t(3 * particles_))
        throw std::invalid_argument("simulation " + std::to_string(k) +
                                    " has other particles than at the start");
      std::copy(one.begin(), one.end(), data + k * one.size());
    });
    return array;
  }

  std::vector<std::uint64_t> hashes() {
    std::vector<std::uint64_t> all(size());
    each([&](std::size_t k, Simulation& s) { all[k] = s.hash(); });
    return all;
  }
  py::list reports(bool contacts) {
    std::vector<std::string> texts(size());
    each([&](std::size_t k, Simulation& s) { texts[k] = to_json(s.report(contacts)); });
    py::list list;
    for (const std::string& text : texts) list.append(json_value(text));
    return list;
  }

 private:
  static int checked(int threads) {
    if (threads < 0 || threads > 256)
      throw py::value_error("threads is " + std::to_string(threads) + " (allowed: 0 to 256)");
    return threads;
  }
  static void require_frames(std::int64_t frames) {
    if (frames < 0)
      throw py::value_error("frames is " + std::to_string(frames) + " (allowed: >= 0)");
  }
  static std::vector<std::uint64_t> seeds_of(const py::object& seeds, std::size_t count) {
    if (seeds.is_none()) return std::vector<std::uint64_t>(count, 1);
    auto all = py::cast<std::vector<std::uint64_t>>(seeds);
    if (all.size() != count)
      throw py::value_error("seeds: there are " + std::to_string(all.size()) +
                            " (allowed: " + std::to_string(count) + ", one a scene)");
    return all;
  }
  void require_equal(std::size_t k) {
    const std::int64_t particles =
        all_[k]->call_free([](const Simulation& s) { return particle_total(s.scene()); });
    if (k == 0) particles_ = particles;
    if (particles != particles_)
      throw py::value_error("scene " + std::to_string(k) + " has " + std::to_string(particles) +
                            " particles (allowed: " + std::to_string(particles_) +
                            ", as scene 0; arrays are stacked)");
  }
  // work(k, simulation) for all, side by side, without the interpreter's lock.
  template <class Work>
  void each(const Work& work) {
    const py::gil_scoped_release free;
    run_jobs(size(), threads_,
             [&](std::size_t k) { all_[k]->call_free([&](Simulation& s) { work(k, s); }); });
  }
  void refuse_stopped() {
    std::string text;
    for (std::size_t k = 0; k < size(); ++k) {
      const Status status = all_[k]->call([](const Simulation& s) { return s.status(); });
      if (!status.ok)
        text += (text.empty() ? "" : "\n") + std::to_string(k) + ": " + reason(status);
    }
    if (!text.empty()) throw Stopped(text);
  }

  int threads_;
  std::int64_t particles_ = 0;
  std::vector<std::shared_ptr<Shared>> all_;
};

}  // namespace

void register_batch(py::module_& module) {
  py::class_<Batch>(module, "Batch", R"(Many simulations in one call, on all cores.

scenes:  as those of Simulation, all with the same number of particles
seeds:   one for each, or None: 1
threads: 0 = all cores; the bits are the same for any number

    batch = weft.Batch([{**scene, "gravity": [0, -g, 0]} for g in (1, 5, 9.81)])
    x = batch.record(240, every=4)   # (simulations, 60, particles, 3) float32
    batch[1].report()                # one of them, a Simulation
)")
      .def(py::init<const py::iterable&, const py::object&, int>(), py::arg("scenes"),
           py::kw_only(), py::arg("seeds") = py::none(), py::arg("threads") = 0)
      .def("__len__", &Batch::size)
      .def("__getitem__", &Batch::at, py::arg("k"))
      .def(
          "advance", &Batch::advance, py::arg("frames") = 1,
          "Advances all. Raises SimulationError, when all others are done, for those that stopped.")
      .def("record", &Batch::record, py::arg("frames"), py::arg("every") = 1,
           "Advances all, and returns their positions after each `every` frames:\n"
           "(simulations, frames // every, particles, 3) float32 [m].")
      .def_property_readonly(
          "positions", [](Batch& b) { return b.stacked(&Simulation::positions); },
          "(simulations, particles, 3) float64 [m], a copy.")
      .def_property_readonly(
          "velocities", [](Batch& b) { return b.stacked(&Simulation::velocities); },
          "(simulations, particles, 3) float64 [m/s], a copy.")
      .def_property_readonly("hashes", &Batch::hashes, "A 64-bit hash of each one's positions.")
      .def("reports", &Batch::reports, py::arg("contacts") = true,
           "Each one's report, a list of dicts.");
}

}  // namespace weft::python
