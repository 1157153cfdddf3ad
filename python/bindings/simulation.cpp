#include "simulation.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "scenes.h"
#include "surface.h"
#include "weft/mesh.h"

namespace weft::python {

namespace {

using Positions = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Windows onto one cloth's arrays. Each keeps the memory that it looks at.
struct ClothArrays {
  py::array positions, velocities, inverse_mass;
  py::object lanes;  // of a mesh; of a grid None
  Vec3 origin;
};

// A read-only array of `axes` components, each `plane` floats after the other, that keeps `memory`.
py::array window(const float* data, const ClothView& c, std::ptrdiff_t plane,
                 const std::shared_ptr<const void>& memory) {
  using Kept = std::shared_ptr<const void>;
  const py::capsule owner(new Kept(memory), [](void* p) { delete static_cast<Kept*>(p); });
  // The rows of a mesh are of different lengths: they come with their padding.
  std::vector<py::ssize_t> shape{c.rows, c.lanes.empty() ? c.columns : c.stride},
      strides{c.stride * 4L, 4};
  if (plane != 0) shape.push_back(3), strides.push_back(plane * 4);
  const py::array array(py::dtype::of<float>(), shape, strides, data, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

py::object lanes_of(const ClothView& c) {
  if (c.lanes.empty()) return py::none();
  return py::array(py::ssize_t(c.lanes.size()), c.lanes.data());
}

std::vector<ClothArrays> windows(Shared& shared) {
  const auto [view, memory] =
      shared.call([](const Simulation& s) { return std::pair(s.view(), s.memory()); });
  std::vector<ClothArrays> all;
  for (const ClothView& c : view.cloths)
    all.push_back({window(c.x.data(), c, c.y.data() - c.x.data(), memory),
                   window(c.vx.data(), c, c.vy.data() - c.vx.data(), memory),
                   window(c.inverse_mass.data(), c, 0, memory), lanes_of(c), view.origin});
  return all;
}

py::array triples(std::vector<double>&& values) {
  const auto count = py::ssize_t(values.size() / 3);
  return array_of(std::move(values), {count, 3});
}

// What `set_state` is given: (particles, 3) real numbers.
Positions checked(const py::array& values, const char* name, std::size_t particles) {
  const char kind = values.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u')
    throw py::type_error(std::string(name) + ": dtype is " + std::string(py::str(values.dtype())) +
                         " (allowed: real numbers)");
  const bool fits =
      values.ndim() == 2 && std::size_t(values.shape(0)) == particles && values.shape(1) == 3;
  if (!fits)
    throw py::value_error(std::string(name) + ": shape is " +
                          std::string(py::str(values.attr("shape"))) + " (allowed: (" +
                          std::to_string(particles) + ", 3))");
  return values;
}

void set_state(Shared& shared, const py::array& positions, const py::array& velocities) {
  const auto particles =
      std::size_t(shared.call([](const Simulation& s) { return particle_total(s.scene()); }));
  const Positions x = checked(positions, "positions", particles);
  const Positions v = checked(velocities, "velocities", particles);
  shared.call([&, n = 3 * particles](Simulation& s) { s.set_state({x.data(), n}, {v.data(), n}); });
}

// Frames until `left` is none, a tenth of a second is over, or the simulation stops itself.
std::int64_t advance_a_while(Simulation& s, std::int64_t left) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::milliseconds(100);
  do {
    s.advance_frame();
    --left;
  } while (left > 0 && s.status().ok && Clock::now() < end);
  return s.status().ok ? left : -1;
}

void advance(Shared& shared, std::int64_t frames) {
  if (frames < 0) throw py::value_error("frames is " + std::to_string(frames) + " (allowed: >= 0)");
  while (frames > 0) {
    frames = shared.call([&](Simulation& s) { return advance_a_while(s, frames); });
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  if (const Status status = shared.call([](const Simulation& s) { return s.status(); }); !status.ok)
    throw Stopped(reason(status));
}

void set_value(Shared& shared, const std::string& pointer, const py::object& value) {
  const Override change{pointer, json_text(value)};
  shared.call([&](Simulation& s) {
    SceneFile file = read_scene_text(write_scene_text(s.scene()), {change});
    MeshStore known;
    known.take(s.scene());
    known.give(file.scene);
    load_meshes(file.scene, "", file.faults, file.notes);
    if (!file.faults.empty()) throw SceneError(std::move(file.faults));
    s.set_scene(std::move(file.scene));
  });
}

py::dict report(Shared& shared, bool contacts) {
  return json_value(shared.call([&](const Simulation& s) { return to_json(s.report(contacts)); }));
}

std::vector<std::string> notes(Shared& shared) {
  std::vector<std::string> all = shared.notes();
  for (const std::string& note : shared.call([](const Simulation& s) { return s.plan().notes; }))
    all.push_back(note);
  return all;
}

Simd simd_of(const std::string& name) {
  for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512})
    if (name == simd_name(simd)) return simd;
  if (name == "best") return Simd::best;
  throw py::value_error("simd is \"" + name + "\" (allowed: best, scalar, sse2, avx2, avx512)");
}

using Class = py::class_<Shared, std::shared_ptr<Shared>>;

// A method of the same name and arguments, called without the interpreter's lock.
template <class... Arguments, class... Extra>
void method(Class& type, const char* name, void (Simulation::*call)(Arguments...),
            const Extra&... extra) {
  type.def(
      name,
      [call](Shared& shared, const std::decay_t<Arguments>&... arguments) {
        shared.call([&](Simulation& s) { (s.*call)(arguments...); });
      },
      extra...);
}

void register_arrays(Class& type) {
  type.def_property_readonly("cloths", &windows,
                             R"(Windows onto each cloth's arrays, without a copy.

A list with, for each cloth of r rows and c columns, positions (r, c, 3) float32 [m, from `origin`],
velocities (r, c, 3) float32 [m/s; half a substep behind but for solvers of order 2], inverse_mass (r, c)
float32 [1/kg; 0 = held] and origin, 3 floats [m]. The rows of a mesh are padded: `lanes` tells where its
vertices are, positions.reshape(-1, 3)[lanes]. Read-only. They always show the present state; they
stay valid when the simulation is gone, and hold its memory until they are. After set(), set_scene()
and restore() ask for them anew: older ones keep the state of before.)");
  type.def_property_readonly(
      "positions",
      [](Shared& s) { return triples(s.call([](const Simulation& x) { return x.positions(); })); },
      "A copy of all positions, (particles, 3) float64 [m]: cloth after cloth, row after row.");
  type.def_property_readonly(
      "velocities",
      [](Shared& s) { return triples(s.call([](const Simulation& x) { return x.velocities(); })); },
      "A copy of all velocities at `time`, (particles, 3) float64 [m/s]; those of methods that "
      "project, where\n"
      "the solver is of order 1, are of half a substep before.");
  type.def_property_readonly(
      "triangles",
      [](Shared& shared) {
        auto t = shared.call([](const Simulation& s) { return triangles_of(s); });
        const auto count = py::ssize_t(t.size() / 3);
        return array_of(std::move(t), {count, 3});
      },
      "Corners of the surface's triangles as rows of `positions`, (triangles, 3) uint32; of torn\n"
      "cloth those that are whole.");
  type.def_property_readonly(
      "edges",
      [](Shared& shared) {
        auto e = shared.call([](const Simulation& s) { return edges_of(s.scene()); });
        const auto count = py::ssize_t(e.size() / 2);
        return array_of(std::move(e), {count, 2});
      },
      "The structural constraints by their two particles, (edges, 2) uint32; see `strain`.");
  type.def_property_readonly(
      "strain",
      [](Shared& shared) {
        auto e = shared.call([](const Simulation& s) { return strain_of(s); });
        const auto count = py::ssize_t(e.size());
        return array_of(std::move(e), {count});
      },
      "Length / rest length - 1 of every one of `edges`, (edges,) float64; NaN where it is torn.");
}

void register_measures(Class& type) {
  type.def_property_readonly(
      "energies", [](Shared& s) -> py::object { return report(s, false)["energy"]; },
      "Energies now, a dict of kinetic, elastic, gravity and total [J].");
  type.def("report", &report, py::arg("contacts") = true,
           R"(Everything measured so far, as the dict that `weft run --report` writes.

contacts=False leaves out penetration and crossings, which take the longest.
["strain"]["max_of_frames"] is None unless the simulation was made with follow_strain=True.)");
  type.def_property_readonly(
      "hash", [](Shared& s) { return s.call([](const Simulation& x) { return x.hash(); }); },
      "A 64-bit hash of the bits of all positions: equal runs have equal hashes.");
  type.def_property_readonly(
      "plan",
      [](Shared& s) { return s.call([](const Simulation& x) { return to_text(x.plan()); }); },
      "What a frame does, stage by stage, and what was left out and why: text for reading.");
  type.def_property_readonly(
      "notes", &notes,
      "What was chosen for you or read otherwise than written: a list of sentences.");
  type.def_property_readonly(
      "frame", [](Shared& s) { return s.call([](const Simulation& x) { return x.frame(); }); },
      "Frames advanced so far.");
  type.def_property_readonly(
      "time", [](Shared& s) { return s.call([](const Simulation& x) { return x.time(); }); },
      "Simulated time [s].");
  type.def_property_readonly(
      "substeps",
      [](Shared& s) { return s.call([](const Simulation& x) { return x.substeps(); }); },
      "Substeps of a frame now in use.");
  type.def_property_readonly(
      "threads", [](Shared& s) { return s.call([](const Simulation& x) { return x.threads(); }); },
      "Worker threads.");
  type.def_property_readonly(
      "scene",
      [](Shared& s) {
        return json_value(s.call([](const Simulation& x) { return write_scene_text(x.scene()); }));
      },
      "The scene as simulated, as a dict (a copy; change it by set() or set_scene()).");
}

void register_inputs(Class& type) {
  type.def("set", &set_value, py::arg("pointer"), py::arg("value"),
           R"(Changes one value of the scene while it runs: set("/wind/velocity", [0, 0, 3]).

The state goes on where the grids keep their points; else the run starts anew. Raises SceneError, and
then nothing has changed.)");
  type.def(
      "set_scene",
      [](Shared& shared, const py::object& scene, const py::dict& values) {
        Scene read_in = read(scene, values).scene;
        shared.call([&](Simulation& s) { s.set_scene(std::move(read_in)); });
      },
      py::arg("scene"), py::arg("values") = py::dict(),
      "Goes on with another scene, as set() does.");
  type.def(
      "set_state", &set_state, py::arg("positions"), py::arg("velocities"),
      "Replaces all positions [m] and velocities [m/s], each (particles, 3) real numbers. What\n"
      "methods and contact remember begins anew: restore() gives a run back, this does not.");
  method(type, "pin", &Simulation::pin, py::arg("cloth"), py::arg("particle"),
         "Holds a particle (its number within the cloth, j*columns + i) where it is.");
  method(type, "unpin", &Simulation::unpin, py::arg("cloth"), py::arg("particle"),
         "Lets a held particle go.");
  method(type, "grab", &Simulation::grab, py::arg("cloth"), py::arg("particle"), py::arg("target"),
         py::arg("stiffness") = 200.0,
         "Draws a particle to a target [m], 3 numbers, by a critically damped spring [N/m] until\n"
         "release(); another grab moves the target.");
  method(type, "release", &Simulation::release, "Lets go of what is grabbed.");
  method(
      type, "carry", &Simulation::carry, py::arg("cloth"), py::arg("velocity"),
      "Moves all held particles of a cloth without keys at a velocity [m/s], until told another.");
  method(type, "move_collider", &Simulation::move_collider, py::arg("collider"), py::arg("target"),
         "Moves a collider evenly to a place [m] within the next frame, where it rests.");
  type.def(
      "cut",
      [](Shared& shared, const Vec3& a, const Vec3& b, double width) {
        return shared.call([&](Simulation& s) { return s.cut(a, b, width); });
      },
      py::arg("a"), py::arg("b"), py::arg("width"),
      "Cuts what comes within `width` [m] of the segment from a to b; how many constraints it "
      "was.");
  type.def(
      "snapshot",
      [](Shared& s) { return s.call([](const Simulation& x) { return x.snapshot(); }); },
      "The run as it is now, to go back to by restore().");
  method(
      type, "restore", &Simulation::restore, py::arg("snapshot"),
      "Back to a snapshot of the same cloths. In the same scene, here or in another simulation,\n"
      "the run goes on from there to the same bits.");
}

}  // namespace

std::shared_ptr<Shared> build(const py::object& scene, const py::dict& values, int threads,
                              std::uint64_t seed, const std::string& simd, bool follow_strain) {
  SceneFile file = read(scene, values);
  const Options options{
      .threads = threads, .simd = simd_of(simd), .seed = seed, .follow_strain = follow_strain};
  const py::gil_scoped_release free;
  return std::make_shared<Shared>(std::move(file.scene), options, std::move(file.notes));
}

std::string reason(const Status& status) {
  return "the simulation stopped itself: " + status.text;
}

void register_simulation(py::module_& module) {
  py::register_exception<Stopped>(module, "SimulationError", PyExc_RuntimeError).doc() =
      "A simulation that stopped itself, and why; it does not go on.";
  py::class_<ClothArrays>(module, "ClothArrays",
                          "Windows onto the arrays of one cloth (Simulation.cloths).")
      .def_readonly("positions", &ClothArrays::positions,
                    "(rows, columns, 3) float32 [m], from `origin`")
      .def_readonly("velocities", &ClothArrays::velocities,
                    "(rows, columns, 3) float32 [m/s]; half a substep behind but for order 2")
      .def_readonly("inverse_mass", &ClothArrays::inverse_mass,
                    "(rows, columns) float32 [1/kg]; 0 = held")
      .def_readonly(
          "lanes", &ClothArrays::lanes,
          "Of a mesh, whose rows are padded: where each vertex is, (vertices,) uint32, as in\n"
          "positions.reshape(-1, 3)[lanes]; of a grid None.")
      .def_readonly("origin", &ClothArrays::origin,
                    "3 floats [m]: what positions are counted from; zero near the world's middle");
  py::class_<Snapshot>(module, "Snapshot", "A state of a simulation (Simulation.snapshot).")
      .def_readonly("time", &Snapshot::time, "Simulated time [s].")
      .def_property_readonly("nbytes", &Snapshot::bytes, "Bytes that it holds.");
  Class type(module, "Simulation", R"(A scene in motion.

scene:   a dict, a path, or the name of a shipped scene ("hello")
values:  replaces single values of it, {"/solver/iterations": 20}
threads: worker threads, 0 = all cores; the result is the same bits for any number
seed:    of every random choice
simd:    "best", "scalar", "sse2", "avx2" or "avx512"; the same bits for each
follow_strain: measure the strain after every frame, for report()["strain"]["max_of_frames"]

    sim = weft.Simulation("hello")
    sim.advance(60)
    sim.positions           # (particles, 3) float64, a copy
    sim.cloths[0].positions # (rows, columns, 3) float32, no copy

Stepping releases the interpreter's lock. Threads may share a simulation: calls wait for each other.
Raises SceneError with every fault of the scene.)");
  type.def(py::init(&build), py::arg("scene"), py::arg("values") = py::dict(), py::kw_only(),
           py::arg("threads") = 0, py::arg("seed") = 1, py::arg("simd") = "best",
           py::arg("follow_strain") = false);
  type.def("advance", &advance, py::arg("frames") = 1,
           "Advances so many frames. Raises SimulationError when it stops itself.");
  register_arrays(type);
  register_measures(type);
  register_inputs(type);
  type.def("__repr__", [](Shared& shared) {
    return shared.call([](const Simulation& s) {
      return "<weft.Simulation '" + s.scene().name + "', " +
             std::to_string(particle_total(s.scene())) + " particles, frame " +
             std::to_string(s.frame()) + ">";
    });
  });
}

}  // namespace weft::python
