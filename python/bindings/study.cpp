#include "study.h"

#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "scenes.h"
#include "study/results.h"
#include "study/study.h"

namespace weft::python {

namespace {

Shard shard_of(const std::pair<std::uint64_t, std::uint64_t>& pair) {
  if (pair.first < 1 || pair.first > pair.second)
    throw py::value_error("shard is (" + std::to_string(pair.first) + ", " +
                          std::to_string(pair.second) + ") (allowed: (K, N), K from 1 to N)");
  return {pair.first - 1, pair.second};
}

// Asks the interpreter for Ctrl-C ten times a second, on the thread that began.
class Signals {
 public:
  bool keep_going() {
    if (std::this_thread::get_id() != thread_ || Clock::now() < next_) return !raised_;
    next_ = Clock::now() + std::chrono::milliseconds(100);
    const py::gil_scoped_acquire interpreter;
    if (PyErr_CheckSignals() != 0) {
      error_.emplace();
      raised_ = true;
    }
    return !raised_;
  }
  // Called with the interpreter's lock.
  void raise() {
    if (error_) throw py::error_already_set(*error_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  const std::thread::id thread_ = std::this_thread::get_id();
  Clock::time_point next_ = Clock::now();
  std::atomic<bool> raised_ = false;
  std::optional<py::error_already_set> error_;
};

void run(const Study& study, const std::string& path, int jobs, bool resume,
         const std::pair<std::uint64_t, std::uint64_t>& shard, const py::object& progress) {
  if (jobs < 0) throw py::value_error("jobs is " + std::to_string(jobs) + " (allowed: >= 0)");
  Signals signals;
  StudyOptions options{.path = path, .shard = shard_of(shard), .resume = resume, .jobs = jobs};
  options.keep_going = [&] { return signals.keep_going(); };
  options.progress = [&](std::uint64_t done, std::uint64_t all, std::uint64_t) {
    const py::gil_scoped_acquire interpreter;
    if (!progress.is_none()) progress(done, all);
  };
  {
    const py::gil_scoped_release free;
    run_study(study, options);
  }
  signals.raise();
}

py::bytes one_run(const Study& study, std::uint64_t run, int threads) {
  if (run >= study.runs()) throw py::index_error("there is no run " + std::to_string(run));
  Signals signals;
  std::string bytes;
  try {
    const py::gil_scoped_release free;
    bytes = to_bytes(study.run(run, threads, [&] { return signals.keep_going(); }));
  } catch (const Abandoned&) {
    signals.raise();
  }
  return bytes;
}

void register_study_error(py::module_& module) {
  static PyObject* const study_error =
      py::exception<StudyError>(module, "StudyError", PyExc_ValueError).release().ptr();
  py::setattr(study_error, "__doc__", py::str("A study that cannot be run, and every reason."));
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const StudyError& e) {
      PyErr_SetString(study_error, lines(e.faults).c_str());
    }
  });
}

}  // namespace

void register_study(py::module_& module) {
  register_study_error(module);
  py::class_<Study>(module, "Study", "A study: its runs, and how to run them (weft.study).")
      .def(py::init([](const py::object& spec, const std::string& folder) {
             const bool text = py::isinstance<py::str>(spec);
             return std::make_unique<Study>(text ? py::cast<std::string>(spec) : json_text(spec),
                                            folder);
           }),
           py::arg("spec"), py::arg("folder") = "", "Of a dict, or of the text of a STUDY file.")
      .def("__len__", &Study::runs)
      .def_property_readonly("text", &Study::text, "The study with its scene inside, as JSON.")
      .def("run", &one_run, py::arg("run"), py::arg("threads") = 1,
           "Simulates one run; its record, bytes for Results.append().")
      .def("run_all", &run, py::arg("path"), py::arg("jobs"), py::arg("resume"), py::arg("shard"),
           py::arg("progress"));
  py::class_<Results>(module, "Results", "Records on their way to a file (weft.study).")
      .def(py::init([](const Study& study, const std::string& path,
                       const std::pair<std::uint64_t, std::uint64_t>& shard, bool resume) {
             return std::make_unique<Results>(study, path, shard_of(shard), resume);
           }),
           py::keep_alive<1, 2>(), py::arg("study"), py::arg("path"), py::arg("shard"),
           py::arg("resume"))
      .def_property_readonly("missing", &Results::missing, "Runs that are not done yet.")
      .def(
          "append",
          [](Results& results, const py::bytes& bytes) {
            results.append(record_of(std::string(bytes)));
          },
          py::arg("record"), "Keeps a record; store() makes it safe.")
      .def("store", &Results::store, py::call_guard<py::gil_scoped_release>(),
           "Returns when the disk has all records that were appended.")
      .def("finish", &Results::finish, py::call_guard<py::gil_scoped_release>(),
           "Writes the file.");
  module.def("merge", &merge_study, py::arg("shards"), py::arg("path"),
             py::call_guard<py::gil_scoped_release>());
}

}  // namespace weft::python
